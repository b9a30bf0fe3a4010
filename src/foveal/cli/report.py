"""What the person sees while it works: bars on a terminal, lines elsewhere; all on stderr."""

import sys
import time
from types import TracebackType
from typing import TYPE_CHECKING, Self

from foveal.base.progress import SILENT, Progress, Stage

from .interrupts import heed
from .result import plain

if TYPE_CHECKING:
    from rich.progress import Progress as RichProgress
    from rich.progress import TaskID

__all__ = ["Reporter", "reporter"]

_LINE_EVERY_S = 5.0
_FIRST_SHARE = 0.05  # below, an estimate would mostly be of how long kernels take to compile


class Reporter:
    """A `Progress` that lives as long as a command: `with reporter(...) as progress`."""

    def __init__(self, *, is_verbose: bool) -> None:
        self.is_verbose = is_verbose

    def stage(self, what: str, total: float | None) -> Stage:
        heed()
        return self._stage(what, total)

    def _stage(self, what: str, total: float | None) -> Stage:
        raise NotImplementedError

    def note(self, sentence: str) -> None:
        print(plain(sentence), file=sys.stderr, flush=True)

    def close(self) -> None:
        """Leave the terminal as it was."""

    def __enter__(self) -> Progress:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
        if kind is None:
            heed()


class _Quiet(Reporter):
    def _stage(self, what: str, total: float | None) -> Stage:
        return SILENT.stage(what, total)

    def note(self, sentence: str) -> None:
        pass


class _Lines(Reporter):
    """A line at the start of each stage and every five seconds: for logs."""

    def _stage(self, what: str, total: float | None) -> Stage:
        return _LineStage(self, what, total)


class _LineStage:
    def __init__(self, owner: Reporter, what: str, total: float | None) -> None:
        self._owner, self._what, self._total = owner, what, total
        self._done = 0.0
        self._begin = self._last = time.monotonic()

    def advance(self, amount: float = 1.0) -> None:
        self._done += amount
        now = time.monotonic()
        if now - self._last >= _LINE_EVERY_S:
            self._last = now
            self._owner.note(f"{self._what}: {self._state(now - self._begin)}")

    def _state(self, spent: float) -> str:
        if not self._total or not self._done:
            return f"{spent:.0f} s so far"
        share = min(1.0, self._done / self._total)
        if share < _FIRST_SHARE:
            return f"{100 * share:.0f} %"
        return f"{100 * share:.0f} %, about {spent * (1 - share) / share:.0f} s left"

    def __enter__(self) -> Self:
        self._owner.note(f"{self._what} ...")
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if kind is None and self._owner.is_verbose:
            self._owner.note(f"{self._what}: {time.monotonic() - self._begin:.1f} s")


class _Bars(Reporter):
    """Bars with the time left. Rich is imported when the first stage begins: it costs 50 ms."""

    def __init__(self, *, is_verbose: bool) -> None:
        super().__init__(is_verbose=is_verbose)
        self._rich: RichProgress | None = None

    def _live(self) -> "RichProgress":
        if self._rich is None:
            from rich.console import Console
            from rich.progress import BarColumn, TaskProgressColumn, TextColumn, TimeRemainingColumn
            from rich.progress import Progress as RichProgress

            self._rich = RichProgress(
                TextColumn("{task.description}", markup=False),
                BarColumn(),
                TaskProgressColumn(),
                TimeRemainingColumn(elapsed_when_finished=True),
                console=Console(stderr=True),
                transient=not self.is_verbose,
            )
            self._rich.start()
        return self._rich

    def _stage(self, what: str, total: float | None) -> Stage:
        live = self._live()
        return _BarStage(live, live.add_task(what, total=total), total)

    def note(self, sentence: str) -> None:
        if self._rich is None:
            super().note(sentence)
        else:
            self._rich.console.print(plain(sentence), markup=False, highlight=False)

    def close(self) -> None:
        if self._rich is not None:
            self._rich.stop()
            self._rich = None


class _BarStage:
    def __init__(self, live: "RichProgress", task: "TaskID", total: float | None) -> None:
        self._live, self._task, self._total = live, task, total

    def advance(self, amount: float = 1.0) -> None:
        self._live.advance(self._task, amount)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if kind is None:
            total = self._total or 1.0
            self._live.update(self._task, total=total, completed=total)


def reporter(*, is_quiet: bool, is_verbose: bool) -> Reporter:
    """Bars where stderr is a terminal, lines where it is not, nothing where that was asked for."""
    if is_quiet:
        return _Quiet(is_verbose=False)
    return (_Bars if sys.stderr.isatty() else _Lines)(is_verbose=is_verbose)
