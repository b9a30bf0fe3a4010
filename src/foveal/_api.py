"""The verbs of `import foveal`: the command line's, over paths and arrays.

Each checks what it is given, and calls the room that does the work. Rooms are imported when a verb is
called, so that `import foveal` stays light. Past 300 lines, since the nine verbs are one page for who reads
their help; three quarters of it are that help.
"""

import os
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foveal.base.errors import FovealError
from foveal.base.files import refuse_unwritable
from foveal.base.progress import SILENT, Progress
from foveal.base.tasks import Executor
from foveal.mesh.trimesh import TriMesh
from foveal.view.camera import Camera

if TYPE_CHECKING:
    from foveal.multires import BuildReport, Multires
    from foveal.server import Running

__all__ = ["build", "check", "export", "info", "open", "publish", "read", "render", "view"]

PathLike = str | os.PathLike[str]
Source = PathLike | TriMesh


def read(path: PathLike, /, *, up: str | None = None) -> TriMesh:
    """Read a mesh file: PLY, STL, OBJ, OFF, GLB and more, each also gzipped.

    Parameters
    ----------
    path
        The file.
    up : "x", "y" or "z", optional
        The axis that points up, where it is not the format's own.

    Returns
    -------
    TriMesh
        Positions (n, 3) float64 in the file's unit and axes, faces (m, 3) int32, normals and colours
        where the file has them.

    Raises
    ------
    FovealError
        In one sentence: missing, truncated, no mesh, NaN coordinates, indices out of range.

    Examples
    --------
    >>> import pathlib, tempfile, foveal
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "triangle.off"
    >>> _ = path.write_text("OFF\\n3 1 0\\n0 0 0\\n1 0 0\\n0 1 0\\n3 0 1 2\\n")
    >>> foveal.read(path).faces
    array([[0, 1, 2]], dtype=int32)
    """
    from foveal.mesh.io import read_mesh

    return read_mesh(path, up=up)


def build(
    source: Source | ArrayLike,
    /,
    *rest: Any,
    bits: int | None = None,
    step: float | None = None,
    normals: str | None = None,
    up: str | None = None,
    memory_bytes: int | None = None,
    executor: Executor | None = None,
    workers: int | None = None,
    progress: Progress = SILENT,
) -> "BuildReport":
    """Build a `.fov`: `build(path, output)`, `build(mesh, output)` or `build(positions, faces, output)`.

    Parameters
    ----------
    source : path, TriMesh, or (n, 3) float
        A mesh file, a mesh, or positions; the latter are followed by `faces`, (m, 3) int with indices
        in [0, n).
    output : path
        Ends in `.fov`; replaced if it is there, and only when the new one is whole.
    bits : int, optional
        Bits a coordinate over the largest extent; by default from the errors of simplification.
    step : float, optional
        Grid step in the unit of the mesh, instead of `bits`.
    normals : "auto" or "none", optional
        "auto" keeps the mesh's, or makes them where it has none.
    up : "x", "y" or "z", optional
        The axis that points up.
    memory_bytes : int, optional
        Memory to keep within; the rest waits on disk.
    executor : Executor, optional
        By default local threads; anything like `concurrent.futures.Executor` serves, such as Dask's.
    workers : int, optional
        Number of local threads.
    progress : Progress
        Told of each stage.

    Returns
    -------
    BuildReport
        What was read, repaired and written.

    Raises
    ------
    FovealError
        If the input cannot be used, in one sentence.

    Examples
    --------
    >>> import pathlib, tempfile, foveal
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "tetrahedron.fov"
    >>> positions = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> report = foveal.build(positions, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], path)
    >>> foveal.info(path)["triangles"]
    4
    """
    from foveal.scene.prepare import BuildOptions, build_file

    mesh, output = _arguments(source, rest)
    output = Path(output)
    if output.suffix.lower() != ".fov":
        raise FovealError(f"{output}: the name must end in .fov.")
    refuse_unwritable(output)
    return build_file(
        mesh,
        output,
        options=BuildOptions(bits=bits, step=step, normals=normals, up=up),
        memory_bytes=memory_bytes,
        executor=executor,
        workers=workers,
        progress=progress,
    )


def _arguments(source: Any, rest: tuple[Any, ...]) -> tuple[Source, PathLike]:
    if len(rest) == 1 and isinstance(source, (str, os.PathLike, TriMesh)):
        return source, rest[0]
    if len(rest) == 2 and not isinstance(source, (str, os.PathLike, TriMesh)):
        return TriMesh.of(source, rest[0]), rest[1]
    raise TypeError("call build(path, output), build(mesh, output) or build(positions, faces, output)")


def open(path: PathLike, /) -> "Multires":
    """Open a `.fov` to read patches from it; close it, or use it in a `with` block.

    Examples
    --------
    >>> import pathlib, tempfile, foveal
    >>> from foveal.mesh.shapes import icosphere
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "sphere.fov"
    >>> report = foveal.build(icosphere(2), path)
    >>> with foveal.open(path) as sphere:
    ...     sphere.header["triangles"]
    320
    """
    from foveal import multires

    return multires.open(path)


def info(path: PathLike, /, *, up: str | None = None) -> dict[str, Any]:
    """What is in a `.fov`, a mesh file or a scene.json, as JSON could hold it; see `foveal.scene.info`.

    Examples
    --------
    >>> import pathlib, tempfile, foveal
    >>> from foveal.mesh.shapes import icosphere
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "sphere.fov"
    >>> report = foveal.build(icosphere(2), path)
    >>> [row["triangles"] for row in foveal.info(path)["level_table"]][-1]
    320
    """
    from foveal.scene.info import info as look

    return look(path, up=up)


def check(
    path: PathLike, /, *, deep: bool = False, original: PathLike | None = None, progress: Progress = SILENT
) -> dict[str, Any]:
    """Verify a `.fov`, or all files of a scene.json; with `deep` every error bound is measured again.

    Raises
    ------
    FovealError
        If anything is wrong, in a sentence that says what.

    Examples
    --------
    >>> import pathlib, tempfile, foveal
    >>> from foveal.mesh.shapes import icosphere
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "sphere.fov"
    >>> report = foveal.build(icosphere(2), path)
    >>> foveal.check(path)["is_whole"]
    True
    """
    from foveal.scene.check import check as verify

    return verify(path, deep=deep, original=original, progress=progress)


def export(
    source: Source,
    output: PathLike | None = None,
    /,
    *,
    error: float | None = None,
    triangles: int | None = None,
    progress: Progress = SILENT,
) -> TriMesh:
    """A mesh as coarse as an error, in the unit of the file, or a number of triangles allows.

    Parameters
    ----------
    source : path or TriMesh
        A `.fov`, or a mesh, which is built first if it has to become coarser.
    output : path, optional
        Where to write it too, as PLY or GLB.
    error : float, optional
        Largest distance to the original; by default the original's triangles.
    triangles : int, optional
        As fine as this many triangles allow; not together with `error`.
    progress : Progress
        Told of each stage.

    Examples
    --------
    >>> import pathlib, tempfile, foveal
    >>> from foveal.mesh.shapes import icosphere
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "sphere.fov"
    >>> report = foveal.build(icosphere(2), path)
    >>> len(foveal.export(path, path.with_suffix(".ply")).faces)
    320
    """
    from foveal.scene.export import export as write

    if output is not None:
        refuse_unwritable(output)
    with _file_of(source, progress) as path:
        return write(path, output, error=error, triangles=triangles, progress=progress)


def render(
    source: Source,
    output: PathLike | None = None,
    /,
    *,
    camera: Camera | PathLike | None = None,
    size: tuple[int, int] | None = None,
    error_px: float = 1.0,
    progress: Progress = SILENT,
) -> NDArray[np.uint8]:
    """Draw a mesh, a `.fov` or a scene.json on the CPU: the same pixels on every machine.

    Parameters
    ----------
    source : path or TriMesh
        What to draw.
    output : path, optional
        A PNG to write.
    camera : Camera or path, optional
        By default all is framed. A path is of a camera file, as `Camera.to_json` gives it.
    size : (int, int), optional
        Width and height in pixels; by default the camera's, or 1280 x 720.
    error_px : float
        How wrong the surface may look, in pixels.
    progress : Progress
        Told of each stage.

    Returns
    -------
    (height, width, 3) uint8
        sRGB. What shows no surface has the scene's `background`, or else the viewer's light one, a gradient.

    Examples
    --------
    >>> import foveal
    >>> from foveal.mesh.shapes import icosphere
    >>> foveal.render(icosphere(2), size=(64, 48)).shape
    (48, 64, 3)
    """
    from foveal.raster import write_png
    from foveal.scene.prepare import load
    from foveal.scene.render import frame, read_camera
    from foveal.scene.render import render as draw

    if output is not None:
        refuse_unwritable(output)
    with _file_of(source, progress) as path:
        scene = load(path, progress=progress)
        if camera is None:
            eye = frame(scene, size=size or (1280, 720))
        elif isinstance(camera, Camera):
            eye = camera if size is None else camera.resized(*size)
        else:
            eye = read_camera(camera, size=size)
        picture = draw(scene, eye, error_px=error_px)
    if output is not None:
        write_png(picture, output)
    return picture


def publish(
    source: Source,
    folder: PathLike,
    /,
    *,
    force: bool = False,
    viewer: PathLike | None = None,
    progress: Progress = SILENT,
) -> Path:
    """Write a folder of static files that any web server can host, and return it.

    Parameters
    ----------
    source : path or TriMesh
        A mesh, a `.fov` or a scene.json.
    folder
        New or empty.
    force : bool
        Replace what was published there before.
    viewer
        A folder with a built viewer; by default the one that comes with foveal.
    progress : Progress
        Told of each stage.

    Examples
    --------
    >>> import pathlib, tempfile, foveal
    >>> from foveal.mesh.shapes import icosphere
    >>> folder = pathlib.Path(tempfile.mkdtemp())
    >>> (folder / "viewer").mkdir()
    >>> _ = (folder / "viewer" / "index.html").write_text("<!doctype html><title>foveal</title>")
    >>> site = foveal.publish(icosphere(2), folder / "site", viewer=folder / "viewer")
    >>> sorted(path.name for path in site.iterdir())
    ['README.txt', 'data', 'index.html', 'scene.json']
    """
    from foveal.scene.prepare import load
    from foveal.scene.publish import publish as write
    from foveal.scene.publish import refuse_folder

    refuse_folder(folder, force=force)
    with _file_of(source, progress) as path:
        return write(load(path, progress=progress), folder, force=force, viewer=viewer, progress=progress)


def view(
    source: Source,
    /,
    *,
    host: str = "127.0.0.1",
    port: int | None = None,
    open_browser: bool | None = None,
    progress: Progress = SILENT,
    viewer: PathLike | None = None,
) -> "Running":
    """Show a mesh, a `.fov` or a scene.json in the viewer, without waiting for it to be closed.

    Parameters
    ----------
    source : path or TriMesh
        What to show; a mesh is built into the user's cache first.
    host, port
        Where to serve; by default on this machine alone, from port 8000 on.
    open_browser : bool, optional
        By default, where there is a display and this is no notebook, which shows the viewer inline.
    progress : Progress
        Told of each stage.
    viewer
        A folder with a built viewer; by default the one that comes with foveal.

    Returns
    -------
    Running
        With `url`; `close()` ends it, `wait()` waits for Ctrl-C, which a script needs that would else
        end. Shown in a notebook, it is the viewer.

    Examples
    --------
    >>> import pathlib, tempfile, foveal
    >>> from foveal.mesh.shapes import icosphere
    >>> built = pathlib.Path(tempfile.mkdtemp())  # stands in for the viewer that comes with foveal
    >>> _ = (built / "index.html").write_text("<!doctype html><title>foveal</title>")
    >>> with foveal.view(icosphere(2), viewer=built, open_browser=False) as shown:
    ...     shown.url.startswith("http://127.0.0.1:")
    True
    """
    import webbrowser

    from foveal.scene.prepare import load
    from foveal.server.run import can_open_browser, start

    if isinstance(source, TriMesh):
        from foveal.scene.prepare import prepare_mesh

        source = prepare_mesh(source, progress=progress)
    running = start(load(source, progress=progress), host=host, port=port, viewer=viewer)
    is_notebook = "ipykernel" in sys.modules
    if open_browser or (open_browser is None and not is_notebook and can_open_browser()):
        webbrowser.open(running.url)
    return running


@contextmanager
def _file_of(source: Source, progress: Progress) -> Iterator[PathLike]:
    """A file that holds the source; for a mesh one that lasts as long as the block."""
    if not isinstance(source, TriMesh):
        yield source
        return
    from foveal.scene.prepare import build_file

    with tempfile.TemporaryDirectory(prefix="foveal-") as folder:
        path = Path(folder) / "mesh.fov"
        build_file(source, path, progress=progress)
        yield path
