"""Where a surface stands, in one place or in many."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foveal.base.errors import FovealError

__all__ = ["Placements"]

Floats = NDArray[np.float64]


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
            If they are no such matrices, or cannot be inverted.
        """
        matrices = np.ascontiguousarray(np.eye(4)[None] if values is None else values, np.float64)
        is_right = matrices.ndim == 3 and matrices.shape[1:] == (4, 4) and len(matrices) > 0
        if not is_right or not np.isfinite(matrices).all() or (matrices[:, 3] != [0, 0, 0, 1]).any():
            raise FovealError(
                f"{name}: placements must be 4 by 4 matrices of finite numbers with the last row 0 0 0 1."
            )
        if (np.linalg.det(matrices[:, :3, :3]) == 0).any():
            raise FovealError(
                f"{name}: a placement flattens the surface; give matrices that can be inverted."
            )
        scales = np.linalg.svd(matrices[:, :3, :3], compute_uv=False)[:, 0]
        return cls(matrices, np.linalg.inv(matrices).astype(np.float64), scales.astype(np.float64))

    def __len__(self) -> int:
        return len(self.matrices)
