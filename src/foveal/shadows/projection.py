"""How a light sees: from points of the world to pixels and depths of one shadow map."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["Projection"]


@dataclass(frozen=True, slots=True)
class Projection:
    """A map from the world to a shadow map's square [0, 1)² and its depths.

    With (X, Y, Z, W) = `matrix` @ (x, y, z, 1), a point is at u = X / W to the right, v = Y / W and depth Z,
    which is linear along the light's axis, from 0 to 1. Pixel (i, j) of a map of n pixels a side spans
    i <= u n < i + 1, j <= v n < j + 1; its sample is the middle. Where W <= 0 a point is behind the light.

    Attributes
    ----------
    matrix : (4, 4) float64
        For parallel light, an oblique one too, the last row is 0 0 0 1.

    Examples
    --------
    >>> straight_down = Projection(np.array([[0.1, 0, 0, 0], [0, 0.1, 0, 0], [0, 0, -0.1, 1], [0, 0, 0, 1]]))
    >>> straight_down.project([[5, 2, 10], [0, 0, 0]])
    array([[0.5, 0.2, 0. ],
           [0. , 0. , 1. ]])
    """

    matrix: NDArray[np.float64]

    @property
    def is_parallel(self) -> bool:
        """Whether the light is infinitely far away."""
        return bool((self.matrix[3] == (0, 0, 0, 1)).all())

    def is_mirrored(self) -> bool:
        """Whether right, up and the way of the light are right-handed: outsides are then seen clockwise."""
        axis = self.matrix[2 if self.is_parallel else 3, :3]
        return bool(np.linalg.det(np.stack([*self.matrix[:2, :3], axis])) > 0)

    def lens(self) -> tuple[float, float]:
        """(scale, shift) such that depth is scale W + shift, which holds where light comes from a place."""
        z, w = self.matrix[2], self.matrix[3]
        if self.is_parallel:
            return 0.0, 0.0
        scale = float(z[:3] @ w[:3] / (w[:3] @ w[:3]))
        return scale, float(z[3] - scale * w[3])

    def eye(self) -> NDArray[np.float64]:
        """(3,): where the light is, which only light from a place can say."""
        rows = self.matrix[[0, 1, 3]]
        return np.linalg.solve(rows[:, :3], -rows[:, 3]).astype(np.float64, copy=False)

    def project(self, points: ArrayLike, /) -> NDArray[np.float64]:
        """(n, 3): u, v and depth of (n, 3) points; u and v are NaN behind the light."""
        points = np.asarray(points, dtype=np.float64)
        x, y, z, w = (points @ self.matrix[:, :3].T + self.matrix[:, 3]).T
        w = np.where(w > 0, w, np.nan)
        return np.stack([x / w, y / w, z], axis=-1)
