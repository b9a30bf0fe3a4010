"""What is in a file, for people and programs: a `.fov`, a mesh file, or a scene.json.

A `.fov` is looked into by its header, index and chunk 0 alone, and without the rooms that compile
kernels: importing those would double the time of `foveal info`.
"""

import dataclasses
import os
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError
from foveal.base.files import PathLike, refuse_missing
from foveal.container import Container, open_container

from .cage_file import KIND as CAGE
from .cage_file import control_mesh
from .cage_polygons import PolygonCounts
from .refinement import refinement_json
from .scene import read_scene
from .scene_light import KIND as SHADOW
from .scene_light import shadow_facts

if TYPE_CHECKING:
    from foveal.mesh.polymesh import PolyMesh
    from foveal.mesh.trimesh import TriMesh

__all__ = ["info"]


def info(source: "PathLike | TriMesh | PolyMesh", /, *, up: str | None = None) -> dict[str, Any]:
    """Say what is in a `.fov`, a mesh or a scene.json.

    Parameters
    ----------
    source : path, TriMesh or PolyMesh
        What to look into. Of a `.fov` only the beginning is read; a mesh is looked at whole.
    up : "x", "y" or "z", optional
        Of a mesh, the axis that points up, where it is not the format's own.

    Returns
    -------
    dict
        JSON can hold it. `kind` is "multires", "cage", "shadow", "mesh" or "scene". For patches,
        `level_table` has a row for each level, coarse to fine: the triangles that are shown when all up to it
        is expanded, their largest distance to the original (`error`, an upper bound), its own bytes. For a
        mesh, `topology` counts components, open and non-manifold edges, and what else is odd; of a PolyMesh
        `polygons` counts its faces, creases and corners. For a control
        mesh, `scheme`, `criteria` and so on say how it is meant to be refined. For shadows, `light`,
        `resolution`, and `nodes` by kind; a scene's `light` is such a dict.

    Raises
    ------
    FovealError
        If the file is missing or is not what it seems to be.

    Examples
    --------
    >>> import pathlib, tempfile, foveal
    >>> from foveal.mesh.shapes import icosphere
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "sphere.fov"
    >>> report = foveal.build(icosphere(2), path)
    >>> [row["triangles"] for row in foveal.info(path)["level_table"]][-1]
    320
    >>> foveal.info(icosphere(2))["topology"]["is_closed"]
    True
    """
    if not isinstance(source, (str, os.PathLike)):
        from foveal.mesh.polymesh import PolyMesh

        from .source import checked, triangles_of

        mesh = checked(source)
        facts = _mesh_info(triangles_of(mesh), None, up)
        if isinstance(mesh, PolyMesh):
            facts["polygons"] = dataclasses.asdict(PolygonCounts.of(mesh))
        return facts
    path = Path(source)
    refuse_missing(path)
    suffix = path.suffix.lower()
    if suffix not in (".json", ".fov"):
        from foveal.mesh.io import read_mesh

        return _mesh_info(read_mesh(path, up=up), path, up)
    if up is not None:
        raise FovealError(f"{path}: it is built already, and says itself which axis points up.")
    return _scene_info(path) if suffix == ".json" else _fov_info(path)


def _scene_info(path: Path) -> dict[str, Any]:
    scene = read_scene(path)
    return {
        "file": str(path),
        "kind": "scene",
        "title": scene.title,
        "layers": [
            {"name": layer.name, "visible": layer.is_visible, **_fov_info(layer.path)}
            for layer in scene.layers
        ],
        "views": [view.name for view in scene.views],
        **({"light": _fov_info(scene.light)} if scene.light else {}),
    }


def _mesh_info(mesh: "TriMesh", path: Path | None, up: str | None) -> dict[str, Any]:
    from foveal.mesh.topology import inspect

    named = {"normal": mesh.normals, "colour": mesh.colours}
    arrays = {name: array for name, array in named.items() if array is not None}
    in_memory = sum(array.nbytes for array in (mesh.positions, mesh.faces, *arrays.values()))
    return {
        "file": None if path is None else str(path),
        "kind": "mesh",
        "bytes": in_memory if path is None else path.stat().st_size,
        "triangles": len(mesh.faces),
        "vertices": len(mesh.positions),
        "box": [mesh.positions.min(axis=0).tolist(), mesh.positions.max(axis=0).tolist()],
        "up": up or "y",
        "attributes": list(arrays),
        "topology": dataclasses.asdict(inspect(mesh)),
    }


def _cage_info(file: Container, size: int) -> dict[str, Any]:
    cage = control_mesh(file)
    return {
        "file": file.name,
        "kind": "cage",
        "version": file.version,
        "bytes": size,
        "triangles": len(cage.mesh.faces),
        "vertices": len(cage.mesh.positions),
        "box": file.header["box"],
        "up": cage.up,
        "attributes": file.header["attributes"] if cage.polygons else [],
        "sharp_edges": 0 if cage.sharp is None else len(cage.sharp),
        **(
            {} if cage.polygons is None else {"polygons": dataclasses.asdict(PolygonCounts.of(cage.polygons))}
        ),
        **({} if cage.placements is None else {"placements": len(cage.placements)}),
        **refinement_json(cage.refinement),
        "generator": file.header.get("generator"),
    }


def _fov_info(path: Path) -> dict[str, Any]:
    with open_container(path) as file:
        if file.kind == CAGE:
            return _cage_info(file, path.stat().st_size)
        if file.kind == SHADOW:
            return shadow_facts(file, path.stat().st_size)
        file.expect("multires", 1)
        header, size = file.header, path.stat().st_size
        _refuse_damage(header, str(path))
        # The finest level is the original on the grid: no point moves further than half a cell's diagonal.
        table = _level_table(file, finest=header["step"] * 3**0.5 / 2)
        data_bytes = int(file.lengths[1:].sum())
    origin, step = np.array(header["origin"]), header["step"]
    box = [(origin + step * np.array(corner)).tolist() for corner in header["box"]]
    return {
        "file": str(path),
        "kind": "multires",
        "version": header["version"],
        "bytes": size,
        "triangles": header["triangles"],
        "vertices": header["vertices"],
        "bits_per_vertex": round(8 * size / max(1, header["vertices"]), 3),
        "box": box,
        "step": step,
        "up": header.get("up", "y"),
        "unit": header.get("unit"),
        "epsg": header.get("epsg"),
        "attributes": [stream["name"] for stream in header["streams"]],
        "codec": header["codec"],
        "generator": header.get("generator"),
        "nodes": header["nodes"],
        "patches": header["patches"],
        "levels": len(table),
        "overhead_bytes": size - data_bytes,
        "overhead_share": round((size - data_bytes) / size, 5),
        "first_bytes": header["first_bytes"],
        "level_table": table,
    }


_HEADER: dict[str, Callable[[Any], bool]] = {
    "origin": lambda value: np.array(value, np.float64).shape == (3,),
    "step": lambda value: value > 0,
    "box": lambda value: np.array(value, np.float64).shape == (2, 3),
    "triangles": lambda value: value >= 0,
    "vertices": lambda value: value >= 0,
    "nodes": lambda value: 1 <= value < 1 << 24,
    "patches": lambda value: 1 <= value < 1 << 28,
    "streams": lambda value: all(isinstance(stream["name"], str) for stream in value),
    "codec": lambda value: isinstance(value, str),
}


def _refuse_damage(header: dict[str, Any], name: str) -> None:
    """A sentence for a header that lacks what is told of it; `multires.open` looks closer."""
    for key, is_right in _HEADER.items():
        try:
            if is_right(header[key]):
                continue
        except (KeyError, TypeError, ValueError):
            pass
        raise FovealError(f"{name}: its header is damaged ({key}). Copy or build it again.")


def _level_table(file: Container, *, finest: float) -> list[dict[str, Any]]:
    """The rows of `info`, from chunk 0 as spec/container.md lays it out."""
    nodes, patches = file.header["nodes"], file.header["patches"]
    chunk = file.chunk(0)
    at = 0

    def column(kind: str, count: int) -> NDArray[Any]:
        nonlocal at
        values = np.frombuffer(chunk, kind, count, at)
        at += values.nbytes
        return values

    try:
        first = column("<u4", nodes + 1).astype(np.int64)
        column("<f4", 4 * nodes)
        errors = column("<f4", nodes)
        finer = column("<i4", patches)
        triangles = column("<u4", patches).astype(np.int64)
        owner = np.repeat(np.arange(nodes), np.diff(first))
        levels = _levels(owner, finer, nodes)
    except (ValueError, IndexError, TypeError) as error:
        raise FovealError(
            f"{file.name}: its graph does not agree with its header. Copy or build it again."
        ) from error
    of_patch, of_finer = levels[owner], np.where(finer < 0, np.iinfo(np.int64).max, levels[finer])
    rows = []
    for level in range(int(levels.max()) + 1):
        is_shown = (of_patch <= level) & (of_finer > level)
        rows.append(
            {
                "level": level,
                "nodes": int((levels == level).sum()),
                "patches": int((of_patch == level).sum()),
                "triangles": int(triangles[is_shown].sum()),
                "error": float(errors[levels > level].max(initial=finest)),
                "bytes": int(file.lengths[1:][levels == level].sum()),
            }
        )
    return rows


def _levels(owner: NDArray[np.int64], finer: NDArray[np.int32], nodes: int) -> NDArray[np.int64]:
    """(n,): the longest way from node 0, which is 0."""
    if len(owner) != len(finer) or (finer >= nodes).any():
        raise ValueError("columns do not fit")
    levels = np.zeros(nodes, dtype=np.int64)
    parents, children = owner[finer >= 0], finer[finer >= 0]
    if (parents >= children).any():
        raise ValueError("a parent comes after its child")
    while True:
        before = levels.copy()
        np.maximum.at(levels, children, levels[parents] + 1)
        if (levels == before).all():
            return levels
