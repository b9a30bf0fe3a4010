"""foveal publish: a folder for any web server."""

from pathlib import Path
from typing import Annotated

import typer

from .options import Bits, Debug, Json, Memory, Normals, Quiet, Source, Step, Up, Verbose, Workers
from .report import print_json, reporter
from .work import build_arguments, refuse_missing

__all__ = ["publish"]


def publish(
    file: Source,
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FOLDER", help="New or empty.")],
    force: Annotated[bool, typer.Option("--force", help="Replace what was published there before.")] = False,
    bits: Bits = None,
    step: Step = None,
    normals: Normals = None,
    up: Up = None,
    memory: Memory = None,
    workers: Workers = None,
    json: Json = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
    debug: Debug = False,
) -> None:
    """Make a web site: static files for any server.

    Servers that answer byte ranges send only what is looked at; without ranges it works too.
    """
    from foveal.scene.prepare import load
    from foveal.scene.publish import publish as write
    from foveal.scene.publish import refuse_folder
    from foveal.scene.viewer_files import viewer_files

    refuse_missing(file)
    viewer_files()  # before minutes of building
    refuse_folder(output, force=force)
    with reporter(is_quiet=quiet, is_verbose=verbose) as progress:
        scene = load(
            file,
            **build_arguments(
                bits=bits,
                step=step,
                normals=normals,
                up=up,
                memory=memory,
                workers=workers,
                executor=None,
                progress=progress,
            ),
        )
        write(scene, output, force=force, progress=progress)
    files = [path for path in output.rglob("*") if path.is_file()]
    size = sum(path.stat().st_size for path in files)
    if json:
        print_json({"folder": str(output), "files": len(files), "bytes": size})
    elif not quiet:
        print(f"{output}: {len(files)} files, {size:,} bytes. README.txt in it says how to host them.")
