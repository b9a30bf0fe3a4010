"""The one camera: where the eye is, what it sees, how finely."""

import math
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foveal.base.errors import FovealError

__all__ = ["MAX_SIDE", "Camera"]

MAX_SIDE = 16384
"""Pixels along a side of a picture, at most: what graphics processors take too."""

_FAR, _CLOSE = 1e100, 1e-100  # between them no square overflows or vanishes


@dataclass(frozen=True)
class Camera:
    """A perspective camera. Right-handed; looks along -z of its own frame, y up, as in OpenGL.

    Attributes
    ----------
    position, target, up : (3,) float64
        The eye, the point it looks at, and a direction that shall point up in the picture.
    field_of_view : float
        Vertical, in radians.
    width, height : int
        The picture's size in pixels.
    near, far : float
        Distances of the clipping planes, in the unit of the scene.

    Examples
    --------
    >>> camera = Camera.of([0, 0, 10], [0, 0, 0], width=200, height=100)
    >>> camera.basis()[2]  # backwards
    array([0., 0., 1.])
    """

    position: NDArray[np.float64]
    target: NDArray[np.float64]
    up: NDArray[np.float64]
    field_of_view: float
    width: int
    height: int
    near: float
    far: float

    @classmethod
    def of(
        cls,
        position: ArrayLike,
        target: ArrayLike,
        /,
        *,
        up: ArrayLike = (0.0, 1.0, 0.0),
        field_of_view: float = math.radians(40),
        width: int = 1280,
        height: int = 720,
        near: float | None = None,
        far: float | None = None,
    ) -> Self:
        """A checked camera; near and far default to 1/1000 and 1000 times the distance to the target."""
        eye, aim, above = (_triple(v, n) for v, n in ((position, "position"), (target, "target"), (up, "up")))
        distance = float(np.linalg.norm(aim - eye))
        if distance < _CLOSE:
            raise FovealError("camera: position and target are the same point; move one of them.")
        if not np.linalg.norm(_cross(aim - eye, above)) > 1e-12 * distance * np.linalg.norm(above):
            raise FovealError("camera: it looks along its own up direction; give another up.")
        if not 0 < field_of_view < math.pi:
            raise FovealError(
                "camera: the field of view must be between 0 and 180 degrees, "
                f"got {math.degrees(field_of_view):g}."
            )
        _check_size(width, height)
        near = distance / 1000 if near is None else near
        far = distance * 1000 if far is None else far
        if not 0 < near < far:
            raise FovealError(f"camera: near and far must satisfy 0 < near < far, got {near} and {far}.")
        return cls(eye, aim, above, float(field_of_view), int(width), int(height), float(near), float(far))

    @classmethod
    def around(
        cls,
        low: ArrayLike,
        high: ArrayLike,
        /,
        *,
        direction: ArrayLike = (0.3, 0.25, 1.0),
        up: ArrayLike = (0.0, 1.0, 0.0),
        **options: Any,
    ) -> Self:
        """A camera that just sees the whole box `low` to `high` from `direction` (from the box to the eye).

        It aims at the middle of the box, from 1.12 times the distance that would just do: the viewer's home.
        """
        low, high = _triple(low, "low"), _triple(high, "high")
        towards = _triple(direction, "direction")
        if np.linalg.norm(towards) < _CLOSE:
            raise FovealError("camera: direction has no length; give one from the box to the eye.")
        centre = (low + high) / 2
        size = float(np.linalg.norm(high - low))
        if size < _CLOSE:  # a point: any distance shows all of it
            size = 1.0
        # First from so far that any corner is ahead; the basis does not change on the way to the box.
        camera = cls.of(centre + towards / np.linalg.norm(towards) * size, centre, up=up, **options)
        corners = np.stack(np.meshgrid(*zip(low, high, strict=True)), axis=-1).reshape(-1, 3) - centre
        right, above, backward = camera.basis() @ corners.T
        tan_y = math.tan(camera.field_of_view / 2)
        tan_x = tan_y * camera.width / camera.height
        distance = backward + np.maximum(np.abs(right) / tan_x, np.abs(above) / tan_y)
        away = max(1.12 * float(distance.max()), size / 1000)
        return cls.of(centre + camera.basis()[2] * away, centre, up=up, **options)

    def resized(self, width: int, height: int, /) -> Self:
        """The same camera with a picture of another size; the field of view, being vertical, stays."""
        _check_size(width, height)
        return replace(self, width=int(width), height=int(height))

    def basis(self) -> NDArray[np.float64]:
        """(3, 3): the camera's right, up and backward unit vectors as rows."""
        backward = self.position - self.target
        backward = backward / np.linalg.norm(backward)
        right = _cross(self.up, backward)
        right = right / np.linalg.norm(right)
        return np.stack([right, _cross(backward, right), backward])

    def pixels_per_radian(self) -> float:
        """Picture height over 2 tan(field of view / 2): pixels of a unit length at unit distance."""
        return self.height / (2 * math.tan(self.field_of_view / 2))

    def frustum(self) -> NDArray[np.float64]:
        """(5, 4): the planes near, left, right, bottom, top as (normal, offset), normals unit and inward.

        A point x is inside a plane where `normal @ x + offset >= 0`. The far plane is left out: what is
        far is small, and selection by projected size deals with it.
        """
        right, up, backward = self.basis()
        tan_y = math.tan(self.field_of_view / 2)
        tan_x = tan_y * self.width / self.height
        normals = [
            -backward,
            (right - tan_x * backward) / math.hypot(1, tan_x),
            (-right - tan_x * backward) / math.hypot(1, tan_x),
            (up - tan_y * backward) / math.hypot(1, tan_y),
            (-up - tan_y * backward) / math.hypot(1, tan_y),
        ]
        planes = [(*n, -float(n @ self.position)) for n in normals]
        planes[0] = (*normals[0], planes[0][3] - self.near)
        return np.array(planes)

    def to_json(self) -> dict[str, Any]:
        """A camera file's content; angles in degrees, as everywhere outside Python."""
        return {
            "position": self.position.tolist(),
            "target": self.target.tolist(),
            "up": self.up.tolist(),
            "field_of_view_degrees": math.degrees(self.field_of_view),
            "size": [self.width, self.height],
        }

    @classmethod
    def from_json(cls, data: Any, /, *, name: str = "camera") -> Self:
        """A camera from what `to_json` gives; missing keys take their defaults.

        Raises
        ------
        FovealError
            If `data` is not such an object, in a sentence that begins with `name`.
        """
        try:
            width, height = data.get("size", [1280, 720])
            return cls.of(
                data["position"],
                data["target"],
                up=data.get("up", (0.0, 1.0, 0.0)),
                field_of_view=math.radians(data.get("field_of_view_degrees", 40.0)),
                width=width,
                height=height,
            )
        except FovealError as error:
            raise FovealError(f"{name}: {str(error).removeprefix('camera: ')}") from error
        except (AttributeError, KeyError, TypeError, IndexError, ValueError, OverflowError) as error:
            raise FovealError(
                f'{name}: a camera needs "position" and "target", three numbers each, and may have '
                '"up" (three numbers), "field_of_view_degrees" (one) and "size" (two).'
            ) from error


def _check_size(width: float, height: float) -> None:
    if not (1 <= width <= MAX_SIDE and 1 <= height <= MAX_SIDE):
        raise FovealError(
            f"camera: a picture has from 1 to {MAX_SIDE} pixels a side, got {width:g} x {height:g}."
        )
    if width != int(width) or height != int(height):
        raise FovealError(f"camera: a picture has whole pixels, got {width:g} x {height:g}.")


def _cross(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """As `np.cross`, to the bit, in a tenth of its time: a refinement asks for two with each view."""
    (x, y, z), (u, v, w) = a.tolist(), b.tolist()
    return np.array([y * w - z * v, z * u - x * w, x * v - y * u])


def _triple(values: ArrayLike, name: str) -> NDArray[np.float64]:
    try:
        array = np.array(values)
        # Texts are refused though NumPy would read numbers in them; objects are whole numbers past 64 bits.
        numbers = array.astype(np.float64) if array.dtype.kind in "iufO" else np.empty(0)
    except (TypeError, ValueError, OverflowError):
        numbers = np.empty(0)
    if numbers.shape != (3,) or not (np.abs(numbers) < _FAR).all():
        raise FovealError(
            f"camera: {name} must be three numbers, finite and below 1e100, got {values!r:.99}."
        )
    return numbers
