"""Options that several commands have, each defined once."""

import enum
import re
from pathlib import Path
from typing import Annotated, cast

import typer

__all__ = [
    "BackIterations",
    "Bend",
    "Bits",
    "Budget",
    "Dask",
    "Debug",
    "EdgePx",
    "Force",
    "Iterations",
    "Json",
    "Memory",
    "ModeKind",
    "Normals",
    "NormalsKind",
    "PairTriangles",
    "PlacementsFile",
    "Positions",
    "PositionsKind",
    "Prim",
    "Quiet",
    "RadiusPx",
    "RuleKind",
    "Scheme",
    "SchemeKind",
    "Shadow",
    "SharpEdges",
    "SilhouetteBend",
    "SilhouetteEdgePx",
    "SilhouetteIterations",
    "Source",
    "Step",
    "Up",
    "UpAxis",
    "Verbose",
    "Without",
    "Workers",
    "parse_size",
]

_UNITS = {"": 1, "k": 10**3, "m": 10**6, "g": 10**9, "t": 10**12}
_BINARY = {"": 1, "k": 2**10, "m": 2**20, "g": 2**30, "t": 2**40}


def parse_size(text: str) -> int:
    """Bytes from a number with a unit: 2GB, 500 MB, 1.5GiB, 4096.

    Examples
    --------
    >>> parse_size("2GB"), parse_size("1.5 GiB"), parse_size("4096")
    (2000000000, 1610612736, 4096)
    """
    match = re.fullmatch(r"\s*([0-9]+(?:\.[0-9]+)?)\s*([kmgt]?)(i?)b?\s*", text.lower())
    if match is None:
        raise typer.BadParameter(f"{text!r} is not a size; write for instance 2GB or 500MB.")
    size = float(match[1]) * (_BINARY if match[3] else _UNITS)[match[2]]
    if not 1 <= size < 2**63:
        raise typer.BadParameter(f"{text[:40]!r} is no size of a memory; write for instance 2GB or 500MB.")
    return int(size)


class UpAxis(enum.StrEnum):
    """Which axis of the input points up."""

    x = "x"
    y = "y"
    z = "z"


class NormalsKind(enum.StrEnum):
    """Which normals are stored."""

    auto = "auto"
    none = "none"


class SchemeKind(enum.StrEnum):
    """By which scheme a control mesh is refined."""

    sqrt3 = "sqrt3"
    loop = "loop"
    butterfly = "butterfly"
    catmull_clark = "catmull-clark"


class RuleKind(enum.StrEnum):
    """A rule by which patches get their depth."""

    curvature = "curvature"
    backs = "backs"
    silhouettes = "silhouettes"
    size = "size"


class ModeKind(enum.StrEnum):
    """How √3 refinement goes about it."""

    exact = "exact"
    filter = "filter"


class PositionsKind(enum.StrEnum):
    """Where vertices of a refined mesh are."""

    control = "control"
    limit = "limit"


def _iterations(what: str) -> typer.models.OptionInfo:
    return cast(
        typer.models.OptionInfo,
        typer.Option(min=0, max=30, metavar="N", help=f"Refine {what} at most N times; more is finer."),
    )


def _edge_px(what: str) -> typer.models.OptionInfo:
    what = f"{what}: an edge of so many pixels is short enough; with 0 none is. Larger is coarser."
    return cast(typer.models.OptionInfo, typer.Option(min=0.0, max=1e9, metavar="PX", help=what))


def _bend(what: str) -> typer.models.OptionInfo:
    what = f"{what}: a bend by less than this is flat enough. Larger is coarser."
    return cast(typer.models.OptionInfo, typer.Option(min=0.0, max=180.0, metavar="DEGREES", help=what))


Source = Annotated[
    Path,
    typer.Argument(
        metavar="FILE",
        help="A mesh (PLY, STL, OBJ, OFF, GLB ..., also .gz), a .fov, or a scene.json.",
        readable=False,  # that is asked later, since it is no fault of the command line
    ),
]
Bits = Annotated[
    int | None,
    typer.Option(
        min=4,
        max=24,
        metavar="N",
        help="Grid of 2^N steps over the largest extent. More is closer to the input, and larger.",
    ),
]
Step = Annotated[
    float | None,
    typer.Option(
        metavar="LENGTH",
        help="Grid step in the file's unit, instead of --bits. Smaller is closer, and larger in bytes.",
    ),
]
Normals = Annotated[
    NormalsKind | None,
    typer.Option(
        case_sensitive=False,
        help="auto keeps the file's, or makes them; none is smaller, and shaded flat.",
    ),
]
Up = Annotated[
    UpAxis | None,
    typer.Option(
        case_sensitive=False,
        help="Axis of the input that points up; by default y. Data is never rotated.",
    ),
]
Memory = Annotated[
    int | None,
    typer.Option(
        metavar="SIZE",
        parser=parse_size,
        help="Memory to keep within, e.g. 2GB. Less is slower: the rest waits on disk.",
    ),
]
Workers = Annotated[
    int | None,
    typer.Option(
        min=1,
        max=1024,
        metavar="N",
        help="Threads; by default one a processor. Fewer leave room for others.",
    ),
]
Dask = Annotated[
    str | None,
    typer.Option(
        metavar="ADDRESS",
        help="Build on a Dask cluster, e.g. tcp://host:8786. Pays for very large inputs only.",
    ),
]
Scheme = Annotated[
    SchemeKind | None,
    typer.Option(
        case_sensitive=False,
        help="Take the mesh as a control mesh, to be refined so where it is looked at.",
    ),
]
Iterations = Annotated[int | None, _iterations("front faces")]
EdgePx = Annotated[float | None, _edge_px("Front faces")]
Bend = Annotated[float | None, _bend("Front faces")]
SilhouetteIterations = Annotated[int | None, _iterations("silhouettes")]
SilhouetteEdgePx = Annotated[float | None, _edge_px("Silhouettes")]
SilhouetteBend = Annotated[float | None, _bend("Silhouettes")]
BackIterations = Annotated[int | None, _iterations("back faces")]
Positions = Annotated[
    PositionsKind | None,
    typer.Option(
        case_sensitive=False, help="Vertices where their level has them, or where they go in the limit."
    ),
]
Budget = Annotated[
    int | None,
    typer.Option(
        min=0, max=2**32 - 1, metavar="N", help="Triangles at most, by a coarser threshold; 0 for no limit."
    ),
]
RadiusPx = Annotated[
    tuple[float, float] | None,
    typer.Option(
        min=0.0,
        max=1e9,
        metavar="MIN MAX",
        help="Radii that subdivided patches may have on the picture; larger is coarser. For catmull-clark.",
    ),
]
Without = Annotated[
    list[RuleKind] | None,
    typer.Option(
        case_sensitive=False,
        help="Leave out this rule for the depth of patches; may be repeated. For catmull-clark.",
    ),
]
PairTriangles = Annotated[
    bool,
    typer.Option(
        "--pair-triangles",
        help="Join triangles in pairs to quads first: half the patches. For catmull-clark.",
    ),
]
PlacementsFile = Annotated[
    Path | None,
    typer.Option(
        "--placements",
        metavar="FILE.json",
        help="Where the cage stands: an array of 4 x 4 matrices, row by row. For catmull-clark.",
        readable=False,
    ),
]
Prim = Annotated[
    str | None,
    typer.Option(
        metavar="PATH",
        help="Which mesh of a USD file, such as /town/house; by default the first. For catmull-clark.",
    ),
]
SharpEdges = Annotated[
    float | None,
    typer.Option(
        min=0.0,
        max=180.0,
        metavar="DEGREES",
        help="Keep edges sharp at which the control mesh bends by more than this. For sqrt3.",
    ),
]
Shadow = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE.fov",
        help="Light it by what 'foveal shadow' made, in place of a light that the eye carries.",
        readable=False,
    ),
]
Force = Annotated[bool, typer.Option("--force", help="Replace what is there already.")]
Json = Annotated[bool, typer.Option("--json", help="Print the result as JSON on stdout, for programs.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="No progress and no notes; errors only.")]
Verbose = Annotated[bool, typer.Option("--verbose", "-v", help="Say how long each stage took.")]
Debug = Annotated[bool, typer.Option("--debug", help="On an error, show where in the code it arose.")]
