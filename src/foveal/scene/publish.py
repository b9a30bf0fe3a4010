"""A folder of static files that any web server can host: the viewer, scene.json, and the data."""

import shutil
from pathlib import Path
from typing import Unpack

from foveal.base.errors import FovealError
from foveal.base.files import PathLike, is_filled, refuse_unwritable, whole_folder
from foveal.base.progress import SILENT, Progress

from .asset_names import asset_names
from .build import BuildOptions
from .prepare import load
from .scene import Scene, scene_json
from .source import Source
from .viewer_files import viewer_files

__all__ = ["publish"]

_README = """\
{title}

This folder is a web site: upload it as it is to any web server or object store, and open index.html
there. It needs no program on the server, and no network but the server's own.

- Servers that answer byte ranges (nginx, Apache, Caddy, S3 and most others do) send only what is looked
  at. Without ranges it works too: each file is then loaded once, whole.
- Opening index.html from the disk does not work, as browsers do not let a page read files beside it. To
  look at it here:   python3 -m http.server --bind 127.0.0.1   and open http://127.0.0.1:8000
- Do not let the server compress .fov files: they are compressed already, and most servers give up
  ranges for what they compress. Compress .js, .css, .html and .json.
- .wasm must be sent as application/wasm, .js as text/javascript. Most servers know.

Made with foveal.
"""


_OF_THE_PAGE = ("sqrt3", "catmull-clark")
"""Schemes that the viewer has itself."""


def publish(
    source: Source | Scene,
    folder: PathLike,
    /,
    *,
    force: bool = False,
    viewer: PathLike | None = None,
    shadow: PathLike | None = None,
    progress: Progress = SILENT,
    **options: Unpack[BuildOptions],
) -> Path:
    """Write a folder of static files that any web server can host; it appears whole or not at all.

    Parameters
    ----------
    source : path, TriMesh, PolyMesh or Scene
        A mesh, a `.fov` or a scene.json. A mesh is built into the user's cache first.
    folder
        New, or empty, or with `force` one that was published before.
    force : bool
        Replace an earlier publication.
    viewer
        A folder with a built viewer; by default the one that comes with foveal.
    shadow
        A `.fov` that `shadow` made: the light of the scene, in place of its own.
    progress, **options
        As for `build`.

    Returns
    -------
    Path
        The folder.

    Raises
    ------
    FovealError
        If the viewer is not built, or the folder must not be replaced.

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
    folder = Path(folder)
    _refuse_folder(folder, force=force)
    files = viewer_files(viewer)  # if it is missing, say so before minutes of building
    scene = load(source, shadow=shadow, progress=progress, **options)
    inside = folder.resolve()
    for asset in scene.assets:
        if asset.resolve().is_relative_to(inside):
            raise FovealError(
                f"{folder}: the scene's own {asset.name} lies in this folder. Name another one."
            )
    for layer in scene.layers:
        if layer.refinement is not None and layer.refinement.scheme not in _OF_THE_PAGE:
            progress.note(
                f"{layer.name}: a page refines by {' and '.join(_OF_THE_PAGE)} only, so without a server it "
                f"will say that {layer.refinement.scheme} needs one. Show it with 'foveal view'."
            )
    names = asset_names(scene)
    total = sum(path.stat().st_size for path in names)
    with whole_folder(folder, force=force) as part, progress.stage("Copying", total) as stage:
        for name, source in files.items():
            target = part / name
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, target)
        (part / "data").mkdir(exist_ok=True)
        for source, name in names.items():
            with source.open("rb") as stream, (part / "data" / name).open("xb") as out:
                while piece := stream.read(8 << 20):
                    out.write(piece)
                    stage.advance(len(piece))
        text = scene_json(scene, {path: f"data/{name}" for path, name in names.items()})
        (part / "scene.json").write_bytes(text)
        (part / "README.txt").write_text(_README.format(title=scene.title), encoding="utf-8")
    return folder


def _refuse_folder(folder: Path, *, force: bool) -> None:
    """Say before any work that a folder will not do. Force replaces a site of ours, never anything else."""
    if folder.exists() and not folder.is_dir():
        raise FovealError(f"{folder}: this is a file; name a folder to write.")
    if folder.exists() and is_filled(folder):
        if not force:
            raise FovealError(f"{folder}: the folder is not empty. Use --force to replace it.")
        if not (folder / "scene.json").is_file() or not (folder / "index.html").is_file():
            raise FovealError(
                f"{folder}: the folder was not made by 'foveal publish', so it is not replaced. "
                "Name another one."
            )
    refuse_unwritable(folder, is_folder=True)
