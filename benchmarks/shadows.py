"""./do bench shadows: precomputed shadow maps, with the authors' greedy rule and rays beside."""

import argparse
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import _shadows_forms as forms
from _shadows_fresh import in_a_process
from _shadows_lookups import lookups
from _shadows_scenes import SCENES, scene
from _shadows_stack import stack
from _shape import Row, arguments, in_turns, report

from foveal.shadows import ShadowMap, build

NO_FILE = "this version writes no files of shadows"
NOT_THERE = "the scene's file is not there"
NOT_QUICK = "not in a quick run"


def shadow_of(name: str, resolution: int) -> ShadowMap:
    """Its map, by the build as everybody calls it."""
    found = scene(name)
    assert found is not None
    return build(*found, resolution=resolution)


def against(key: str, case: str, bytes_: int | None, greedy: int, bar: float | None, **peers: int) -> Row:
    """A row of bytes as shares of the greedy tree's, aligned."""
    if bytes_ is None:
        return Row(key, case, None, "x", "lower", bar, why=NO_FILE)
    others = {name.replace("_", " "): size / greedy for name, size in peers.items()}
    return Row(key, case, bytes_ / greedy, "x", "lower", bar, peers=others)


def plaza_forms(folder: Path, *, is_quick: bool) -> Iterator[Row]:
    """Sizes at 4096² against the greedy tree, and the three constructions from the same pixels."""
    name, side = ("small plaza", 2048) if is_quick else ("plaza", 4096)
    found = scene(name)
    assert found is not None
    intervals = forms.pixels(forms.seen(found, side), side)
    makers = forms.constructions(intervals)
    trees = {method: make() for method, make in makers.items()}
    shadow = shadow_of(name, side)
    case, greedy = f"{name} {side}², solids' exits", forms.aligned_bytes(trees["bottom-up"])
    packed, on_disk = shadow.packed[0].words.nbytes, forms.file_bytes(shadow, folder)
    coders = {} if is_quick else forms.raw_coders(intervals[0])
    yield against("plaza_4096_ram_vs_greedy", case, packed, greedy, 0.97, **coders)
    yield against("plaza_4096_disk_vs_greedy", case, on_disk, greedy, 0.33, **coders)
    for form, size in (("packed", packed), ("file", on_disk), ("greedy, aligned", greedy)):
        value = None if size is None else size / 1e6
        yield Row("size_mb", f"{case}, {form}", value, "MB", "lower", why="" if value else NO_FILE)
    share = forms.nodes(shadow.trees[0]) / forms.nodes(trees["optimal"])
    yield Row("nodes_vs_all_pixels", case, share, "x", "lower", 1.02)
    times = in_turns(makers, 1 if is_quick else 3)
    for method, tree in trees.items():
        size = forms.aligned_bytes(tree)
        yield Row("construction_mb", f"{method}, {side}²", size / 1e6, "MB", "lower")
        yield Row.of("construction_s", f"{method}, {side}²", times[method], "s", "lower")


def samurai_forms(folder: Path) -> Iterator[Row]:
    """Sizes of an open scene, whose greedy tree may not have solids' exits: most of it encloses nothing."""
    keys, side = ("samurai_2048_disk_vs_greedy", "samurai_2048_ram_vs_greedy"), 2048
    found = scene("samurai")
    if found is None:
        yield from (Row(key, "samurai", None, "x", "lower", why=NOT_THERE) for key in keys)
        return
    flat, shadow = forms.seen(found, side), shadow_of("samurai", side)
    trees = {}
    for exits in (True, False):
        intervals = forms.pixels(flat, side, is_next_surface=exits)
        for method in ("bottom-up", "optimal"):
            trees[method, exits] = forms.aligned_bytes(forms.constructions(intervals)[method]())
    greedy, case = trees["bottom-up", True], f"samurai {side}²"
    peers = {
        "optimal,_next_surfaces": trees["optimal", True],
        "greedy,_solids'_exits_where_closed": trees["bottom-up", False],
    }
    packed, on_disk = shadow.packed[0].words.nbytes, forms.file_bytes(shadow, folder)
    yield against(keys[0], case, on_disk, greedy, 0.4)
    yield against(keys[1], case, packed, greedy, None, **peers, **forms.raw_coders(intervals[0]))
    for form, size in (("packed", packed), ("file", on_disk), ("greedy, next surfaces", greedy)):
        value = None if size is None else size / 1e6
        yield Row("size_mb", f"{case}, {form}", value, "MB", "lower", why="" if value else NO_FILE)


def growth(folder: Path, *, is_quick: bool) -> Iterator[Row]:
    """Bytes at twice the side over bytes, in both forms, the worst first."""
    name, sides = ("small plaza", (2048, 4096)) if is_quick else ("plaza", (16384, 32768, 65536))
    found: list[Row] = []
    before: dict[str, int | None] = {}
    for side in sides:
        shadow = shadow_of(name, side)
        sizes = {"packed": shadow.packed[0].words.nbytes, "file": forms.file_bytes(shadow, folder)}
        for form, size in sizes.items():
            case, last = f"{name}, {form}, {side // 2}² to {side}²", before.get(form)
            if size is None:
                yield Row("growth_per_doubling", case, None, "x", "lower", 2.15, why=NO_FILE)
            elif last:
                found.append(Row("growth_per_doubling", case, size / last, "x", "lower", 2.15))
        before = dict(sizes)
    yield from sorted(found, key=lambda row: -(row.value or 0))


def whole(key: str, side: int, bars: tuple[float, float], runs: int) -> Iterator[Row]:
    """Seconds and peak memory of whole builds, each in a process of its own."""
    if runs == 0:
        for unit in ("s", "GB"):
            yield Row(
                f"{key}_{unit.lower().replace('gb', 'peak_gb')}", "plaza", None, unit, "lower", why=NOT_QUICK
            )
        return
    done = [in_a_process("plaza", side) for _ in range(runs)]
    case, phases = f"plaza {side}²", done[-1]["phases"]
    yield Row.of(f"{key}_s", case, [run["seconds"] for run in done], "s", "lower", bar=bars[0], peers=phases)
    yield Row.of(f"{key}_peak_gb", case, [run["peak_gb"] for run in done], "GB", "lower", bar=bars[1])
    yield Row(f"{key}_nodes", case, done[0]["nodes"] / 1e6, "million", "lower")
    yield from _bytes(f"{key}_mb", case, done[0])


def _bytes(key: str, case: str, run: dict[str, float]) -> Iterator[Row]:
    yield Row(key, f"{case}, packed", run["packed_bytes"] / 1e6, "MB", "lower")
    size = run["file_bytes"]
    yield Row(
        key,
        f"{case}, file",
        size and size / 1e6,
        "MB",
        "lower",
        why="" if size else NO_FILE,
        peers={"seconds to write": run["writing_seconds"]} if size else {},
    )


def million_side(*, is_full: bool) -> Iterator[Row]:
    """A million pixels a side, by a process of its own."""
    if not is_full:
        for key, unit in (("million_side_s", "s"), ("million_side_mb", "MB")):
            yield Row(key, "plaza", None, unit, "lower", why="only with --full")
        return
    run, case = in_a_process("plaza", 1 << 20), "plaza 1,048,576²"
    peers = {**run["phases"], "peak GB": run["peak_gb"], "million nodes": run["nodes"] / 1e6}
    yield Row("million_side_s", case, run["seconds"], "s", "lower", peers=peers)
    yield from _bytes("million_side_mb", case, run)


def rays(*, is_quick: bool, is_full: bool) -> Iterator[Row]:
    """Wrong tests at random pixels of each scene, and beside all silhouettes."""
    import _shadows_rays as checker

    key = "million_wrong_tests"
    count, sides = (20_000, (4096,)) if is_quick else (1_000_000, (1 << 18, 1 << 20))
    names = ("small plaza", *SCENES[1:]) if is_quick else SCENES
    for side in sides[: 1 + is_full]:
        for name in names:
            found = scene(name)
            if found is None:
                yield Row(key, name, None, "tests", "lower", why=NOT_THERE)
                continue
            shadow = build(*found, resolution=side)
            parts = [("random", shadow, checker.random_pixels(count, side))]
            if side == sides[0]:
                small = build(*found, resolution=4096)
                parts.append(
                    ("silhouettes", small, checker.silhouettes(*forms.pixels(forms.seen(found, 4096), 4096)))
                )
            for what, shadow, pixels in parts:
                try:
                    done = checker.check(found[0], shadow, pixels)
                except ImportError:
                    yield Row(key, name, None, "tests", "lower", why="embreex is not installed")
                    continue
                peers = {"rays": done.rays, "tests": done.tests, "asked again": done.asked_again}
                peers["on an edge"] = done.no_tests
                case = f"{name} {shadow.resolution}², {what}"
                yield Row(key, case, len(done.wrong), "tests", "lower", 0, peers=peers)


def rows(options: argparse.Namespace, folder: Path) -> Iterator[Row]:
    """Those rows that were asked for, as they come."""
    quick, full = options.quick, options.full
    parts: list[tuple[str, Callable[[], Iterator[Row]]]] = [
        ("plaza_4096 size nodes_vs construction", lambda: plaza_forms(folder, is_quick=quick)),
        ("samurai_2048 size", lambda: samurai_forms(folder)),
        ("growth_per_doubling", lambda: growth(folder, is_quick=quick)),
        ("plaza_65536", lambda: whole("plaza_65536", 1 << 16, (60, 2), 0 if quick else 3)),
        ("plaza_262144", lambda: whole("plaza_262144", 1 << 18, (300, 4), 0 if quick else 1)),
        ("million_side", lambda: million_side(is_full=full)),
        ("stack_vs_separate", lambda: stack(is_quick=quick)),
        ("lookups pcf5_vs_single", lambda: lookups(is_quick=quick)),
        ("million_wrong_tests", lambda: rays(is_quick=quick, is_full=full)),
    ]
    wanted = options.only.split(",") if options.only else None
    for keys, run in parts:
        if wanted is None or any(
            key.startswith(word) or word.startswith(key) for key in keys.split() for word in wanted
        ):
            yield from run()


if __name__ == "__main__":
    chosen = arguments("shadows")
    with tempfile.TemporaryDirectory(prefix="foveal-bench-") as place:
        report("shadows", rows(chosen, Path(place)), chosen)
