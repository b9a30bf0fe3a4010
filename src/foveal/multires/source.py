"""A `.fov` as input of a build, patch by patch: other bits, other normals, without the scan it came from."""

import os
from dataclasses import dataclass, field

import numpy as np

from foveal.mesh.io import FaceBlock, MeshSource, VertexBlock
from foveal.mesh.io.blocks import Blocks

from . import codec
from .read import open_multires

__all__ = ["source_of"]


@dataclass
class _FinestPatches(MeshSource):
    path: str = field(kw_only=True)

    def blocks(self) -> Blocks:
        offset = 0
        self.bytes_read = 0
        with open_multires(self.path, name=self.name) as asset:
            is_finest = asset.graph.finer < 0
            for node in np.unique(asset.graph.owner[is_finest]).tolist():
                first = int(asset.graph.first_patch[node])
                for number, patch in enumerate(asset.node_patches(node), first):
                    if not is_finest[number]:
                        continue
                    normals = None
                    if patch.normals is not None:
                        normals = codec.dequantise_normals(patch.normals, bits=asset.tables.normal_bits)
                    yield VertexBlock(
                        asset.origin + asset.step * patch.positions.astype(np.float64), normals, patch.colours
                    )
                    yield FaceBlock(patch.faces.astype(np.int64) + offset)
                    offset += len(patch.positions)
                self.bytes_read += int(asset.graph.node_bytes[node])


def source_of(path: str | os.PathLike[str], /, *, up: str | None = None) -> MeshSource:
    """The finest level of a `.fov` as blocks, one patch in memory at a time.

    Vertices on the borders of patches come once for each patch, at exactly the same position, so that the
    builder makes them one again.

    Parameters
    ----------
    path
        The `.fov`.
    up : "x", "y" or "z", optional
        By default the file's.

    Raises
    ------
    FovealError
        If the file cannot be read; while blocks are taken, if a patch is damaged.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> from foveal import multires
    >>> from foveal.mesh.io.source import mesh_of
    >>> from foveal.mesh.shapes import icosphere
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "ball.fov"
    >>> _ = multires.build(icosphere(3), path, bits=12)
    >>> len(mesh_of(multires.source_of(path)).faces)
    1280
    """
    text = os.fspath(path)
    with open_multires(text) as asset:
        is_finest = asset.graph.finer < 0
        nodes = np.unique(asset.graph.owner[is_finest])
        return _FinestPatches(
            name=asset.name,
            up=up or str(asset.header.get("up", "y")),
            has_normals=asset.has_normals,
            has_colours=asset.has_colours,
            size_hint=int(asset.graph.node_bytes[nodes].sum()),
            path=text,
        )
