"""Options that go together, and what becomes of them: each group is defined once."""

import functools
import inspect
import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from foveal.base.errors import FovealError

from .options import (
    BackIterations,
    Bend,
    Bits,
    Budget,
    Dask,
    Debug,
    EdgePx,
    Iterations,
    Json,
    Memory,
    Normals,
    PairTriangles,
    PlacementsFile,
    Positions,
    Prim,
    Quiet,
    RadiusPx,
    Scheme,
    SchemeKind,
    SharpEdges,
    SilhouetteBend,
    SilhouetteEdgePx,
    SilhouetteIterations,
    Step,
    Up,
    Verbose,
    Without,
    Workers,
)
from .report import Reporter, reporter
from .result import print_json, print_lines

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from foveal.base.tasks import Executor
    from foveal.scene.build import BuildOptions
    from foveal.scene.refinement import RefineOptions

__all__ = ["Telling", "building", "refining", "takes", "telling"]


def takes(*groups: Callable[..., Any]) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Give a command the options of groups, and to the command what the groups make of them.

    A group is a function whose parameters are options. The command has one parameter of the group's name,
    in place of which Typer sees the group's own.
    """

    def decorate(command: Callable[..., None]) -> Callable[..., None]:
        options = {group: inspect.signature(group).parameters for group in groups}
        own = [
            parameter
            for parameter in inspect.signature(command).parameters.values()
            if parameter.name not in {group.__name__ for group in groups}
        ]
        every = [*own, *(parameter for found in options.values() for parameter in found.values())]

        @functools.wraps(command)
        def run(**given: Any) -> None:
            for group, names in options.items():
                given[group.__name__] = group(**{name: given.pop(name) for name in names})
            command(**given)

        run.__signature__ = inspect.Signature(  # type: ignore[attr-defined]
            [parameter.replace(kind=parameter.KEYWORD_ONLY) for parameter in every]
        )
        run.__annotations__ = {parameter.name: parameter.annotation for parameter in every}
        return run

    return decorate


@dataclass(frozen=True, slots=True)
class Telling:
    """How a command speaks: what it is doing on stderr, its result on stdout.

    Attributes
    ----------
    is_json : bool
        The result is for programs.
    is_quiet, is_verbose : bool
        No progress, no notes and no result in words; or each stage's time as well.
    """

    is_json: bool
    is_quiet: bool
    is_verbose: bool

    def progress(self) -> Reporter:
        """Who tells of the work: `with telling.progress() as progress`."""
        return reporter(is_quiet=self.is_quiet, is_verbose=self.is_verbose)

    def result(self, facts: dict[str, Any], /, *lines: str, brief: str | None = None) -> None:
        """All facts as JSON where that was asked for, else lines in words, or `brief` where quiet."""
        if self.is_json:
            print_json(facts)
        elif not self.is_quiet:
            print_lines(lines)
        elif brief is not None:
            print_lines([brief])


def telling(
    json: Json = False, quiet: Quiet = False, verbose: Verbose = False, debug: Debug = False
) -> Telling:
    """How much the person is told, and in which form. `--debug` is read where errors are caught."""
    return Telling(is_json=json, is_quiet=quiet, is_verbose=verbose)


@contextmanager
def building(
    bits: Bits = None,
    step: Step = None,
    normals: Normals = None,
    up: Up = None,
    memory: Memory = None,
    workers: Workers = None,
    dask: Dask = None,
) -> Iterator["BuildOptions"]:
    """The options of `foveal.build`; the connection to a cluster lasts as long as the block."""
    if bits is not None and step is not None:
        raise typer.BadParameter("it says in another way what --bits says. Give one.", param_hint="--step")
    if step is not None and not 0 < step < float("inf"):
        raise typer.BadParameter(f"a length above 0 is needed, got {step}.", param_hint="--step")
    with _cluster(dask) as executor:
        yield {
            "bits": bits,
            "step": step,
            "normals": normals and normals.value,
            "up": up and up.value,
            "memory_bytes": memory,
            "workers": workers,
            "executor": executor,
        }


def refining(
    scheme: Scheme = None,
    iterations: Iterations = None,
    edge_px: EdgePx = None,
    bend: Bend = None,
    silhouette_iterations: SilhouetteIterations = None,
    silhouette_edge_px: SilhouetteEdgePx = None,
    silhouette_bend: SilhouetteBend = None,
    back_iterations: BackIterations = None,
    positions: Positions = None,
    budget: Budget = None,
    sharp_edges: SharpEdges = None,
    radius_px: RadiusPx = None,
    without: Without = None,
    pair_triangles: PairTriangles = False,
    prim: Prim = None,
    placements: PlacementsFile = None,
) -> "RefineOptions":
    """How a control mesh is refined; what is not chosen is as the file says, or as in `Criteria`."""
    _refuse_iterations(scheme, iterations)
    silhouette = (silhouette_iterations, silhouette_edge_px, _radians(silhouette_bend))
    front = (iterations, edge_px, _radians(bend))
    regions = {"front": front, "silhouette": silhouette, "back": (back_iterations,)}
    names = ("iterations", "edge_px", "bend")
    criteria = {
        region: {name: value for name, value in zip(names, values, strict=False) if value is not None}
        for region, values in regions.items()
    }
    return {
        "scheme": scheme and scheme.value,
        "criteria": {name: region for name, region in criteria.items() if region} or None,
        "depths": _depths(radius_px, [rule.value for rule in without or ()]),
        "positions": positions and positions.value,
        "budget": budget,
        "sharp_edges": _radians(sharp_edges),
        "pair_triangles": pair_triangles or None,
        "prim": prim,
        "placements": None if placements is None else _read_placements(placements),
    }


def _refuse_iterations(scheme: SchemeKind | None, iterations: int | None) -> None:
    from foveal.scene.depth_rules import CATMULL_CLARK, MOST_DEPTH

    if scheme is not None and scheme.value == CATMULL_CLARK and (iterations or 0) > MOST_DEPTH:
        raise typer.BadParameter(
            f"{CATMULL_CLARK} knows {MOST_DEPTH} at most, got {iterations}.", param_hint="--iterations"
        )


def _read_placements(path: Path) -> "NDArray[np.float64]":
    from foveal.scene.cage_options import read_placements

    return read_placements(path)


def _depths(radius_px: tuple[float, float] | None, without: list[str]) -> dict[str, Any] | None:
    """What is chosen of the depth rules of patches, or None."""
    from foveal.scene.depth_rules import RULES

    found = {key: value for rule in without for key, value in RULES[rule].items()}
    if radius_px is not None:
        if "size" in without:
            raise typer.BadParameter("it goes by --without size. Leave one out.", param_hint="--radius-px")
        if not 2 * radius_px[0] <= radius_px[1]:
            raise typer.BadParameter(
                f"the second must be at least twice the first, got {radius_px[0]:g} {radius_px[1]:g}.",
                param_hint="--radius-px",
            )
        found["size_px"] = radius_px
    return found or None


def _radians(degrees: float | None) -> float | None:
    return None if degrees is None else math.radians(degrees)


@contextmanager
def _cluster(address: str | None) -> Iterator["Executor | None"]:
    """An executor on a Dask cluster, or None for local threads."""
    if address is None:
        yield None
        return
    try:
        from distributed import Client
    except ImportError as error:
        raise FovealError(
            "--dask: Dask is not installed. Install it with: pip install 'foveal[dask]'."
        ) from error
    try:
        client = Client(address, timeout="10s")
    except (OSError, ValueError, TimeoutError) as error:
        raise FovealError(
            f"--dask {address}: no cluster answers there. Start one, or check the address."
        ) from error
    with client:
        yield client.get_executor()
