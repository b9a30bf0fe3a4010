"""foveal gives a 3D surface detail where one looks.

    import foveal

    foveal.build("statue.ply", "statue.fov")        # all resolutions in one compressed file
    light = foveal.export("statue.fov", error=0.1)  # a TriMesh within 0.1 of the original
    foveal.view("statue.fov")                       # in a notebook: the viewer, inline

Each verb of the command line is a function here, over paths and arrays; the rooms (`foveal.multires`,
`foveal.mesh`, ...) hold what they are made of.
"""

from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any

from foveal import view as _cameras
from foveal.base.version import __version__

if TYPE_CHECKING:
    from foveal.base.errors import FovealError
    from foveal.mesh.trimesh import TriMesh
    from foveal.multires import open
    from foveal.scene.build import build
    from foveal.scene.check import check
    from foveal.scene.export import export
    from foveal.scene.info import info
    from foveal.scene.publish import publish
    from foveal.scene.read import read
    from foveal.scene.render import render
    from foveal.scene.shadow import shadow
    from foveal.server.view import view
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
    "shadow",
    "view",
]

# Where each name lives. A verb is one file of the room that can do it, and a line here.
_HOMES = {
    "Camera": "foveal.view.camera",
    "FovealError": "foveal.base.errors",
    "TriMesh": "foveal.mesh.trimesh",
    "build": "foveal.scene.build",
    "check": "foveal.scene.check",
    "export": "foveal.scene.export",
    "info": "foveal.scene.info",
    "open": "foveal.multires",
    "publish": "foveal.scene.publish",
    "read": "foveal.scene.read",
    "render": "foveal.scene.render",
    "shadow": "foveal.scene.shadow",
}
_ROOMS = [
    *("base", "coding", "container", "lod", "mesh", "multires"),
    *("raster", "refine", "scene", "server", "shadows"),
]


def __getattr__(name: str) -> Any:
    """Names are imported when first used (PEP 562): `import foveal` costs next to nothing."""
    if name in _HOMES:
        value = getattr(import_module(_HOMES[name]), name)
        globals()[name] = value
        return value
    if name in _ROOMS:
        return import_module(f"foveal.{name}")
    raise AttributeError(f"module 'foveal' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*__all__, *_ROOMS])


class _CallableRoom(ModuleType):
    """`foveal.view` is the room of cameras and, called, the verb: importing one must not hide the other."""

    def __call__(self, source: Any, /, **options: Any) -> Any:
        from foveal.server.view import view

        return view(source, **options)


_cameras.__class__ = _CallableRoom
