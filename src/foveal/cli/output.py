"""What is settled of an output before any work."""

from pathlib import Path

import typer

from foveal.base.errors import FovealError

__all__ = ["refuse_output"]


def refuse_output(output: Path, source: Path, /, *suffixes: str, force: bool) -> None:
    """Stop if the output's name is wrong, if it is the input, or if it is there and may not be replaced.

    Whether it can be written is for the verb itself to say.
    """
    from foveal.base.files import refuse_same

    if output.suffix.lower() not in suffixes:
        raise typer.BadParameter(
            f"{output}: the name must end in {' or '.join(suffixes)}.", param_hint="--output"
        )
    refuse_same(output, source)
    if output.exists() and not output.is_dir() and not force:
        raise FovealError(f"{output}: is there already. Use --force to replace it.")
