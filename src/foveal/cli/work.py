"""From the options of a command to the keyword arguments of `prepare` and `build`."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import typer

from foveal.base.errors import FovealError
from foveal.base.progress import Progress
from foveal.base.tasks import Executor

from .options import NormalsKind, UpAxis

__all__ = ["build_arguments", "dask_executor", "refuse_existing", "refuse_missing"]


@contextmanager
def dask_executor(address: str | None) -> Iterator[Executor | None]:
    """An executor on a Dask cluster, or None for local threads."""
    if address is None:
        yield None
        return
    try:
        from distributed import Client
    except ImportError as error:
        raise FovealError(
            "--dask: Dask is not installed. Install it with: pip install 'foveal[dask]'."
        ) from error
    try:
        client = Client(address, timeout="10s")
    except (OSError, ValueError, TimeoutError) as error:
        raise FovealError(
            f"--dask {address}: no cluster answers there. Start one, or check the address."
        ) from error
    with client:
        yield client.get_executor()


def build_arguments(
    *,
    bits: int | None,
    step: float | None,
    normals: NormalsKind | None,
    up: UpAxis | None,
    memory: int | None,
    workers: int | None,
    executor: Executor | None,
    progress: Progress,
) -> dict[str, Any]:
    """The keyword arguments that `scene.prepare` and `scene.build_file` take."""
    from foveal.scene.prepare import BuildOptions

    if bits is not None and step is not None:
        raise typer.BadParameter("it says in another way what --bits says. Give one.", param_hint="--step")
    if step is not None and not 0 < step < float("inf"):
        raise typer.BadParameter(f"a length above 0 is needed, got {step}.", param_hint="--step")
    return {
        "options": BuildOptions(bits=bits, step=step, normals=normals and normals.value, up=up and up.value),
        "memory_bytes": memory,
        "workers": workers,
        "executor": executor,
        "progress": progress,
    }


def refuse_missing(path: Path) -> None:
    """Stop before any work if the input is not there."""
    if not path.exists():
        raise FovealError(f"{path}: there is no such file.")


def refuse_existing(path: Path, *, force: bool) -> None:
    """Stop before any work if the output is there and may not be replaced, or cannot be written."""
    from foveal.base.files import refuse_unwritable

    if path.exists() and not path.is_dir() and not force:
        raise FovealError(f"{path}: is there already. Use --force to replace it.")
    refuse_unwritable(path)
