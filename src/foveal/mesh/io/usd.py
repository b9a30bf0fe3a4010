"""Control meshes from USD, whose own tags are OpenSubdiv's."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError

from ..colours import srgb_of_linear
from ..polymesh import Boundary, PolyMesh

__all__ = ["SUFFIXES", "meshes_of", "read_usd"]

SUFFIXES = {".usd", ".usda", ".usdc", ".usdz"}
_NAMED = 10  # of the meshes of a file, in an error

_BOUNDARIES: dict[str, Boundary] = {
    "none": "none",
    "edgeOnly": "edge_only",
    "edgeAndCorner": "edge_and_corner",
}


def read_usd(path: Path, /, *, prim: str | None = None) -> PolyMesh:
    """Read a Mesh of a USD file, of its first frame, in its own axes, without the transforms above it.

    Kept are points, faces (turned round where the orientation is left-handed), creases, corners,
    interpolateBoundary, holes, and of the primvars displayColor and st where they have one value a vertex
    (or, as a colour, one for all). It needs the extra `usd`.

    Parameters
    ----------
    prim : str, optional
        The path of the mesh in the file, such as "/town/house"; otherwise the first in the file's order.

    Raises
    ------
    FovealError
        If usd-core is missing, the file cannot be read, there is no such mesh, its subdivision scheme is not
        Catmull-Clark, its arrays do not fit together, or it is no surface: see `PolyMesh.checked`.
    """
    stage, geometry = _opened(path)
    mesh = _found(stage, geometry, prim, path.name)
    name = f"{path.name}: {mesh.GetPath()}"
    scheme = mesh.GetSubdivisionSchemeAttr().Get()
    if scheme != "catmullClark":
        raise FovealError(
            f'{name}: its subdivisionScheme is "{scheme}", and only "catmullClark" is read. Set it to that.'
        )
    points, primvars = _values(mesh.GetPointsAttr()), geometry.PrimvarsAPI(mesh)
    parts: list[Any] = [points, *_faces(mesh, name), *_creases(mesh, name)]
    parts += [_values(mesh.GetCornerIndicesAttr()), _values(mesh.GetCornerSharpnessesAttr())]
    parts += [_boundary(mesh, name), _colours(primvars, len(points))]
    parts += [_of_vertices(primvars.GetPrimvar("st"), len(points)), _values(mesh.GetHoleIndicesAttr())]
    return PolyMesh(*parts).checked(name)


def meshes_of(path: Path, /) -> list[str]:
    """The paths of all meshes in a USD file, in its order.

    Raises
    ------
    FovealError
        If usd-core is missing, or the file cannot be read.
    """
    stage, geometry = _opened(path)
    return [str(mesh.GetPath()) for mesh in stage.Traverse() if mesh.IsA(geometry.Mesh)]


def _opened(path: Path) -> tuple[Any, Any]:
    """The stage, and the library that knows meshes."""
    try:
        from pxr import Tf, Usd, UsdGeom
    except ImportError:
        raise FovealError(
            f"{path.name}: reading USD needs usd-core, which is not installed. Run pip install foveal[usd]."
        ) from None
    if not path.is_file():
        raise FovealError(f"{path}: there is no such file. Check the path.")
    try:
        stage = Usd.Stage.Open(str(path))
    except Tf.ErrorException:
        raise FovealError(
            f"{path.name}: it cannot be read as USD. The file is damaged; export it again."
        ) from None
    return stage, UsdGeom


def _found(stage: Any, geometry: Any, path: str | None, name: str) -> Any:
    there = [found for found in stage.Traverse() if found.IsA(geometry.Mesh)]
    for found in there:
        if path in (None, str(found.GetPath())):
            return geometry.Mesh(found)
    if not there:
        raise FovealError(f"{name}: there is no Mesh in it. Choose a file with one.")
    names = ", ".join(str(found.GetPath()) for found in there[:_NAMED])
    more = f" and {len(there) - _NAMED} more" if len(there) > _NAMED else ""
    raise FovealError(f'{name}: there is no Mesh "{path}" in it. Choose one by --prim: {names}{more}.')


def _values(attribute: Any) -> NDArray[Any]:
    """An attribute's array, of the first frame where it is animated, of length 0 where it has none."""
    frames = attribute.GetTimeSamples()
    return np.array((attribute.Get(frames[0]) if frames else attribute.Get()) or [])


def _faces(mesh: Any, name: str) -> tuple[NDArray[np.int64], NDArray[Any]]:
    sizes = _values(mesh.GetFaceVertexCountsAttr()).astype(np.int64)
    corners = _values(mesh.GetFaceVertexIndicesAttr())
    starts = np.concatenate([[0], np.cumsum(sizes)])
    if (sizes < 0).any() or starts[-1] != len(corners):
        raise FovealError(
            f"{name}: its faceVertexCounts add up to {sizes.sum()}, but there are {len(corners)}"
            " faceVertexIndices. The file is damaged; export it again."
        )
    if mesh.GetOrientationAttr().Get() == "leftHanded":  # the first corner stays the first
        corners = np.concatenate(
            [np.roll(face[::-1], 1) for face in np.split(corners, starts[1:-1])] or [corners]
        )
    return starts, corners


def _creases(mesh: Any, name: str) -> tuple[NDArray[Any], NDArray[Any]]:
    """Chains of vertices, each with one sharpness or one an edge, as edges."""
    vertices = _values(mesh.GetCreaseIndicesAttr())
    lengths = _values(mesh.GetCreaseLengthsAttr()).astype(np.int64)
    sharpness = _values(mesh.GetCreaseSharpnessesAttr())
    edges = lengths - 1
    is_sound = (lengths >= 2).all() and lengths.sum() == len(vertices)
    if not is_sound or len(sharpness) not in (len(lengths), edges.sum()):
        raise FovealError(
            f"{name}: its creaseLengths, creaseIndices and creaseSharpnesses do not fit together."
            " The file is damaged; export it again."
        )
    if len(sharpness) == len(lengths):
        sharpness = np.repeat(sharpness, edges)
    is_begin = np.ones(len(vertices), np.bool_)
    is_begin[np.cumsum(lengths) - 1] = False
    begin = np.flatnonzero(is_begin)
    return np.stack([vertices[begin], vertices[begin + 1]], axis=1), sharpness


def _boundary(mesh: Any, name: str) -> Boundary:
    rule = mesh.GetInterpolateBoundaryAttr().Get()
    if rule not in _BOUNDARIES:
        raise FovealError(f'{name}: its interpolateBoundary "{rule}" is not known. Set it to "edgeOnly".')
    return _BOUNDARIES[rule]


def _of_vertices(primvar: Any, count: int) -> NDArray[Any] | None:
    """A primvar's values if they are one a vertex."""
    if not primvar or primvar.GetInterpolation() not in ("vertex", "varying"):
        return None
    values = np.array(primvar.ComputeFlattened() or [])
    return values if len(values) == count else None


def _colours(primvars: Any, count: int) -> NDArray[np.uint8] | None:
    """The linear colours of a file as sRGB."""
    primvar = primvars.GetPrimvar("displayColor")
    linear = _of_vertices(primvar, count)
    if linear is None and primvar and primvar.GetInterpolation() == "constant":
        given = np.array(primvar.Get() or [])
        linear = np.repeat(given, count, axis=0) if len(given) == 1 else None
    if linear is None:
        return None
    return srgb_of_linear(linear)
