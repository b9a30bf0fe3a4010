"""How long work reports on itself, without knowing who listens."""

from types import TracebackType
from typing import Protocol, Self

__all__ = ["SILENT", "Progress", "Stage"]


class Stage(Protocol):
    """One bar: advanced while its `with` block runs, complete when the block ends."""

    def advance(self, amount: float = 1.0) -> None:
        """Report that `amount` of the stage's total is done. Called from one thread only."""
        ...

    def __enter__(self) -> Self: ...

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None: ...


class Progress(Protocol):
    """Whoever shows progress: a terminal's bars, a page, a notebook, or nobody."""

    def stage(self, what: str, total: float | None) -> Stage:
        """Begin a stage named `what` of `total` units (None if that cannot be known)."""
        ...

    def note(self, sentence: str) -> None:
        """Tell the person something worth knowing, such as what was repaired."""
        ...


class _SilentStage:
    def advance(self, amount: float = 1.0) -> None:
        pass

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        pass


class _Silent:
    def stage(self, what: str, total: float | None) -> Stage:
        return _SilentStage()

    def note(self, sentence: str) -> None:
        pass


SILENT: Progress = _Silent()
"""Says nothing; the default of every function that takes a `progress`."""
