"""Whether a `.fov`, or every file of a scene, is whole and true."""

import dataclasses
from pathlib import Path
from typing import Any

from foveal.base.errors import FovealError
from foveal.base.files import PathLike, refuse_missing
from foveal.base.progress import SILENT, Progress
from foveal.container import open_container

from .cage_file import is_cage, read_cage
from .cage_polygons import PolygonCounts, has_border
from .read import read
from .scene import read_scene
from .scene_light import is_shadow, shadow_facts

__all__ = ["check"]


def check(
    source: PathLike,
    /,
    *,
    deep: bool = False,
    original: PathLike | None = None,
    progress: Progress = SILENT,
) -> dict[str, Any]:
    """Verify checksums, structure and every patch; with `deep`, measure the error bounds again.

    Parameters
    ----------
    source
        A `.fov` or a scene.json.
    deep : bool
        Decode all and measure each stored error.
    original
        The mesh file to measure against, with `deep`; by default the finest level. For a `.fov` only.
    progress : Progress
        Told of each stage.

    Returns
    -------
    dict
        JSON can hold it: `file`, `is_whole`, and what `multires.check` tells (of a control mesh the counts
        and `is_closed`; of shadows their resolution and nodes), or `layers` with one such for each asset,
        and `light` for the scene's.

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
    path = Path(source)
    refuse_missing(path)
    if path.suffix.lower() not in (".fov", ".json"):
        raise FovealError(
            f"{path}: only a .fov or a scene.json can be checked. Look at a mesh with 'foveal info'."
        )
    from foveal import multires

    if is_cage(path):
        return {"file": str(path), "is_whole": True, **_cage(path, original)}
    if is_shadow(path):
        return {"file": str(path), "is_whole": True, **_shadow(path, original)}
    if path.suffix.lower() == ".fov":
        mesh = None if original is None else read(original)
        report = multires.check(path, deep=deep, original=mesh, progress=progress)
        return {"file": str(path), "is_whole": True, **dataclasses.asdict(report)}
    if original is not None:
        raise FovealError(
            f"{path}: an original can be given for a single .fov only. Check the files one by one."
        )
    scene = read_scene(path)
    layers = [check(layer.path, deep=deep, progress=progress) for layer in scene.layers]
    light = {} if scene.light is None else {"light": check(scene.light, progress=progress)}
    return {"file": str(path), "is_whole": True, "layers": layers, **light}


def _shadow(path: Path, original: PathLike | None) -> dict[str, Any]:
    """That all of a shadow map can be decoded, and is what its header tells."""
    from foveal.shadows.counts import counts
    from foveal.shadows.file import read_shadow

    if original is not None:
        raise FovealError(f"{path}: shadows have no errors to be measured. Leave the original out.")
    with open_container(path) as file:
        told = shadow_facts(file, path.stat().st_size)
    shadow_map = read_shadow(path)
    nodes = counts(shadow_map.trees)._asdict()
    if nodes != told["nodes"]:
        raise FovealError(f"{path}: its trees are not what its header tells. Copy it again, or make it anew.")
    return {"resolution": shadow_map.resolution, "images": told["images"], "nodes": nodes}


def _cage(path: Path, original: PathLike | None) -> dict[str, Any]:
    """That a control mesh is the surface it should be."""
    from foveal.refine.cage import Cage

    if original is not None:
        raise FovealError(f"{path}: a control mesh has no errors to be measured. Leave the original out.")
    cage = read_cage(path)
    if cage.polygons is not None:  # which were looked at when they were read
        return {
            "triangles": len(cage.mesh.faces),
            "vertices": len(cage.mesh.positions),
            "polygons": dataclasses.asdict(PolygonCounts.of(cage.polygons)),
            "placements": 1 if cage.placements is None else len(cage.placements),
            "is_closed": not has_border(cage.polygons) and len(cage.polygons.holes) == 0,
        }
    surface = Cage.of(cage.mesh, name=str(path))
    Cage.of(cage.mesh, sharp=cage.sharp, name=str(path))
    return {
        "triangles": len(surface.faces),
        "vertices": len(surface.positions),
        "sharp_edges": 0 if cage.sharp is None else len(cage.sharp),
        "is_closed": not bool(surface.is_border.any()),
    }
