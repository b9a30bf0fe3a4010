"""The schemes of refinement by name, behind one interface."""

from typing import Literal, Protocol, get_args

import numpy as np
from numpy.typing import ArrayLike

from foveal.base.errors import FovealError
from foveal.mesh.trimesh import TriMesh
from foveal.view.camera import Camera

from .criteria import Criteria
from .rgb import Rgb
from .slots import Placing, Slots
from .sqrt3 import Sqrt3, Update

__all__ = ["SCHEMES", "Refiner", "Scheme", "refiner"]

Scheme = Literal["sqrt3", "loop", "butterfly"]
SCHEMES: tuple[Scheme, ...] = get_args(Scheme)


class Refiner(Protocol):
    """A refinement that follows a camera, of any scheme."""

    def update(
        self, camera: Camera, /, *, criteria: Criteria | None = None, most_splits: int | None = None
    ) -> Update:
        """Bring the mesh to what `camera` sees."""
        ...

    def mesh(self, *, positions: Placing = "control") -> TriMesh:
        """The mesh as it is."""
        ...

    def slots(self, *, positions: Placing = "control") -> Slots:
        """The same slot by slot."""
        ...


def refiner(
    mesh: TriMesh, /, *, scheme: Scheme = "sqrt3", sharp: ArrayLike | None = None, name: str = "mesh"
) -> Refiner:
    """A refinement of a control mesh by a scheme.

    Parameters
    ----------
    mesh : TriMesh
        An oriented surface, open or closed.
    scheme : "sqrt3", "loop" or "butterfly"
        √3 subdivision, or RGB triangulations over the rules of Loop or of the modified butterfly.
    sharp : (k, 2) int, optional
        The vertices of edges that stay sharp, as for `Sqrt3`; for √3 alone.
    name : str
        What errors call the mesh.

    Raises
    ------
    FovealError
        If the mesh is no oriented surface, or has sharp edges that the scheme does not know.
    ValueError
        If there is no such scheme.

    Examples
    --------
    >>> from foveal.mesh.shapes import icosphere
    >>> len(refiner(icosphere(0)).mesh().faces)
    20
    """
    if scheme not in SCHEMES:
        raise ValueError(f"scheme must be one of {', '.join(SCHEMES)}, got {scheme!r}")
    if scheme == "sqrt3":
        return Sqrt3(mesh, sharp=sharp, name=name)
    if sharp is not None and len(np.asarray(sharp)):
        raise FovealError(
            f"{name}: it has sharp edges, which {scheme} does not know. Choose sqrt3, or leave them out."
        )
    return Rgb(mesh, scheme=scheme, name=name)
