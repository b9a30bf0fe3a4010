"""The one shape of all benchmarks: rows with a key, a value, a bar and peers; a table and a JSON file."""

import argparse
import json
import os
import platform
import statistics
import sys
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass, field
from datetime import date
from pathlib import Path
from typing import Literal

ROOT = Path(__file__).resolve().parents[1]
SHARED_DATA = ROOT.parent / "shared" / "data"
"""Real meshes for development, where they are; never part of the project."""


@dataclass
class Row:
    """One figure. `value` is None where it cannot be had here; then `why` says so."""

    key: str
    case: str
    value: float | None
    unit: str
    better: Literal["lower", "higher"]
    bar: float | None = None
    peers: dict[str, float] = field(default_factory=dict)
    spread: list[float] = field(default_factory=list)
    runs: int = 1
    why: str = ""

    @classmethod
    def of(
        cls, key: str, case: str, values: Sequence[float], unit: str, better: str, **more: object
    ) -> "Row":
        """A row of the median of `values`, with their smallest and largest as its spread."""
        return cls(
            key,
            case,
            statistics.median(values),
            unit,
            better,  # type: ignore[arg-type]
            spread=[min(values), max(values)],
            runs=len(values),
            **more,  # type: ignore[arg-type]
        )

    def is_reached(self) -> bool | None:
        """Whether the bar is met; None where there is no bar or no figure."""
        if self.bar is None or self.value is None:
            return None
        return self.value <= self.bar if self.better == "lower" else self.value >= self.bar


def seconds(function: Callable[[], object]) -> float:
    """Wall time of one call."""
    begin = time.perf_counter()
    function()
    return time.perf_counter() - begin


def in_turns(functions: dict[str, Callable[[], object]], runs: int) -> dict[str, list[float]]:
    """Seconds of each function, called in turns so that a busy machine is busy for all of them."""
    times: dict[str, list[float]] = {name: [] for name in functions}
    for function in functions.values():
        function()  # a warm-up for each
    for _ in range(runs):
        for name, function in functions.items():
            times[name].append(seconds(function))
    return times


def machine() -> dict[str, object]:
    """What the figures were taken on."""
    name = platform.processor() or platform.machine()
    cpuinfo = Path("/proc/cpuinfo")
    if cpuinfo.is_file():
        names = [
            line.split(":", 1)[1].strip() for line in cpuinfo.read_text().splitlines() if "model name" in line
        ]
        name = names[0] if names else name
    return {
        "processor": name,
        "cores": os.cpu_count(),
        "system": platform.system(),
        "python": platform.python_version(),
    }


def arguments(room: str) -> argparse.Namespace:
    """What every benchmark understands."""
    parser = argparse.ArgumentParser(prog=f"./do bench {room}")
    parser.add_argument("--json", metavar="FILE", help="also write the rows there")
    parser.add_argument("--quick", action="store_true", help="under a minute, and rough")
    parser.add_argument("--full", action="store_true", help="also what takes longer than fifteen minutes")
    parser.add_argument("--only", metavar="KEYS", help="comma-separated keys, or beginnings of keys")
    return parser.parse_args()


def report(room: str, rows: Iterable[Row], options: argparse.Namespace) -> None:
    """Print each row as it comes, then write the JSON file if one was asked for."""
    if options.quick:
        print("A quick run: figures are rough.")
    print(f"{'key':<32}{'case':<26}{'value':>12} {'unit':<12}{'bar':>9}  {'':<3} peers", flush=True)
    kept = []
    for row in rows:
        kept.append(row)
        print(_line(row), flush=True)
    reached = sum(row.is_reached() is True for row in kept)
    missed = [row.key for row in kept if row.is_reached() is False]
    print(f"{reached} bars reached, {len(missed)} missed: {', '.join(missed) or '-'}")
    if options.json:
        content = {
            "room": room,
            "machine": machine(),
            "date": date.today().isoformat(),
            "rows": [asdict(row) for row in kept],
        }
        Path(options.json).write_text(json.dumps(content, indent=1) + "\n")
        print(f"written: {options.json}", file=sys.stderr)


def _line(row: Row) -> str:
    value = "-" if row.value is None else f"{row.value:.4g}"
    bar = "" if row.bar is None else f"{'≤' if row.better == 'lower' else '≥'} {row.bar:g}"
    sign = {True: "ok", False: "NO", None: ""}[row.is_reached()]
    peers = ", ".join(f"{name} {figure:.4g}" for name, figure in row.peers.items())
    return f"{row.key:<32}{row.case:<26}{value:>12} {row.unit:<12}{bar:>9}  {sign:<3} {peers or row.why}"
