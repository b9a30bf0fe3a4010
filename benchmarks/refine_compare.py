"""The tables and plots of docs/refinement.md: python benchmarks/refine_compare.py [docs]

Takes minutes; writes what is between the page's markers anew. Needs matplotlib and the shared meshes.
"""

import re
import sys
from pathlib import Path

import matplotlib
import numpy as np
from _refine_models import EDGE_PX, real
from _refine_schemes import Made, around_a_point, compared, growth
from _shape import ROOT

matplotlib.use("svg")
from matplotlib import pyplot as plot

SCHEMES = ("uniform Loop", "red-green", "red-green, sparing", "RGB", "√3")
COLOURS = dict(zip(SCHEMES, ("#8c8c8c", "#c0504d", "#e2a19f", "#4477aa", "#44aa77"), strict=True))
COLOURS |= {"uniform √3": "#b7b76d", "√3 by view": "#44aa77", "RGB by view": "#4477aa"}
ITERATIONS = 6

Results = dict[str, list[Made]]


def median(found: list[Made], scheme: str, what: str) -> float | None:
    """Over the cameras; None where the scheme is not there."""
    values = [getattr(made, what) for made in found if made.scheme == scheme]
    return float(np.median(values)) if values else None


def table(results: Results, what: str, form: str) -> str:
    """A row a mesh, a column a scheme."""
    present = [s for s in SCHEMES if any(median(found, s, what) is not None for found in results.values())]
    lines = ["| | " + " | ".join(present) + " |", "| --- |" + " ---: |" * len(present)]
    for name, found in results.items():
        cells = [format(median(found, scheme, what) or 0, form) for scheme in present]
        lines.append(f"| {name} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def ratios(results: Results) -> str:
    """Triangles of RGB, or of √3 where it is not there, against the others: medians over cameras."""
    lead = "RGB" if any(made.scheme == "RGB" for made in next(iter(results.values()))) else "√3"
    rivals = [scheme for scheme in SCHEMES if scheme != lead and (lead == "RGB" or scheme != "RGB")]
    lines = [f"| {lead} against | " + " | ".join(rivals) + " |", "| --- |" + " ---: |" * len(rivals)]
    for name, found in results.items():
        own = [made.triangles for made in found if made.scheme == lead]
        cells = []
        for rival in rivals:
            theirs = [made.triangles for made in found if made.scheme == rival]
            cells.append(f"{np.median(np.divide(own, theirs)):.2g}")
        lines.append(f"| {name} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def points_table(points: dict[str, dict[str, int]]) -> str:
    """Triangles added around a point."""
    schemes = list(next(iter(points.values())))
    lines = ["| | " + " | ".join(schemes) + " |", "| --- |" + " ---: |" * len(schemes)]
    lines += [
        f"| {name} | " + " | ".join(str(made[s]) for s in schemes) + " |" for name, made in points.items()
    ]
    return "\n".join(lines)


def plot_triangles(results: Results, path: Path) -> None:
    """Bars of triangles, a group a mesh; a black line from the least to the most of the cameras."""
    figure, axes = plot.subplots(figsize=(8, 3.4), layout="constrained")
    present = [s for s in SCHEMES if any(made.scheme == s for made in next(iter(results.values())))]
    width = 0.8 / len(present)
    for i, scheme in enumerate(present):
        counts = [[made.triangles for made in found if made.scheme == scheme] for found in results.values()]
        places = np.arange(len(counts)) + (i - (len(present) - 1) / 2) * width
        axes.bar(places, [np.median(c) for c in counts], 0.92 * width, color=COLOURS[scheme], label=scheme)
        axes.vlines(places, [min(c) for c in counts], [max(c) for c in counts], color="black", linewidth=1)
    axes.set_xticks(range(len(results)), list(results))
    axes.set_yscale("log")
    axes.set_ylabel("triangles")
    figure.legend(fontsize=8, ncols=len(present), loc="outside upper center")
    save(figure, path)


def plot_growth(curves: dict[str, dict[str, list[int]]], path: Path) -> None:
    """A panel a mesh."""
    figure, panels = plot.subplots(1, len(curves), figsize=(10, 3.2), sharey=True, layout="constrained")
    for axes, (name, made) in zip(np.atleast_1d(panels), curves.items(), strict=True):
        for scheme, counts in made.items():
            axes.plot(
                range(len(counts)), counts, marker="o", markersize=3, color=COLOURS[scheme], label=scheme
            )
        axes.set_yscale("log")
        axes.set_title(name, fontsize=10)
        axes.set_xlabel("iterations")
    np.atleast_1d(panels)[0].set_ylabel("triangles")
    np.atleast_1d(panels)[0].legend(fontsize=8)
    save(figure, path)


def save(figure: object, path: Path) -> None:
    """As SVG, the same bytes for the same figures."""
    with matplotlib.rc_context({"svg.hashsalt": path.stem, "svg.fonttype": "none"}):
        figure.savefig(path, metadata={"Date": None}, facecolor="white")
    plot.close(figure)


def fill(page: str, name: str, text: str) -> str:
    """The page with `text` between the markers of `name`."""
    pattern = rf"(<!-- {name} -->\n).*?(<!-- end -->)"
    filled, count = re.subn(pattern, lambda m: f"{m[1]}{text}\n{m[2]}", page, flags=re.S)
    if count != 1:
        raise SystemExit(f"the page has {count} places for {name}")
    return filled


def main(folder: Path) -> None:
    """Measure, then write everything."""
    results: Results = {}
    curves: dict[str, dict[str, list[int]]] = {}
    points: dict[str, dict[str, int]] = {}
    for name, mesh in real():
        print(f"{name}: {len(mesh.faces):,} triangles", file=sys.stderr)
        case = f"{name}, {len(mesh.faces):,}"
        results[case] = compared(mesh, edge_px=EDGE_PX)
        curves[name], points[case] = growth(mesh, ITERATIONS), around_a_point(mesh)
    if not results:
        raise SystemExit("The meshes of this comparison are development data that is not here.")
    page = folder / "refinement.md"
    text = page.read_text(encoding="utf-8")
    text = fill(text, "triangles", table(results, "triangles", ",.0f"))
    text = fill(text, "ratios", ratios(results))
    text = fill(text, "point", points_table(points))
    text = fill(text, "time", table(results, "ms", ",.1f"))
    text = fill(text, "bytes", table(results, "bytes_per_triangle", ",.0f"))
    text = fill(text, "mean", table(results, "mean_px", ".3f"))
    text = fill(text, "most", table(results, "most_px", ".2f"))
    text = fill(text, "long", table(results, "long_permille", ".2f"))
    page.write_text(text, encoding="utf-8")
    plot_triangles(results, folder / "refinement_triangles.svg")
    plot_growth(curves, folder / "refinement_growth.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs")
