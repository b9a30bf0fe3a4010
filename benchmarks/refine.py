"""./do bench refine: √3, RGB and uniform subdivision, with OpenSubdiv, OpenMesh, libigl, trimesh beside."""

import argparse
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import _refine_triangles as triangles
import _refine_uniform as uniform
import _refine_views as views
from _shape import Row, arguments, report


def parts(
    options: argparse.Namespace, folder: Path
) -> Iterator[tuple[tuple[str, ...], Callable[[], Iterator[Row]]]]:
    """The benchmark's parts: the keys each gives, and how to run it."""
    is_quick = options.quick
    keys = ("sqrt3_fresh_43k_ms", "sqrt3_orbit_1deg_ms", "sqrt3_orbit_vs_fresh")
    yield (*keys, "sqrt3_bytes_per_triangle"), lambda: views.sqrt3(folder, is_quick=is_quick)
    yield ("silhouette_share",), lambda: views.silhouette(is_quick=is_quick)
    yield ("sqrt3_page_ms",), lambda: views.page(is_quick=is_quick)
    yield ("rgb_ops_per_s",), lambda: views.rgb_operations(is_quick=is_quick)
    yield ("rgb_fresh_100k_ms", "rgb_orbit_1deg_ms"), lambda: views.rgb(is_quick=is_quick)
    keys = ("rgb_vs_redgreen_triangles", "rgb_vs_sqrt3_triangles")
    yield keys, lambda: triangles.ratios(is_quick=is_quick)
    yield ("loop_uniform_mtris",), lambda: uniform.loops(folder, is_quick=is_quick)


def rows(options: argparse.Namespace, folder: Path) -> Iterator[Row]:
    """Those rows that were asked for, as they come."""
    wanted = options.only.split(",") if options.only else None
    for keys, run in parts(options, folder):
        if wanted is None or any(k.startswith(w) or w.startswith(k) for k in keys for w in wanted):
            yield from run()


if __name__ == "__main__":
    chosen = arguments("refine")
    with tempfile.TemporaryDirectory(prefix="foveal-bench-") as place:
        report("refine", rows(chosen, Path(place)), chosen)
