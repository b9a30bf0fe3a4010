"""The `.fov` of kind "cage": a control mesh, and how it is meant to be refined. See spec/container.md."""

from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foveal.base.errors import FovealError
from foveal.base.files import PathLike
from foveal.base.version import __version__
from foveal.container import Container, create, open_container

from .cage_polygons import PolygonCounts, polygons_chunk, polygons_header, polygons_of
from .control_mesh import MOST_CORNERS, ControlMesh
from .depth_rules import CATMULL_CLARK
from .refinement import Refinement, refinement_json, refinement_of

if TYPE_CHECKING:  # which knows of kernels: half a second for those who show patches only
    from foveal.mesh.polymesh import PolyMesh
    from foveal.mesh.trimesh import TriMesh

__all__ = ["CageReport", "control_mesh", "is_cage", "read_cage", "write_cage"]

KIND, VERSION, POLYGONS_VERSION = "cage", 1, 2
_MOST_SHARP = 500_000  # their list is part of the header, of which 16 MiB are read
_MOST = MOST_CORNERS  # of vertices, of triangles


@dataclass(frozen=True)
class CageReport:
    """What was written.

    Attributes
    ----------
    triangles, vertices : int
        Of the control mesh.
    welded : int
        Vertices that lay where another one does, made one with it.
    sharp_edges : int
        Those that stay sharp.
    scheme : str
    bytes : int
        Of the file.
    polygons : PolygonCounts or None
        For catmull-clark.
    placements : int
        How often it stands.
    """

    triangles: int
    vertices: int
    welded: int
    sharp_edges: int
    scheme: str
    bytes: int
    polygons: PolygonCounts | None = None
    placements: int = 1


def write_cage(
    mesh: "TriMesh | PolyMesh",
    path: PathLike,
    /,
    *,
    refinement: Refinement,
    up: str = "y",
    sharp_edges: ArrayLike | None = None,
    placements: ArrayLike | None = None,
    name: str = "mesh",
) -> CageReport:
    """Write a control mesh; of triangles, vertices at one place become one.

    It is of polygons for catmull-clark, and of triangles for all else. `sharp_edges` is an angle by which
    those bend that stay sharp, or (k, 2) int, their vertices then. `placements`, (k, 4, 4), are of polygons.

    Raises
    ------
    FovealError
        If the mesh is no oriented surface, in a sentence that names the edge or vertex.
    """
    from foveal.mesh.polymesh import PolyMesh
    from foveal.mesh.topology import weld
    from foveal.refine.cage import Cage

    if isinstance(mesh, PolyMesh):
        return _write_polygons(mesh.checked(name), path, refinement, up, placements, name)
    welded = weld(mesh)[0]
    positions, faces = welded.positions, welded.faces
    if refinement.scheme == CATMULL_CLARK:
        polygons = PolyMesh.of_triangles(welded).checked(name)
        return _write_polygons(polygons, path, refinement, up, placements, name)
    _refuse_large(name, len(positions), len(faces))
    Cage.of(welded, name=name)
    sharp = _sharp_of(welded, sharp_edges, name)
    header = {
        **_frame(positions, up),
        "vertices": len(positions),
        "triangles": len(faces),
        **({"sharp_edges": sharp.reshape(-1).tolist()} if len(sharp) else {}),
        **refinement_json(refinement),
    }
    with create(path, kind=KIND, version=VERSION) as writer:
        writer.finish(header, positions.astype("<f8").tobytes() + faces.astype("<u4").tobytes())
    repeated = len(mesh.positions) - len(positions)
    size = Path(path).stat().st_size
    return CageReport(len(faces), len(positions), repeated, len(sharp), refinement.scheme, size)


def _write_polygons(
    mesh: "PolyMesh",
    path: PathLike,
    refinement: Refinement,
    up: str,
    placements: ArrayLike | None,
    name: str,
) -> CageReport:
    from .cage_options import placements_with

    if refinement.scheme != CATMULL_CLARK:
        raise FovealError(f"{name}: polygons are refined by {CATMULL_CLARK} alone. Choose that.")
    counts = polygons_header(mesh)
    _refuse_large(name, *(counts[key] for key in ("vertices", "corners", "creases")))
    matrices = placements_with(mesh, {"placements": placements}, name)
    cage = ControlMesh.of_polygons(mesh, refinement, up, placements=matrices)
    header = {**_frame(cage.mesh.positions, up), **counts, **refinement_json(refinement)}
    if matrices is not None:
        header["placements"] = len(matrices)
    with create(path, kind=KIND, version=POLYGONS_VERSION) as writer:
        if matrices is not None:
            writer.add_chunk(matrices.astype("<f8").tobytes())
        writer.finish(header, polygons_chunk(mesh))
    size = Path(path).stat().st_size
    found = PolygonCounts.of(mesh)
    k = 1 if matrices is None else len(matrices)
    return CageReport(counts["triangles"], counts["vertices"], 0, 0, refinement.scheme, size, found, k)


def _refuse_large(name: str, *counts: int) -> None:
    if max(counts) > _MOST:
        raise FovealError(f"{name}: it is too large for a control mesh. Build it without a scheme.")


def _frame(positions: NDArray[np.float64], up: str) -> dict[str, Any]:
    """What any control mesh's header begins with."""
    low, high, origin = _box(positions)
    return {
        "generator": f"foveal {__version__}",
        "origin": origin.tolist(),
        "box": [low.tolist(), high.tolist()],
        "up": up,
    }


def _sharp_of(mesh: "TriMesh", given: ArrayLike | None, name: str) -> NDArray[np.int32]:
    """(k, 2): the edges that an angle makes sharp, or those given."""
    from foveal.refine.sharp import sharp_edges

    found = np.array([] if given is None else given)
    sharp = sharp_edges(mesh, float(found)) if found.ndim == 0 else found.reshape(-1, 2).astype(np.int32)
    if len(sharp) > _MOST_SHARP:
        raise FovealError(
            f"{name}: it has {len(sharp):,} sharp edges, more than the {_MOST_SHARP:,} that a file holds. "
            "Ask for a larger angle."
        )
    return sharp


def is_cage(path: PathLike, /) -> bool:
    """Whether a file is a `.fov` that holds a control mesh; what else is wrong its reader says."""
    path = Path(path)
    if path.suffix.lower() != ".fov":
        return False
    with open_container(path) as file:
        return file.kind == KIND


def read_cage(path: PathLike, /) -> ControlMesh:
    """Read a `.fov` of kind "cage".

    Raises
    ------
    FovealError
        If it cannot be read, is damaged, or is of another kind or version.
    """
    with open_container(path) as file:
        return control_mesh(file)


def control_mesh(file: Container, /) -> ControlMesh:
    """The same of an open file."""
    file.expect(KIND, VERSION, POLYGONS_VERSION)
    if file.version == POLYGONS_VERSION:
        polygons = polygons_of(file, partial(_count, file), partial(_damaged, file))
        placements = _placements(file, polygons)
        refinement = refinement_of(file.header, file.name)
        if refinement.scheme != CATMULL_CLARK:
            raise _damaged(file, "scheme")
        cage = ControlMesh.of_polygons(polygons, refinement, "y", placements=placements)
        return replace(cage, up=_up_of(file, cage.mesh.positions))
    mesh = _triangles(file)
    up = _up_of(file, mesh.positions)
    return ControlMesh(mesh, refinement_of(file.header, file.name), up, _sharp(file, len(mesh.positions)))


def _placements(file: Container, mesh: "PolyMesh") -> "NDArray[np.float64] | None":
    """(k, 4, 4), or None where the polygons stand once, where they are."""
    from .cage_options import placements_of

    count = _count(file, "placements") if "placements" in file.header else 0
    if len(file) != (2 if count else 1):
        raise _damaged(file, "lengths")
    if not count:
        return None
    data = file.chunk(1)
    if len(data) != 128 * count:
        raise _damaged(file, "placements")
    return placements_of(np.frombuffer(data, "<f8").reshape(-1, 4, 4), mesh, file.name)


def _triangles(file: Container) -> "TriMesh":
    """The mesh of version 1."""
    from foveal.mesh.trimesh import TriMesh

    vertices, faces = _count(file, "vertices"), _count(file, "triangles")
    data = file.chunk(0)
    if len(file) != 1 or len(data) != 24 * vertices + 12 * faces:
        raise _damaged(file, "lengths")
    indices = np.frombuffer(data, "<u4", offset=24 * vertices).reshape(-1, 3)
    if (indices >= vertices).any():
        raise _damaged(file, "faces")
    positions = np.frombuffer(data, "<f8", 3 * vertices).reshape(-1, 3)
    return TriMesh.of(positions, indices.astype(np.int32), name=file.name)


def _up_of(file: Container, positions: NDArray[np.float64]) -> str:
    """The axis that points up, once it is sure that the header speaks of these positions."""
    low, high, origin = _box(positions)
    header = file.header
    if header.get("origin") != origin.tolist() or header.get("box") != [low.tolist(), high.tolist()]:
        raise _damaged(file, "box")
    up = header.get("up")
    if up not in ("x", "y", "z"):
        raise _damaged(file, "up")
    return str(up)


def _box(positions: NDArray[np.float64]) -> tuple[NDArray[np.float64], ...]:
    """Least and greatest corner, and the origin: the middle, halved first so that no sum overflows."""
    low, high = positions.min(axis=0), positions.max(axis=0)
    return low, high, 0.5 * low + 0.5 * high


def _sharp(file: Container, vertices: int) -> NDArray[np.int32] | None:
    """The edges that stay sharp; that each is an edge is for whoever refines."""
    listed = file.header.get("sharp_edges", [])
    is_list = isinstance(listed, list) and len(listed) % 2 == 0
    if not is_list or not all(type(v) is int and 0 <= v < vertices for v in listed):
        raise _damaged(file, "sharp_edges")
    return np.array(listed, np.int32).reshape(-1, 2) if listed else None


def _count(file: Container, key: str, least: int = 1) -> int:
    value = file.header.get(key)
    if type(value) is not int or not least <= value <= _MOST:
        raise _damaged(file, key)
    return value


def _damaged(file: Container, what: str) -> FovealError:
    return FovealError(f"{file.name}: its header is damaged ({what}). Copy or build the file again.")
