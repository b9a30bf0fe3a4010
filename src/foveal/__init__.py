"""foveal gives a 3D surface detail where one looks.

    import foveal

    foveal.build("statue.ply", "statue.fov")        # all resolutions in one compressed file
    light = foveal.export("statue.fov", error=0.1)  # a TriMesh within 0.1 of the original
    foveal.view("statue.fov")                       # in a notebook: the viewer, inline

Each verb of the command line is a function here, over paths and arrays; the rooms (`foveal.multires`,
`foveal.mesh`, ...) hold what they are made of.
"""

from types import ModuleType
from typing import TYPE_CHECKING, Any

from foveal import view as _room
from foveal.base.version import __version__

if TYPE_CHECKING:
    from foveal._api import build, check, export, info, open, publish, read, render, view
    from foveal.base.errors import FovealError
    from foveal.mesh.trimesh import TriMesh
    from foveal.view.camera import Camera

__all__ = [
    "Camera",
    "FovealError",
    "TriMesh",
    "__version__",
    "build",
    "check",
    "export",
    "info",
    "open",
    "publish",
    "read",
    "render",
    "view",
]

_ELSEWHERE = {
    "Camera": "foveal.view.camera",
    "FovealError": "foveal.base.errors",
    "TriMesh": "foveal.mesh.trimesh",
}


def __getattr__(name: str) -> Any:
    """Names are imported when first used (PEP 562): `import foveal` costs next to nothing."""
    if name.startswith("__") or name not in __all__:
        raise AttributeError(f"module 'foveal' has no attribute {name!r}")
    from importlib import import_module

    value = getattr(import_module(_ELSEWHERE.get(name, "foveal._api")), name)
    globals()[name] = value
    return value


class _Room(ModuleType):
    """`foveal.view` is the room of cameras and, called, the verb: importing one must not hide the other."""

    def __call__(self, source: Any, /, **options: Any) -> Any:
        from foveal._api import view

        return view(source, **options)


_room.__class__ = _Room


def __dir__() -> list[str]:
    return sorted(__all__)
