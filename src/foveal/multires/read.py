"""Reading a `.fov` of patches: graph, single patches, and whole surfaces at any cut."""

import os
from types import TracebackType
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foveal.base.errors import FovealError
from foveal.container import Container, open_container
from foveal.lod.select import cut_by_error
from foveal.mesh.trimesh import TriMesh

from . import codec, graph_chunk

__all__ = ["Multires", "extract", "open_multires"]

VERSION = 1


class Multires:
    """An open multiresolution file. Patches are read and decoded when asked for.

    Attributes
    ----------
    name : str
        For messages.
    header : dict
        As spec/container.md lists it.
    graph : Graph
        Lengths in the asset's unit, spheres relative to `header["origin"]`.
    tables : codec.Tables
    has_normals, has_colours : bool

    Examples
    --------
    >>> import tempfile, pathlib
    >>> from foveal import multires
    >>> from foveal.mesh.shapes import icosphere
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "ball.fov"
    >>> _ = multires.build(icosphere(3), path, bits=12)
    >>> with multires.open(path) as asset:
    ...     all_nodes = np.ones(len(asset.graph.errors), bool)
    ...     len(asset.mesh_of(all_nodes).faces)
    1280
    """

    def __init__(self, container: Container) -> None:
        self._container = container
        self.name = container.name
        container.expect("multires", VERSION)
        self.header: dict[str, Any] = container.header
        nodes, patches = self._count("nodes"), self._count("patches")
        if len(container) != nodes + 1:
            raise self._damaged("chunks")
        self.graph, tables = graph_chunk.unpack(container.chunk(0), nodes, patches, name=self.name)
        self.tables = codec.Tables.from_bytes(tables)
        self.origin, self.step = self._grid()
        names = self._streams()
        self.has_normals, self.has_colours = "normal" in names, "colour" in names
        if (self.graph.node_bytes != container.lengths[1:]).any():
            raise self._damaged("lengths")

    def _damaged(self, what: str) -> FovealError:
        return FovealError(f"{self.name}: its header is damaged ({what}). Copy or build the file again.")

    def _count(self, key: str) -> int:
        value = self.header.get(key)
        if type(value) is not int or not 1 <= value < 1 << 31:
            raise self._damaged(key)
        return value

    def _grid(self) -> tuple[NDArray[np.float64], float]:
        try:
            origin, step = np.array(self.header["origin"], np.float64), float(self.header["step"])
        except (KeyError, TypeError, ValueError) as error:
            raise self._damaged("origin or step") from error
        if origin.shape != (3,) or not np.isfinite(origin).all() or not (np.isfinite(step) and step > 0):
            raise self._damaged("origin or step")
        return origin, step

    def _streams(self) -> list[str]:
        try:
            return [stream["name"] for stream in self.header["streams"]]
        except (KeyError, TypeError) as error:
            raise self._damaged("streams") from error

    def node_patches(self, node: int, /) -> list[codec.Patch]:
        """The decoded patches of a node.

        Raises
        ------
        FovealError
            If their bytes are damaged.
        """
        data = self._container.chunk(1 + node)
        graph = self.graph
        first, last = int(graph.first_patch[node]), int(graph.first_patch[node + 1])
        found, at = [], 0
        for i in range(first, last):
            end = at + int(graph.patch_bytes[i])
            found.append(self._decode(i, data[at:end]))
            at = end
        return found

    def patch(self, number: int, /) -> codec.Patch:
        """One decoded patch; vertices and triangles may stand in another order than when built."""
        node = int(self.graph.owner[number])
        first = int(self.graph.first_patch[node])
        begin = int(self.graph.patch_bytes[first:number].sum())
        data = self._container.chunk(1 + node)
        return self._decode(number, data[begin : begin + int(self.graph.patch_bytes[number])])

    def _decode(self, number: int, data: bytes) -> codec.Patch:
        vertices, triangles = int(self.graph.vertices[number]), int(self.graph.triangles[number])
        try:
            patch = codec.decode(
                data,
                self.tables,
                has_normals=self.has_normals,
                has_colours=self.has_colours,
                max_vertices=vertices,
                max_triangles=triangles,
            )
        except FovealError as error:
            raise FovealError(f"{self.name}: patch {number}: {error}") from error
        if len(patch.positions) != vertices or len(patch.faces) != triangles:
            raise FovealError(
                f"{self.name}: patch {number} does not hold what the graph says. "
                "Copy or build the file again."
            )
        return patch

    def shown(self, expanded: ArrayLike, /) -> NDArray[np.int64]:
        """The patches on the surface of a cut: of expanded nodes, not refined by an expanded one."""
        mask = np.asarray(expanded, np.bool_)
        finer = self.graph.finer
        return np.flatnonzero(mask[self.graph.owner] & ((finer < 0) | ~mask[finer]))

    def mesh_of(self, expanded: ArrayLike, /) -> TriMesh:
        """The surface of a cut, welded along the borders of its patches.

        Parameters
        ----------
        expanded : (nodes,) bool
            Which nodes are expanded: node 0, and with a node all its parents. `lod.select.cut` and
            `cut_by_error` give such masks.

        Returns
        -------
        TriMesh
            In the asset's unit and axes. Vertices at one place in different patches become one. Every
            triangle of the patches is there, also such as have two corners in one vertex.
        """
        mask = np.asarray(expanded)
        if mask.dtype != np.bool_ or mask.shape != (len(self.graph.errors),):
            raise ValueError(f"expanded must be bool of shape ({len(self.graph.errors)},), got {mask.shape}")
        wanted = self.shown(mask)
        if len(wanted) == 0:
            raise FovealError(f"{self.name}: no patch is shown at this cut; expand node 0 at least.")
        patches: list[codec.Patch] = []
        inside = set(wanted.tolist())
        for node in np.unique(self.graph.owner[wanted]).tolist():
            first = int(self.graph.first_patch[node])
            patches += [p for i, p in enumerate(self.node_patches(node), first) if i in inside]
        return self._joined(patches)

    def _joined(self, patches: list[codec.Patch]) -> TriMesh:
        offsets = np.cumsum([0] + [len(p.positions) for p in patches])
        positions = np.concatenate([p.positions for p in patches])
        faces = np.concatenate([p.faces + o for p, o in zip(patches, offsets[:-1], strict=True)])
        first, number = _merge_borders(positions, offsets)
        faces = number[faces].astype(np.int32)
        points = self.origin + self.step * positions[first].astype(np.float64)
        normals = colours = None
        if self.has_normals:
            octahedral = np.concatenate([p.normals for p in patches if p.normals is not None])
            normals = codec.dequantise_normals(octahedral[first], bits=self.tables.normal_bits)
        if self.has_colours:
            colours = np.concatenate([p.colours for p in patches if p.colours is not None])[first]
        return TriMesh(points, faces, normals, colours)

    def close(self) -> None:
        """Close the file."""
        self._container.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def _merge_borders(
    positions: NDArray[np.int32], offsets: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """(first, number): which vertices stay, and the new number of each.

    What lies at one place in several patches becomes one vertex. Which of a patch's vertices at a place
    is the neighbour's cannot be told, and need not: making one of them all keeps an even number of
    triangles on each edge. Inside a patch vertices that quantisation put together stay apart.
    """
    patch = np.repeat(np.arange(len(offsets) - 1), np.diff(offsets))
    order = np.lexsort((patch, positions[:, 2], positions[:, 1], positions[:, 0]))
    is_new = np.append(True, (positions[order[1:]] != positions[order[:-1]]).any(axis=1))
    begins = np.flatnonzero(is_new)
    ends = np.append(begins[1:], len(order))
    is_shared = patch[order[begins]] != patch[order[ends - 1]]
    is_new |= ~np.repeat(is_shared, ends - begins)
    number = np.empty(len(positions), np.int64)
    number[order] = np.cumsum(is_new) - 1
    return order[is_new], number


def open_multires(source: str | os.PathLike[str] | bytes, /, *, name: str | None = None) -> Multires:
    """Open a multiresolution `.fov`: a path, an address that fsspec knows, or its bytes.

    Raises
    ------
    FovealError
        If it cannot be read, is of another kind or version, or is damaged.
    """
    container = open_container(source, name=name)
    try:
        return Multires(container)
    except BaseException:
        container.close()
        raise


def extract(asset: Multires, /, *, error: float | None = None) -> TriMesh:
    """The coarsest surface whose distance to the original is at most `error`, in the asset's unit.

    Without `error` the original resolution. An `error` below what the finest level can promise gives the
    finest level.
    """
    return asset.mesh_of(cut_by_error(asset.graph, error=error).expanded)
