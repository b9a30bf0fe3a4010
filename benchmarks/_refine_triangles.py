"""How many triangles each scheme needs for the same view: silhouettes and pixels, five cameras."""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from _refine_levels import Hierarchy, by_view
from _refine_models import EDGE_PX, TURNS, camera, criteria, real
from _refine_redgreen import red_green, wanted_edges
from _shape import Row

from foveal.mesh import TriMesh
from foveal.refine import Rgb, Sqrt3


@dataclass
class Needed:
    """Triangles that meet the criterion, a figure for each camera; none of RGB where it is not there."""

    uniform: list[int] = field(default_factory=list)
    red_green: list[int] = field(default_factory=list)
    sparing: list[int] = field(default_factory=list)
    sqrt3: list[int] = field(default_factory=list)
    rgb: list[int] = field(default_factory=list)


def needed(mesh: TriMesh, *, edge_px: float = EDGE_PX) -> Needed:
    """All schemes for the same cameras and limits."""
    hierarchy, found, wish = Hierarchy(mesh), Needed(), criteria(edge_px)
    for degrees in TURNS:
        view = camera(mesh, degrees)
        is_wanted = by_view(hierarchy, view, wish)
        found.uniform.append(len(mesh.faces) * 4 ** len(wanted_edges(hierarchy, is_wanted)))
        found.red_green.append(red_green(hierarchy, is_wanted).count())
        found.sparing.append(red_green(hierarchy, is_wanted, is_sparing=True).count())
        found.sqrt3.append(Sqrt3(mesh).update(view, criteria=wish).faces)
        found.rgb.append(Rgb(mesh).update(view, criteria=wish).faces)
    return found


def ratios(*, is_quick: bool) -> Iterator[Row]:
    """RGB against red-green and √3: the median of the cameras for each mesh, the worst mesh first."""
    bars = {"rgb_vs_redgreen_triangles": 0.85, "rgb_vs_sqrt3_triangles": None}
    meshes = list(real())[: 1 if is_quick else None]
    if not meshes:
        why = "no shared meshes"
        for key, bar in bars.items():
            yield Row(key, f"{EDGE_PX:g} px", None, "ratio", "lower", bar=bar, why=why)
        return
    counts = {name: needed(mesh) for name, mesh in meshes}
    for key, bar in bars.items():
        made = []
        for name, found in counts.items():
            rival = found.red_green if "redgreen" in key else found.sqrt3
            others = {}
            if "redgreen" in key:
                others = {"to sparing red-green": float(np.median(np.divide(found.rgb, found.sparing)))}
            shares = list(np.divide(found.rgb, rival))
            case = f"{name}, {EDGE_PX:g} px"
            made.append(Row.of(key, case, shares, "ratio", "lower", bar=bar, peers=others))
        yield from sorted(made, key=lambda row: -(row.value or 0))
