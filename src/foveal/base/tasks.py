"""Work spread over an executor, in order, with little in flight."""

import os
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from contextlib import contextmanager
from typing import TypeVar

__all__ = ["Executor", "ordered_map", "thread_count", "threads", "threads_unless"]

A = TypeVar("A")
R = TypeVar("R")


def thread_count(wanted: int | None = None) -> int:
    """`wanted` threads, or as many as there are processors this process may use."""
    if wanted is not None:
        if wanted < 1:
            raise ValueError(f"workers must be at least 1, got {wanted}")
        return wanted
    if hasattr(os, "sched_getaffinity"):
        return max(1, len(os.sched_getaffinity(0)))
    return os.cpu_count() or 1


def threads(workers: int | None = None) -> ThreadPoolExecutor:
    """Local threads, which is what kernels that release the GIL want.

    Anything with the interface of `concurrent.futures.Executor` serves instead, such as
    `distributed.Client(...).get_executor()`.
    """
    return ThreadPoolExecutor(thread_count(workers), thread_name_prefix="foveal")


@contextmanager
def threads_unless(executor: Executor | None, /) -> Iterator[Executor]:
    """The executor that was given, which stays its owner's, or local threads for as long as the block."""
    if executor is not None:
        yield executor
        return
    with threads() as pool:
        yield pool


def ordered_map(
    executor: Executor, function: Callable[[A], R], items: Iterable[A], /, *, ahead: int
) -> Iterator[R]:
    """Yield `function(item)` in the order of `items`, with at most `ahead` of them in flight.

    `Executor.map` takes all items at once; this one takes them as results are used, so that memory
    stays bounded whatever the number of items. When the caller stops early, or a task raises, what has
    not begun is cancelled and what has is waited for: nothing runs on after the iterator is closed.

    Examples
    --------
    >>> with threads(2) as pool:
    ...     list(ordered_map(pool, abs, [-3, 1, -2], ahead=2))
    [3, 1, 2]
    """
    pending: deque[Future[R]] = deque()
    try:
        for item in items:
            pending.append(executor.submit(function, item))
            if len(pending) >= ahead:
                yield pending.popleft().result()
        while pending:
            yield pending.popleft().result()
    finally:
        for future in pending:
            future.cancel()
        for future in pending:
            if not future.cancelled():
                future.exception()
