"""Is a multires file sound, and are its promises true?"""

import os
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError
from foveal.base.progress import SILENT, Progress
from foveal.mesh.trimesh import TriMesh

from .pieces import is_proper
from .read import Multires, open_multires

__all__ = ["CheckReport", "boundary_edges", "check"]

_CUTS = 8


@dataclass
class CheckReport:
    """What `check` looked at.

    Attributes
    ----------
    nodes, patches, triangles : int
    is_closed : bool
        Whether the original resolution has no boundary edge; then no cut may have one.
    cuts : int
        How many random cuts were looked at.
    looseness : list of float
        With `deep`, for each uniform cut from fine to coarse: the largest stored error over the largest
        sampled distance.
    """

    nodes: int
    patches: int
    triangles: int
    is_closed: bool
    cuts: int
    looseness: list[float] = field(default_factory=list)


def check(
    path: str | os.PathLike[str],
    /,
    *,
    deep: bool = False,
    original: TriMesh | None = None,
    progress: Progress = SILENT,
) -> CheckReport:
    """Verify a multires file: checksums, every patch, the graph, borders at random cuts.

    Parameters
    ----------
    deep : bool
        Also measure the distance of each level to the original both ways, by samples, against the errors
        that the file promises.
    original : TriMesh, optional
        What the file was built from, for `deep`; without it the finest level stands in.

    Raises
    ------
    FovealError
        At the first thing that is wrong.
    """
    with open_multires(path) as asset:
        _check_graph(asset)
        with progress.stage("Decoding", float(len(asset.graph.errors))) as stage:
            for node in range(len(asset.graph.errors)):
                for number, patch in enumerate(asset.node_patches(node)):
                    _check_patch(asset, node, number, patch.positions, patch.faces)
                stage.advance()
        count = len(asset.graph.errors)
        finest = asset.mesh_of(np.ones(count, np.bool_))
        is_closed = boundary_edges(finest.faces) == 0
        if is_closed:
            generator = np.random.default_rng(0)
            for _ in range(_CUTS):
                _check_cut(asset, _random_cut(asset, generator))
        report = CheckReport(
            count, len(asset.graph.finer), int(asset.graph.triangles.sum()), is_closed, _CUTS * is_closed
        )
        if deep:
            report.looseness = _measure(asset, original or finest, original is None)
    return report


def boundary_edges(faces: NDArray[np.int32], /) -> int:
    """How many edges have exactly one triangle; from a vertex to itself is no edge.

    Examples
    --------
    >>> boundary_edges(np.array([[0, 1, 2], [0, 2, 3]], np.int32))
    4
    """
    ends = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1).astype(np.int64)
    ends = ends[ends[:, 0] != ends[:, 1]]
    _, uses = np.unique(ends[:, 0] << 32 | ends[:, 1], return_counts=True)
    return int((uses == 1).sum())


def _proper(mesh: TriMesh) -> TriMesh:
    """Without triangles that have two corners in one point: of them errors promise nothing."""
    _, place = np.unique(mesh.positions, axis=0, return_inverse=True)
    faces = mesh.faces[is_proper(place.reshape(-1).astype(np.int32)[mesh.faces])]
    return TriMesh(mesh.positions, faces) if len(faces) else mesh


def _wrong(asset: Multires, what: str) -> FovealError:
    return FovealError(f"{asset.name}: {what}. Build the file again.")


def _check_graph(asset: Multires) -> None:
    graph = asset.graph
    refined = graph.finer >= 0
    parent, child = graph.owner[refined], graph.finer[refined]
    if (graph.errors[parent] < graph.errors[child]).any():
        raise _wrong(asset, "a node promises a smaller error than one below it")
    apart = np.linalg.norm(graph.centres[parent] - graph.centres[child], axis=1)
    if (apart + graph.radii[child] > graph.radii[parent] * (1 + 1e-6)).any():
        raise _wrong(asset, "the sphere of a node does not hold those below it")
    if len(np.unique(child)) != len(graph.errors) - 1:
        raise _wrong(asset, "there is a node that no patch leads to")
    if int(graph.triangles[~refined].sum()) != asset.header.get("triangles"):
        raise _wrong(asset, "the finest patches do not hold as many triangles as the header says")


def _check_patch(
    asset: Multires, node: int, number: int, positions: NDArray[np.int32], faces: NDArray[np.int32]
) -> None:
    graph = asset.graph
    low, high = np.array(asset.header["box"])
    if (positions < low).any() or (positions > high).any():
        raise _wrong(asset, f"patch {number} of node {node} leaves the box of the header")
    if len(faces) and (faces.min() < 0 or faces.max() >= len(positions)):
        raise _wrong(asset, f"patch {number} of node {node} names a vertex it does not have")
    apart = np.linalg.norm(positions * asset.step - graph.centres[node], axis=1)
    if (apart > graph.radii[node] * (1 + 1e-6)).any():
        raise _wrong(asset, f"patch {number} of node {node} leaves the node's sphere")


def _random_cut(asset: Multires, generator: np.random.Generator) -> NDArray[np.bool_]:
    chance = generator.random() ** 0.3
    expanded = np.zeros(len(asset.graph.errors), np.bool_)
    expanded[0] = True
    for node in range(1, len(expanded)):
        expanded[node] = expanded[asset.graph.parents[node]].all() and generator.random() < chance
    return expanded


def _check_cut(asset: Multires, expanded: NDArray[np.bool_]) -> None:
    open_edges = boundary_edges(asset.mesh_of(expanded).faces)
    if open_edges:
        raise _wrong(asset, f"a cut of {int(expanded.sum())} nodes has a crack ({open_edges} open edges)")


def _measure(asset: Multires, original: TriMesh, is_finest: bool) -> list[float]:
    """Cuts at falling errors: what is drawn may not be farther from the original than promised."""
    from foveal.mesh.distance import sampled_hausdorff

    graph = asset.graph
    # The finest level itself is quantised: what was measured from it may miss that much.
    allowance = float(asset.header.get("finest_error", asset.step)) if is_finest else 0.0
    looseness = []
    original = _proper(original)
    finite = np.unique(graph.errors[1:])
    for error in finite[:: max(1, len(finite) // 8)]:
        expanded = graph.errors > error
        mesh = _proper(asset.mesh_of(expanded))
        promised = float(graph.errors[~expanded].max(initial=0.0))
        found = float(max(sampled_hausdorff(mesh, original)))
        if found > promised + allowance:
            raise _wrong(asset, f"at an error of {promised:.6g} the surface is {found:.6g} from the original")
        looseness.append(promised / found if found > 0 else 1.0)
    return looseness
