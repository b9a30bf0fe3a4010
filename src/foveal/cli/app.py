"""The `foveal` command: its page of help, its errors, its exit codes.

0: done. 1: the input was at fault, and one sentence says how. 2: the command line was. 130: interrupted.
"""

import sys
import traceback
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from foveal.base.errors import FovealError
from foveal.base.version import __version__

from .build import build
from .check import check
from .export import export
from .info import info
from .interrupts import heed
from .publish import publish
from .refine import refine
from .render import render
from .result import plain
from .shadow import shadow
from .view import view

__all__ = ["app"]


class _Group(TyperGroup):
    """`foveal FILE` means `foveal view FILE`; errors are one sentence and an exit code."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        # Only what looks like a file: a mistyped command shall be called that, with its likely meaning.
        if args and args[0] not in self.commands and not args[0].startswith("-"):
            word = Path(args[0])
            if word.suffix or len(word.parts) > 1 or word.exists():
                args = ["view", *args]
        return super().parse_args(ctx, args)

    def main(self, args: Sequence[str] | None = None, *rest: Any, **named: Any) -> Any:
        words = list(sys.argv[1:] if args is None else args)
        try:
            return super().main(args, *rest, **named)
        except Exception as error:
            heed()  # a compiler that was interrupted may find fault with itself
            if "--debug" in words:
                traceback.print_exc()
            print(plain(f"foveal: {_sentence(error)}"), file=sys.stderr)
            sys.exit(1)


def _sentence(error: Exception) -> str:
    """One line for the person: what is wrong and what to do."""
    if isinstance(error, FovealError):
        return " ".join(str(error).split())
    if isinstance(error, MemoryError):
        return (
            "there is not enough memory. Give a limit to keep within, such as --memory 1GB; "
            "for a picture a smaller --size."
        )
    if isinstance(error, OSError) and error.strerror:
        where = f"{error.filename}: " if error.filename else ""
        return f"{where}{error.strerror}. Check the path, its permissions and the free space."
    what = " ".join(f"{type(error).__name__}: {error}".split())
    return f"this is a fault in foveal itself, please report it ({what}). --debug shows where it arose."


app = typer.Typer(
    cls=_Group,
    name="foveal",
    help="""Gives a 3D surface detail where one looks: a heavy mesh becomes one compressed file that any
    browser shows at once, and sharpens where the eye is.

    foveal FILE is short for foveal view FILE. Each command has its own page: foveal build --help.
    """,
    epilog="Exit codes: 0 done, 1 the input was at fault, 2 the command line was, 130 interrupted.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
)
for _command in (view, build, info, check, export, refine, render, shadow, publish):
    app.command()(_command)


def _print_version(wanted: bool) -> None:
    if wanted:
        print(f"foveal {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    pass
