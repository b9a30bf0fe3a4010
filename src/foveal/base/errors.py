"""What foveal raises when its input, not its code, is at fault."""

__all__ = ["FovealError"]


class FovealError(ValueError):
    """One sentence for the person at the keyboard: which file, what is wrong, what to do.

    The command line prints it without a traceback and exits with 1.

    Examples
    --------
    >>> str(FovealError("statue.ply: the file ends after 12 of 90 vertices. Copy it again."))
    'statue.ply: the file ends after 12 of 90 vertices. Copy it again.'
    """
