"""Where a surface stands, in one place or in many."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foveal.base.errors import FovealError
from foveal.mesh.polymesh import PolyMesh

__all__ = ["Placements", "placed"]

Floats = NDArray[np.float64]

_FLAT = 1e-12  # of the largest stretch: what is thinner could not be turned back


@dataclass(frozen=True, slots=True)
class Placements:
    """Matrices from the surface's space to the camera's.

    Attributes
    ----------
    matrices, inverses : (k, 4, 4) float64
    scales : (k,) float64
        By how much a length grows, at most.
    """

    matrices: Floats
    inverses: Floats
    scales: Floats

    @classmethod
    def of(cls, values: ArrayLike | None, /, *, name: str) -> "Placements":
        """Checked; none are the one that changes nothing.

        Raises
        ------
        FovealError
            If they are no such matrices, or one cannot be inverted, which is named by its number.
        """
        try:
            matrices = np.ascontiguousarray(np.eye(4)[None] if values is None else values, np.float64)
        except (TypeError, ValueError, OverflowError) as error:
            raise FovealError(f"{name}: placements must be 4 by 4 matrices of numbers ({error}).") from error
        if matrices.ndim != 3 or matrices.shape[1:] != (4, 4) or len(matrices) == 0:
            raise FovealError(f"{name}: placements must be 4 by 4 matrices, (k, 4, 4), got {matrices.shape}.")
        _refuse(~np.isfinite(matrices).all(axis=(1, 2)), name, "has a number that is not finite")
        _refuse((matrices[:, 3] != [0, 0, 0, 1]).any(axis=1), name, "has a last row other than 0 0 0 1")
        scales = np.linalg.svd(matrices[:, :3, :3], compute_uv=False)
        is_flat = scales[:, 2] <= _FLAT * scales[:, 0]
        _refuse(is_flat, name, "flattens the surface; give a matrix that can be inverted")
        return cls(matrices, np.linalg.inv(matrices).astype(np.float64), scales[:, 0].astype(np.float64))

    def __len__(self) -> int:
        return len(self.matrices)


def _refuse(wrong: ArrayLike, name: str, what: str) -> None:
    is_wrong = np.asarray(wrong)
    if is_wrong.any():
        raise FovealError(f"{name}: placement {int(is_wrong.argmax())}, counted from 0, {what}.")


def placed(mesh: PolyMesh, placements: ArrayLike, /) -> PolyMesh:
    """A mesh in all its places, one after the other, as one; mirrored, its faces are turned round.

    Each coordinate is (m0 x + m1 y) + m2 z + m3, the same on every machine.

    Parameters
    ----------
    placements : (k, 4, 4) float

    Examples
    --------
    >>> from foveal.mesh.poly_shapes import cube
    >>> twice = placed(cube(), [np.eye(4), np.diag([-2.0, 1, 1, 1])])
    >>> twice.faces, twice.positions[:, 0].min().tolist(), twice.checked().faces
    (12, -2.0, 12)
    """
    matrices = np.asarray(placements, np.float64)
    k, n = len(matrices), len(mesh.positions)
    x, y, z = mesh.positions.T
    axes = [m[0] * x + m[1] * y + m[2] * z + m[3] for m in matrices[:, :3].reshape(-1, 4)]
    positions = np.stack(axes).reshape(k, 3, n).transpose(0, 2, 1).reshape(-1, 3)
    sizes = np.diff(mesh.starts)
    back = np.repeat(mesh.starts[1:] + mesh.starts[:-1], sizes) - np.arange(len(mesh.corners))
    back = np.where(back == np.repeat(mesh.starts[1:], sizes), np.repeat(mesh.starts[:-1], sizes), back)
    is_mirrored = np.linalg.slogdet(matrices[:, :3, :3]).sign < 0
    corners = np.where(is_mirrored[:, None], mesh.corners[back], mesh.corners)

    return replace(
        mesh,
        positions=np.ascontiguousarray(positions),
        starts=np.concatenate([[0], np.cumsum(np.tile(sizes, k))]).astype(np.int32),
        corners=(corners + np.arange(k)[:, None] * n).reshape(-1).astype(np.int32),
        crease_edges=_numbered(mesh.crease_edges, k, n),
        crease_sharpness=np.tile(mesh.crease_sharpness, k),
        corner_vertices=_numbered(mesh.corner_vertices, k, n),
        corner_sharpness=np.tile(mesh.corner_sharpness, k),
        colours=None if mesh.colours is None else np.tile(mesh.colours, (k, 1)),
        uvs=None if mesh.uvs is None else np.tile(mesh.uvs, (k, 1)),
        holes=_numbered(mesh.holes, k, mesh.faces),
    )


def _numbered(own: NDArray[np.int32], times: int, count: int) -> NDArray[np.int32]:
    """Those of all copies of a mesh of so many vertices, or faces."""
    shift = np.repeat(np.arange(times) * count, len(own))
    copies = np.concatenate([own] * times)
    return (copies + shift.reshape(-1, *(1,) * (own.ndim - 1))).astype(np.int32)
