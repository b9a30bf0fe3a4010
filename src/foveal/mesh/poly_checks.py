"""The door of polygon meshes: what leaves it is an oriented manifold surface with sound tags."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from foveal.base.errors import FovealError

from .polymesh import BOUNDARIES

if TYPE_CHECKING:
    from .polymesh import PolyMesh

__all__ = ["checked", "numbers", "whole_numbers"]

_MOST = 2**31 - 1  # what int32 can number


def checked(mesh: "PolyMesh", name: str) -> "PolyMesh":
    """See `PolyMesh.checked`."""
    positions = _positions(mesh.positions, name)
    starts, corners = _faces(mesh.starts, mesh.corners, len(positions), name)
    edges = _edges(starts, corners, len(positions), name)
    if mesh.boundary not in BOUNDARIES:
        raise FovealError(
            f'{name}: the boundary must be "edge_only", "edge_and_corner" or "none", got {mesh.boundary!r}.'
        )
    creases = _creases(mesh.crease_edges, mesh.crease_sharpness, edges, len(positions), name)
    tags = _corners(mesh.corner_vertices, mesh.corner_sharpness, len(positions), name)
    colours = _attribute("colours", mesh.colours, (len(positions), 3), name)
    if colours is not None and ((colours < 0) | (colours > 255)).any():
        raise FovealError(f"{name}: colours must be from 0 to 255. From 0 to 1, multiply by 255.")
    uvs = _attribute("uvs", mesh.uvs, (len(positions), 2), name)
    holes = _holes(mesh.holes, len(starts) - 1, name)
    return type(mesh)(positions, starts, corners, *creases, *tags, mesh.boundary, colours, uvs, holes)


def _holes(values: ArrayLike, faces: int, name: str) -> NDArray[np.int32]:
    holes = np.unique(whole_numbers("holes", values, name, (-1,)))
    if len(holes) and not 0 <= holes[0] <= holes[-1] < faces:
        wrong = holes[0] if holes[0] < 0 else holes[-1]
        raise FovealError(f"{name}: face {wrong} is to be a hole, but faces go from 0 to {faces - 1}.")
    if len(holes) == faces:
        raise FovealError(f"{name}: all its faces are holes, so there is no surface.")
    return holes.astype(np.int32)


def numbers(what: str, values: ArrayLike, name: str, shape: tuple[int, ...]) -> NDArray[Any]:
    """Real numbers of a shape (-1 for any length), contiguous."""
    return _array(what, values, name, shape, "biuf", "real numbers")


def whole_numbers(what: str, values: ArrayLike, name: str, shape: tuple[int, ...]) -> NDArray[np.int64]:
    """Integers of a shape (-1 for any length), contiguous, as int64."""
    return _array(what, values, name, shape, "iu", "integers").astype(np.int64)


def _array(
    what: str, values: ArrayLike, name: str, shape: tuple[int, ...], kinds: str, must: str
) -> NDArray[Any]:
    shown = "(" + ", ".join("n" if n < 0 else str(n) for n in shape) + ("," if len(shape) == 1 else "") + ")"
    try:
        array = np.asarray(values)
    except (ValueError, OverflowError) as error:  # rows of several lengths
        raise FovealError(f"{name}: {what} must be {must} of shape {shown}.") from error
    if array.size == 0 and shape[0] == -1:
        array = array.reshape(0, *shape[1:]).astype(np.int64)  # an empty list is of floats
    is_shaped = array.ndim == len(shape) and all(
        n in (-1, got) for n, got in zip(shape, array.shape, strict=True)
    )
    if array.dtype.kind not in kinds or not is_shaped:
        raise FovealError(f"{name}: {what} must be {must} of shape {shown}, got {array.dtype} {array.shape}.")
    return np.ascontiguousarray(array)


def _positions(values: ArrayLike, name: str) -> NDArray[np.float64]:
    positions = numbers("positions", values, name, (-1, 3)).astype(np.float64, copy=False)
    is_finite = np.isfinite(positions).all(axis=1)
    if not is_finite.all():
        raise FovealError(
            f"{name}: vertex {int(is_finite.argmin())} has a coordinate that is NaN or infinite."
            " Repair the mesh in an editor."
        )
    if len(positions) > _MOST:
        raise FovealError(f"{name}: it has {len(positions)} vertices; at most {_MOST} can be numbered.")
    return positions


def _faces(
    starts: ArrayLike, corners: ArrayLike, vertices: int, name: str
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    begins, indices = (
        whole_numbers("starts", starts, name, (-1,)),
        whole_numbers("corners", corners, name, (-1,)),
    )
    if len(begins) == 0 or begins[0] != 0 or begins[-1] != len(indices) or len(indices) > _MOST:
        raise FovealError(f"{name}: starts must go from 0 to the number of corners, {len(indices)}.")
    if len(begins) == 1:
        raise FovealError(f"{name}: there is no face in it.")
    sizes = np.diff(begins)
    if sizes.min() < 3:
        face = int((sizes < 3).argmax())
        raise FovealError(
            f"{name}: face {face} has {max(0, sizes[face])} corners, and at least three make a face."
        )
    face_of = np.repeat(np.arange(len(sizes)), sizes)
    is_wrong = (indices < 0) | (indices >= vertices)
    if is_wrong.any():
        at = int(is_wrong.argmax())
        raise FovealError(
            f"{name}: face {face_of[at]} names vertex {indices[at]}, but vertices go from 0 to"
            f" {vertices - 1}."
        )
    order = np.lexsort((indices, face_of))
    is_twice = (np.diff(indices[order]) == 0) & (np.diff(face_of[order]) == 0)
    if is_twice.any():
        at = order[int(is_twice.argmax())]
        raise FovealError(
            f"{name}: face {face_of[at]} has vertex {indices[at]} twice. Remove it, or repair the mesh."
        )
    return begins.astype(np.int32), indices.astype(np.int32)


def _edges(
    starts: NDArray[np.int32], corners: NDArray[np.int32], vertices: int, name: str
) -> NDArray[np.int64]:
    """The edges' keys, lower vertex · vertices + upper, ascending, once they are known to make a surface."""
    following = np.arange(1, len(corners) + 1)
    following[starts[1:] - 1] = starts[:-1]
    begin, end = corners.astype(np.int64), corners[following].astype(np.int64)
    keys = np.minimum(begin, end) * vertices + np.maximum(begin, end)
    order = np.argsort(keys, kind="stable")
    same = np.diff(keys[order]) == 0
    if (same[1:] & same[:-1]).any():
        at = order[int((same[1:] & same[:-1]).argmax())]
        raise FovealError(
            f"{name}: the edge between vertices {begin[at]} and {end[at]} has more than two faces, so there"
            " is no surface to subdivide. Split the mesh there."
        )
    first, second = order[:-1][same], order[1:][same]
    alike = begin[first] == begin[second]
    if alike.any():
        at = first[int(alike.argmax())]
        raise FovealError(
            f"{name}: the two faces at the edge between vertices {begin[at]} and {end[at]} face opposite"
            " sides. Orient the mesh's faces alike."
        )
    _refuse_fans(corners, (first, second), following, vertices, name)
    kept: NDArray[np.int64] = keys[order][np.concatenate([[True], ~same])]
    return kept


def _refuse_fans(
    corners: NDArray[np.int32],
    mates: tuple[NDArray[np.int64], NDArray[np.int64]],
    following: NDArray[np.int64],
    vertices: int,
    name: str,
) -> None:
    """The corners at a vertex, joined across the edges that meet there, must be one fan."""
    first, second = mates
    links = np.concatenate([first, second]), following[np.concatenate([second, first])]
    graph = coo_array((np.ones(len(links[0]), np.int8), links), shape=(len(corners), len(corners)))
    _, fan = connected_components(graph, directed=False)
    fan_of_vertex = np.full(vertices, -1, np.int64)
    fan_of_vertex[corners] = fan
    strays = fan_of_vertex[corners] != fan
    if strays.any():
        raise FovealError(
            f"{name}: at vertex {corners[int(strays.argmax())]} several fans of faces touch, so there is no"
            " surface to subdivide. Give each fan a vertex of its own."
        )


def _creases(
    edges: ArrayLike, sharpness: ArrayLike, known: NDArray[np.int64], vertices: int, name: str
) -> tuple[NDArray[np.int32], NDArray[np.float32]]:
    pairs = whole_numbers("crease edges", edges, name, (-1, 2))
    sharp = _sharpness("crease", sharpness, len(pairs), name)
    lower, upper = pairs.min(axis=1, initial=_MOST), pairs.max(axis=1, initial=-1)
    is_edge = (lower >= 0) & (upper < vertices) & np.isin(lower * vertices + upper, known)
    if not is_edge.all():
        a, b = pairs[int(is_edge.argmin())]
        raise FovealError(
            f"{name}: there is no edge between vertices {a} and {b} that could be a crease."
            " Name the two ends of a face's edge."
        )
    _refuse_sharpness(sharp, name, lambda i: f"the crease between vertices {pairs[i, 0]} and {pairs[i, 1]}")
    # The last of each: the first in reverse.
    _, at = np.unique((lower * vertices + upper)[::-1], return_index=True)
    kept = len(pairs) - 1 - at
    return np.stack([lower, upper], axis=1)[kept].astype(np.int32), sharp[kept]


def _corners(
    indices: ArrayLike, sharpness: ArrayLike, vertices: int, name: str
) -> tuple[NDArray[np.int32], NDArray[np.float32]]:
    corners = whole_numbers("corner vertices", indices, name, (-1,))
    sharp = _sharpness("corner", sharpness, len(corners), name)
    is_vertex = (corners >= 0) & (corners < vertices)
    if not is_vertex.all():
        raise FovealError(
            f"{name}: there is no vertex {corners[int(is_vertex.argmin())]} that could be a sharp corner."
            f" Vertices go from 0 to {vertices - 1}."
        )
    _refuse_sharpness(sharp, name, lambda i: f"the corner at vertex {corners[i]}")
    _, at = np.unique(corners[::-1], return_index=True)
    kept = len(corners) - 1 - at
    return corners[kept].astype(np.int32), sharp[kept]


def _sharpness(what: str, values: ArrayLike, count: int, name: str) -> NDArray[np.float32]:
    with np.errstate(over="ignore"):  # 1e300 is infinitely sharp, too
        return numbers(f"{what} sharpness", values, name, (count,)).astype(np.float32)


def _refuse_sharpness(sharp: NDArray[np.float32], name: str, which: Any) -> None:
    is_wrong = ~(sharp >= 0)
    if is_wrong.any():
        at = int(is_wrong.argmax())
        raise FovealError(
            f"{name}: {which(at)} has the sharpness {sharp[at]}, which must be 0 (smooth) or more."
        )


def _attribute(
    what: str, values: ArrayLike | None, shape: tuple[int, int], name: str
) -> NDArray[np.float32] | None:
    if values is None:
        return None
    array = numbers(what, values, name, shape).astype(np.float32)
    is_finite = np.isfinite(array).all(axis=1)
    if not is_finite.all():
        raise FovealError(f"{name}: the {what} of vertex {int(is_finite.argmin())} are NaN or infinite.")
    return array
