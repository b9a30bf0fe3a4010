"""The schemes of refinement by name, behind one interface."""

from typing import Literal, Protocol, get_args

import numpy as np

from foveal.base.errors import FovealError
from foveal.mesh.trimesh import TriMesh
from foveal.view.camera import Camera

from . import _kernels_sqrt3_update as kernels
from ._kernels_sqrt3_layout import BORDER, UNMEASURED
from .criteria import Criteria
from .slots import Placing, Slots
from .sqrt3 import Sqrt3, Update

__all__ = ["SCHEMES", "Refiner", "Scheme", "refiner", "slots_of"]

Scheme = Literal["sqrt3", "loop", "butterfly"]
SCHEMES: tuple[Scheme, ...] = get_args(Scheme)


class Refiner(Protocol):
    """A refinement that follows a camera, of any scheme."""

    def update(self, camera: Camera, /, *, criteria: Criteria | None = None) -> Update:
        """Bring the mesh to what `camera` sees."""
        ...

    def mesh(self) -> TriMesh:
        """The mesh as it is."""
        ...


def refiner(mesh: TriMesh, /, *, scheme: Scheme = "sqrt3", name: str = "mesh") -> Refiner:
    """A refinement of a control mesh by a scheme.

    Parameters
    ----------
    mesh : TriMesh
        An oriented surface, open or closed.
    scheme : "sqrt3", "loop" or "butterfly"
        √3 subdivision, or RGB triangulations over the rules of Loop or of the modified butterfly.
    name : str
        What errors call the mesh.

    Raises
    ------
    FovealError
        If the mesh is no oriented surface, or the scheme is not there.

    Examples
    --------
    >>> from foveal.mesh.shapes import icosphere
    >>> len(refiner(icosphere(0)).mesh().faces)
    20
    """
    if scheme not in SCHEMES:
        raise ValueError(f"scheme must be one of {', '.join(SCHEMES)}, got {scheme!r}")
    if scheme == "sqrt3":
        return Sqrt3(mesh, name=name)
    import foveal.refine as room

    rgb = getattr(room, "Rgb", None)
    if rgb is None:
        raise FovealError(f"{name}: the scheme {scheme!r} is not there yet. Choose sqrt3.")
    made: Refiner = rgb(mesh, scheme=scheme, name=name)
    return made


def slots_of(refined: Refiner, /, *, positions: Placing = "control") -> Slots:
    """The slots of a refinement as it is; views where they can be, so valid until its next update."""
    if hasattr(refined, "slots"):
        slots: Slots = refined.slots(positions=positions)
        return slots
    assert isinstance(refined, Sqrt3)
    net = refined._net
    count, vertices = int(net.counts[0]), int(net.counts[1])
    states = net.states[:count]
    is_used = states >= 0
    faces = np.where(is_used[:, None], net.faces[:count], 0)
    places = net.points[:vertices, 0].copy()
    if positions == "limit":
        kinds, points = net.kinds[:vertices, None], net.points[:vertices]
        ends = np.where(kinds == BORDER, points[:, 0] + points[:, 2] / 6, points[:, 1])
        places = np.where(kinds == UNMEASURED, places, ends)
    else:
        kernels.place(net, np.empty(vertices, np.int8), places)
    return Slots(
        faces,
        places,
        net.points[:vertices, 0],
        np.where(is_used, states >> 1, 0).astype(np.uint8),
        np.zeros(count, np.uint8),
    )
