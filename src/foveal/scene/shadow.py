"""The shadows of a light on anything that can be shown, precomputed into a `.fov`."""

import dataclasses
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from foveal.base.errors import FovealError
from foveal.base.files import PathLike, refuse_missing, refuse_same, refuse_unwritable
from foveal.base.progress import SILENT, Progress
from foveal.mesh.trimesh import TriMesh

from .cage_file import is_cage, read_cage
from .scene import Layer, Scene, read_scene
from .scene_light import is_shadow
from .source import Checked, Source, checked, triangles_of

if TYPE_CHECKING:
    from foveal.shadows import Light
    from foveal.shadows.shadow_map import ShadowMap

__all__ = ["ShadowReport", "shadow", "up_of_source"]

_MOST_CAST = 4_000_000
"""Triangles of a refined control mesh: finer ones move its shadow by less than a pixel of most maps."""
_MOST_ITERATIONS = 6


@dataclasses.dataclass(frozen=True, eq=False)
class ShadowReport:
    """What `shadow` made.

    Attributes
    ----------
    shadow_map : ShadowMap
        The map itself, to be looked up.
    triangles : int
        How many cast.
    resolution, images, pixels : int
        Pixels a side; images of a stack, else 1; pixels of all maps together.
    bytes, memory_bytes : int
        On disk, and as words for lookups.
    nodes : dict of str to int
        How many leaf, empty and inner nodes there are.
    seconds : dict of str to float
        By phase.
    """

    shadow_map: "ShadowMap" = dataclasses.field(repr=False)
    triangles: int
    resolution: int
    images: int
    pixels: int
    bytes: int
    memory_bytes: int
    nodes: dict[str, int]
    seconds: dict[str, float]

    def to_json(self) -> dict[str, Any]:
        """All but the map, and the light."""
        names = [field.name for field in dataclasses.fields(self) if field.name != "shadow_map"]
        return {"light": self.shadow_map.light.to_json(), **{name: getattr(self, name) for name in names}}


def shadow(
    source: Source | Scene,
    output: PathLike,
    /,
    *,
    light: "Light",
    resolution: int = 4096,
    method: Literal["optimal", "bottom-up", "top-down"] = "optimal",
    exits: Literal["surface", "strict"] = "surface",
    workers: int | None = None,
    progress: Progress = SILENT,
) -> ShadowReport:
    """Precompute the shadows of a light into a `.fov`, of up to a million pixels a side.

    Parameters
    ----------
    source : path, TriMesh, PolyMesh or Scene
        What casts: a mesh, the finest level of a `.fov`, or all visible layers of a scene but those
        that its light names as moving. A control mesh
        casts as it is refined everywhere.
    output : path
        Ends in `.fov`; replaced if it is there, and only when the new one is whole.
    light : Light
        `foveal.shadows.Directional`, `Sun`, `Spot`, `Point`, or for a stack of maps `AreaLight` or `SunPath`.
    resolution : int
        Pixels a side, a power of two up to 1,048,576.
    method : "optimal", "bottom-up" or "top-down"
        How the tree is built; the first is smallest, the others are the paper's.
    exits : "surface" or "strict"
        What may be said of the air below an open surface, such as a leaf, down to the next one: anything,
        which is right for what is in the scene; or the truth, which is right also for what moves about in
        it, and larger.
    workers : int, optional
        Number of threads; by default one a processor.
    progress : Progress
        Told of each stage, and of images that were left out.

    Returns
    -------
    ShadowReport
        What was made; `shadow_map` is the map itself.

    Raises
    ------
    FovealError
        If the source cannot be used, the light does not shine on it, or the output not be written.

    Examples
    --------
    >>> import pathlib, tempfile, foveal
    >>> from foveal.mesh.shapes import icosphere
    >>> from foveal.shadows import Directional
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "sphere_shadow.fov"
    >>> report = foveal.shadow(icosphere(2), path, light=Directional((0, 0, -1)), resolution=256)
    >>> report.pixels, report.shadow_map.lookup([[0, 0, -1.1], [0, 0, 1.1]]).tolist()
    (65536, [False, True])
    """
    from foveal.base.jit import is_cold
    from foveal.base.tasks import threads
    from foveal.shadows.build import build
    from foveal.shadows.counts import counts
    from foveal.shadows.file import write_shadow
    from foveal.shadows.frames import checked_resolution

    output = Path(output)
    if output.suffix.lower() != ".fov":
        raise FovealError(f"{output}: the name must end in .fov.")
    checked_resolution(resolution, images=light.images)
    source = source if isinstance(source, Scene) else checked(source)
    _refuse_own(output, source)
    refuse_unwritable(output)
    if is_cold():
        progress.note("First run: the kernels are compiled, which takes about a minute, once.")
    _tell_night(light, progress)
    seconds: dict[str, float] = {}
    with _timed(seconds, "reading"):
        meshes = _meshes(source, progress)
    with threads(workers) as pool:
        made = build(
            meshes,
            light,
            resolution=resolution,
            method=method,
            exits=exits,
            executor=pool,
            progress=progress,
        )
    seconds.update(made.times)
    with _timed(seconds, "writing"), progress.stage("Writing", None):
        write_shadow(made, output)
    found = counts(made.trees)
    return ShadowReport(
        shadow_map=made,
        triangles=sum(len(mesh.faces) for mesh in meshes),
        resolution=resolution,
        images=light.images,
        pixels=resolution * resolution * len(made.projections),
        bytes=output.stat().st_size,
        memory_bytes=found.memory_bytes,
        nodes=found._asdict(),
        seconds=seconds,
    )


def up_of_source(source: PathLike, /) -> str:
    """The axis that points up: that of a `.fov`, or of a scene's first layer; of any other mesh y.

    Raises
    ------
    FovealError
        If a file that would say it cannot be read.
    """
    from foveal.container import open_container

    path = Path(source)
    if path.suffix.lower() == ".json":
        path = read_scene(path).layers[0].path
    if path.suffix.lower() != ".fov":
        return "y"
    refuse_missing(path)
    with open_container(path) as file:
        up = file.header.get("up", "y")
    return up if up in ("x", "y", "z") else "y"


def _refuse_own(output: Path, source: Checked | Scene) -> None:
    """The output must not take the place of what casts."""
    if isinstance(source, Path):
        refuse_missing(source)
        refuse_same(output, source)
        if source.suffix.lower() != ".json":
            return
        source = read_scene(source)
    for layer in source.layers if isinstance(source, Scene) else ():
        refuse_same(output, layer.path)


def _tell_night(light: "Light", progress: Progress) -> None:
    from foveal.shadows import SunPath

    if isinstance(light, SunPath) and light.left_out:
        first, last = light.times[0], light.times[-1]
        progress.note(
            f"Times at which the sun is below the horizon, left out: {light.left_out:,} of {light.steps:,}. "
            f"The first is {first:%H:%M}, the last {last:%H:%M}."
        )


@contextmanager
def _timed(seconds: dict[str, float], phase: str) -> Iterator[None]:
    begin = time.monotonic()
    yield
    seconds[phase] = time.monotonic() - begin


def _meshes(source: Checked | Scene, progress: Progress) -> list[TriMesh]:
    """All that casts, as triangles."""
    if isinstance(source, Path) and source.suffix.lower() == ".json":
        source = read_scene(source)
    if not isinstance(source, Scene):
        with progress.stage("Reading", 1):
            return [_triangles(source, progress)]
    layers = [layer for layer in source.layers if layer.is_visible and not layer.is_moving]
    if not layers:
        raise FovealError(
            f"the scene {source.title!r} shows no layer that stays, so nothing casts. Make one visible."
        )
    with progress.stage("Reading", len(layers)) as stage:
        meshes = []
        for layer in layers:
            meshes.append(_triangles(layer.path, progress, layer))
            stage.advance()
        return meshes


def _triangles(source: Checked, progress: Progress, layer: Layer | None = None) -> TriMesh:
    if not isinstance(source, Path) or source.suffix.lower() != ".fov":
        return triangles_of(source)
    if is_shadow(source):
        raise FovealError(f"{source}: it holds shadows, and no surface that could cast some. Name the mesh.")
    return _refined(source, progress, layer) if is_cage(source) else triangles_of(source)


def _refined(path: Path, progress: Progress, layer: Layer | None) -> TriMesh:
    """A control mesh as the smooth surface that is shown, about as fine as it may become."""
    from .refine import refine
    from .refine_size import everywhere

    cage = read_cage(path)
    refinement = layer.refinement if layer is not None and layer.refinement else cage.refinement
    triangles = len(cage.mesh.faces) * (1 if cage.placements is None else len(cage.placements))
    sizes = [everywhere(triangles, refinement.scheme, n) for n in range(_MOST_ITERATIONS + 1)]
    iterations = max(n for n, size in enumerate(sizes) if n == 0 or size <= _MOST_CAST)
    progress.note(f"{path.name}: a control mesh casts as it is refined everywhere, {iterations} times.")
    return refine(
        path,
        everywhere=True,
        scheme=refinement.scheme,
        positions=None if refinement.scheme == "catmull-clark" else refinement.positions,
        criteria={"front": {"iterations": iterations}},
        budget=0,
    )
