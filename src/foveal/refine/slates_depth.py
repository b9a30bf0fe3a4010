"""How deep each patch shall be for a view: by curvature, class, projected size, and a budget of triangles."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foveal.view.camera import Camera

from . import _kernels_slates_depth as kernels
from . import _kernels_slates_show as show
from ._kernels_slates_layout import MOST_DEPTH
from .slates_blocks import Blocks
from .slates_cage import SlateCage, SlateNet
from .slates_placements import Placements
from .slates_work import Work

__all__ = ["Depths", "Views"]

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Levels = NDArray[np.int8]


@dataclass(frozen=True, slots=True)
class Depths:
    """The rules by which patches get their depth; each can be left out.

    Attributes
    ----------
    most : int
        No patch is deeper, from 0 to 8. What a rule that is left out would have made coarser has this depth.
    cone : float or None
        Curvature: so deep that the faces around a vertex are within this angle, in radians, of the limit
        normal. None to leave it out.
    backs : bool
        Patches that face away are not subdivided. On open control meshes their backs may be seen, so there
        they count as fronts.
    silhouettes : bool
        Patches that do neither have the mean of `most` and their depth by curvature, rounded up.
    epsilon : float
        A vertex is front or back where the cosine between its normal and the ray exceeds it.
    size_px : (float, float) or None
        The smallest and largest radius, in pixels, of a patch's bounding ball halved as often as it is
        subdivided; the second at least twice the first. None to leave it out.

    Examples
    --------
    >>> from foveal.mesh.poly_shapes import cube
    >>> from foveal.refine import Slates
    >>> from foveal.view.camera import Camera
    >>> surface, camera = Slates(cube()), Camera.of([0, 0, 9], [0, 0, 0])
    >>> surface.update(camera, depths=Depths(cone=None, backs=False, silhouettes=False, size_px=None)).deepest
    5
    >>> _ = surface.update(camera, depths=Depths(most=4, size_px=None))
    >>> surface.arrays().depths  # the face away, the one in front, and those at the silhouette
    array([[0, 3, 4, 4, 4, 4]], dtype=int8)
    """

    most: int = 5
    cone: float | None = math.radians(8)
    backs: bool = True
    silhouettes: bool = True
    epsilon: float = 0.1
    size_px: tuple[float, float] | None = (3.0, 24.0)

    def __post_init__(self) -> None:
        if not 0 <= self.most <= MOST_DEPTH or int(self.most) != self.most:
            raise ValueError(f"most must be a whole number from 0 to {MOST_DEPTH}, got {self.most}")
        if self.cone is not None and not 0 < self.cone <= math.pi:
            raise ValueError(f"cone must be an angle above 0 and at most pi, or None, got {self.cone}")
        if not 0 <= self.epsilon <= 1:
            raise ValueError(f"epsilon must be a cosine from 0 to 1, got {self.epsilon}")
        if self.size_px is not None and not 0 <= 2 * self.size_px[0] <= self.size_px[1]:
            raise ValueError(
                f"size_px must be two radii, the second at least twice the first, got {self.size_px}"
            )


class Views:
    """The rules' answers for placements of a control mesh; what depends on the mesh alone is kept."""

    def __init__(self, cage: SlateCage, blocks: Blocks, /) -> None:
        self._cage, self._blocks = cage, blocks
        self._is_open = bool((cage.net.mates < 0).any()) or not cage.is_shown.all()
        self._cosines: Floats | None = None
        self._curvature: tuple[tuple[float | None, int], Levels] | None = None
        self._balls: Floats | None = None

    @property
    def net(self) -> SlateNet:
        """Of the control mesh."""
        return self._cage.net

    def move(self, vertices: Ints, patches: Ints, /) -> None:
        """What has vertices that moved in its rings is asked anew."""
        self._curvature = None
        if self._cosines is not None:
            self._bend(vertices, self._cosines)
        if self._balls is not None:
            self._surround(patches, self._balls)

    def _bend(self, vertices: Ints, cosines: Floats) -> None:
        data = self._blocks.points[0], self._blocks.corner_normals
        kernels.bends(self.net, Work.of(self.net, 0), *data, vertices, cosines.shape[1], cosines)

    def _surround(self, patches: Ints, balls: Floats) -> None:
        kernels.spheres(self.net, Work.of(self.net, 0), self._blocks.points[0], patches, balls)

    def curvature(self, cone: float | None, most: int, /) -> Levels:
        """(n,): the depth that each vertex needs, by the cone of normals."""
        key = cone, most
        if self._curvature is not None and self._curvature[0] == key:
            return self._curvature[1]
        count = len(self._blocks.points[0])
        levels = np.full(count, most, np.int8)
        if cone is not None:
            if self._cosines is None or self._cosines.shape[1] <= most:
                self._cosines = np.ones((count, most + 1))
                self._bend(np.arange(count), self._cosines)
            kernels.curved(self._cosines, math.cos(cone), most, levels)
        self._curvature = key, levels
        return levels

    def look(self, camera: Camera, rules: Depths, placements: Placements, /) -> "Look":
        """Of one view, for each placement."""
        net, points = self._cage.net, self._blocks.corner_points[0]
        if self._balls is None:
            self._balls = np.empty((len(net.grid), 4))
            self._surround(np.arange(len(net.grid)), self._balls)
        classes = np.empty((len(placements.matrices), len(points)), np.int8)
        sizes = np.empty((len(placements.matrices), len(net.grid)))
        eyes = placements.inverses[:, :3, :3] @ camera.position + placements.inverses[:, :3, 3]
        kernels.classify(net, points, self._blocks.corner_normals, eyes, rules.epsilon, classes)
        view = camera.position, camera.pixels_per_radian()
        kernels.radii(self._balls, placements.matrices, placements.scales, *view, sizes)
        return Look(self, rules, classes, sizes)

    def depths(self, look: "Look", most: int, /) -> Levels:
        """(k m,): by the rules, none deeper than `most`."""
        rules = look.rules
        smallest, largest = rules.size_px or (0.0, math.inf)
        words = np.array([rules.backs and not self._is_open, rules.silhouettes, smallest, largest], float)
        curvature = self.curvature(rules.cone, rules.most)
        out = np.empty(look.sizes.size, np.int8)
        kernels.choose(
            self._cage.net, self._cage.is_shown, curvature, look.classes, look.sizes, words, most, out
        )
        return out


@dataclass(frozen=True, slots=True)
class Look:
    """What a view says of vertices and patches: `classes` (k, n), `sizes` (k, m) in pixels."""

    views: Views
    rules: Depths
    classes: NDArray[np.int8]
    sizes: Floats

    def depths(self) -> Levels:
        """(k m,): by the rules."""
        return self.views.depths(self, self.rules.most)

    def within(self, budget: int, /) -> tuple[Levels, bool]:
        """(k m,): as deep as the rules and a budget of triangles allow; and whether some are coarser for it.

        First the maximum depth is lowered until the budget holds, then patches rise to the next, those
        that look largest first, as many as may: a function of the view alone. More triangles than the
        budget only where nothing is subdivided.
        """
        net, upper = self.views.net, self.depths()
        if int(show.count_triangles(net, upper)) <= budget:
            return upper, False
        for most in range(self.rules.most - 1, -1, -1):
            lower = self.views.depths(self, most)
            total = int(show.count_triangles(net, lower))
            if total <= budget:
                rising = np.flatnonzero(upper > lower)
                looks = np.ldexp(self.sizes.reshape(-1)[rising], -lower[rising].astype(np.int32))
                rising = rising[np.argsort(-looks, kind="stable")]
                show.rise(net, lower, rising, upper, budget, total)
                return lower, True
            upper = lower
        return upper, self.rules.most > 0
