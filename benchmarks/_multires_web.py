"""What a visitor and a server feel: ranges a second, first picture, slow lines, a long flight."""

import re
import shutil
import socket
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import psutil
from _shape import Row

FLAGS = [
    "--no-sandbox",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--enable-precise-memory-info",
]

# Notes error and bytes as they change, from before the page's own code runs.
WATCH = """
window.history_ = [];
setInterval(() => {
  if (!window.foveal) return;
  const s = window.foveal.stats();
  if (s.moments.firstPicture === undefined) return;
  window.history_.push([performance.now(), s.errorPx, s.receivedBytes]);
}, 10);
"""

# Turns about the model and dives towards it and back; `turn` is a whole flight, 0 to 1.
FLY = """
async (seconds) => {
  const home = window.foveal.getState().camera;
  const p = home.position, t = home.target;
  const offset = [p[0] - t[0], p[1] - t[1], p[2] - t[2]];
  const times = [];
  const begin = performance.now();
  let last = begin;
  await new Promise((done) => {
    const step = (now) => {
      times.push(now - last);
      last = now;
      const turn = (now - begin) / 20000;
      if (now - begin > seconds * 1000) return done();
      const angle = turn * 2 * Math.PI;
      const near = 0.55 + 0.45 * Math.cos(2 * angle);
      const c = Math.cos(angle) * near, s = Math.sin(angle) * near;
      window.foveal.setCamera({
        ...home,
        position: [t[0] + c * offset[0] + s * offset[2], t[1] + near * offset[1],
                   t[2] - s * offset[0] + c * offset[2]],
      });
      requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  });
  window.foveal.setCamera(home);
  return times.slice(5);
}
"""


def chromium() -> str | None:
    """A Chromium on this machine."""
    names = ("chromium", "chromium-browser", "google-chrome", "chrome")
    return next((path for name in names if (path := shutil.which(name))), None)


@contextmanager
def serving(path: Path) -> Iterator[str]:
    """The address of `foveal view path`, run as its own process."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    command = [sys.executable, "-m", "foveal", "view", str(path), "--no-browser", "--port", str(port)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    try:
        line = process.stdout.readline()
        found = re.search(r"http://[^\s]+", line)
        if found is None:
            raise RuntimeError(f"the server said {line!r}")
        yield found[0]
    finally:
        process.terminate()
        process.wait()
        process.stdout.close()


def ranges(fov: Path, *, is_quick: bool) -> Iterator[Row]:
    """Random 32 KB ranges of the file, by wrk, one thread with 16 connections."""
    key, case, bar = "range_requests_per_s", "32 KB, 16 connections", 10_000
    if shutil.which("wrk") is None:
        yield Row(key, case, None, "1/s", "higher", bar, why="wrk is not installed")
        return
    size = fov.stat().st_size
    script = Path(__file__).with_name("_ranges.lua")
    values = []
    with serving(fov) as url:
        for _ in range(1 if is_quick else 5):
            command = [
                "wrk",
                "-t1",
                "-c16",
                "-d3s",
                "-s",
                str(script),
                f"{url}data/{fov.name}",
                "--",
                str(size),
            ]
            output = subprocess.run(command, capture_output=True, text=True, check=True).stdout
            if "Non-2xx" in output:
                raise RuntimeError(output)
            values.append(float(re.search(r"Requests/sec:\s+([\d.]+)", output)[1]))
    yield Row.of(key, case, values, "1/s", "higher", bar=bar, peers={"starlette FileResponse (note)": 1100})


class Visitor:
    """A page in a headless Chromium, perhaps behind a slow line."""

    def __init__(self, browser: Any, url: str, mbit: float | None = None) -> None:
        self.context = browser.new_context(viewport={"width": 1280, "height": 720}, bypass_csp=True)
        self.page = self.context.new_page()
        self.page.add_init_script(WATCH)
        self.session = self.context.new_cdp_session(self.page)
        if mbit is not None:
            self.session.send("Network.enable")
            limits = {
                "offline": False,
                "latency": 20,
                "downloadThroughput": mbit * 125_000,
                "uploadThroughput": -1,
            }
            self.session.send("Network.emulateNetworkConditions", limits)
        self.page.goto(url)
        self.page.wait_for_function("window.foveal !== undefined", timeout=60_000)
        self.page.evaluate("window.foveal.ready")

    def close(self) -> None:
        """Leave nothing running."""
        self.context.close()

    def heap_bytes(self) -> int:
        """JavaScript's heap and the array buffers, after a collection."""
        self.session.send("HeapProfiler.collectGarbage")
        used = self.session.send("Runtime.getHeapUsage")
        return int(used["usedSize"] + used.get("backingStorageSize", 0))


def _sharpening(browser: Any, url: str, mbit: float, runs: int) -> Iterator[Row]:
    seconds: dict[float, list[float]] = {4.0: [], 2.0: [], 1.0: []}
    share: dict[float, list[float]] = {4.0: [], 2.0: [], 1.0: []}
    for _ in range(runs):
        visitor = Visitor(browser, url, mbit)
        visitor.page.evaluate(
            "window.foveal.setBudgets({triangles: 4e6, bytes: 1e9}); window.foveal.setErrorPx(1)"
        )
        visitor.page.evaluate("window.foveal.idle()")
        history = visitor.page.evaluate("window.history_")
        total = visitor.page.evaluate("window.foveal.stats().allBytes")
        for level in seconds:
            first = next((row for row in history if row[1] is not None and row[1] <= level), None)
            if first is not None:
                seconds[level].append(first[0] / 1000)
                share[level].append(first[2] / total)
        visitor.close()
    for level in seconds:
        bar = 2.0 if (level, mbit) == (4.0, 5) else None
        key = f"t_{level:g}px_{mbit:g}mbit_s"
        if seconds[level]:
            yield Row.of(key, "dragon, home view, 720p", seconds[level], "s", "lower", bar=bar)
        else:
            yield Row(
                key, "dragon, home view, 720p", None, "s", "lower", bar, why="the error was not reached"
            )
    for level in seconds:
        if share[level] and mbit == 5:
            yield Row.of(
                f"bytes_{level:g}px_share", "dragon, home view, 720p", share[level], "of file", "lower"
            )


def _frames(browser: Any, url: str) -> Iterator[Row]:
    visitor = Visitor(browser, url, 50)
    times = visitor.page.evaluate(FLY, 20)
    visitor.close()
    middle = statistics.median(times)
    case = f"flight, {len(times)} frames"
    slow = sorted(times)[int(0.95 * len(times))]
    yield Row("frame_p95_ms", case, slow, "ms", "lower", peers={"median": middle}, runs=len(times))
    yield Row(
        "hitch_ms", case, max(times), "ms", "lower", 3 * middle, peers={"median": middle}, runs=len(times)
    )


def _long_flight(browser: Any, url: str, seconds: float) -> Iterator[Row]:
    visitor = Visitor(browser, url)
    process = psutil.Process()

    def resident() -> int:
        # The pages' and the GPU's processes are children of children of this one.
        names = [child for child in process.children(recursive=True) if "chrom" in child.name()]
        return sum(child.memory_info().rss for child in names)

    first = min(60.0, seconds / 2)
    visitor.page.evaluate(FLY, first)
    before = visitor.heap_bytes(), resident()
    visitor.page.evaluate(FLY, seconds - first)
    after = visitor.heap_bytes(), resident()
    visitor.close()
    rows = [
        Row(
            "flight_growth",
            f"{name}, {seconds:.0f} s",
            100 * (b / a - 1),
            "%",
            "lower",
            5,
            peers={"MB": b / 1e6},
        )
        for name, a, b in zip(("script and buffers", "all of Chromium"), before, after, strict=True)
    ]
    yield from sorted(rows, key=lambda row: -(row.value or 0))


def in_browser(fov: Path, *, is_quick: bool, is_full: bool) -> Iterator[Row]:
    """First picture, sharpening over slow lines, frames, a long flight."""
    program = chromium()
    if program is None:
        yield Row("first_picture_s", "dragon", None, "s", "lower", 1.5, why="no Chromium was found")
        return
    from playwright.sync_api import sync_playwright

    runs = 1 if is_quick else 5
    with serving(fov) as url, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=FLAGS)
        first = []
        for _ in range(runs):
            visitor = Visitor(browser, url)
            first.append(visitor.page.evaluate("window.foveal.stats().moments.firstPicture") / 1000)
            visitor.close()
            time.sleep(0.5)
        yield Row.of("first_picture_s", "dragon, loopback, headless", first, "s", "lower", bar=1.5)
        yield from _sharpening(browser, url, 5, runs=1 if is_quick else 3)
        if not is_quick:
            yield from _sharpening(browser, url, 50, runs=3)
            yield from _frames(browser, url)
            yield from _long_flight(browser, url, 600 if is_full else 120)
        browser.close()
