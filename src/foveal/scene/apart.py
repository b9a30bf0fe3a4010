"""Long computations in a thread of their own, so that Ctrl-C is heard at once."""

import threading
from collections.abc import Callable
from typing import TypeVar

__all__ = ["NAME", "Stopped", "apart"]

T = TypeVar("T")

NAME = "foveal-apart"
"""Of the threads; one may outlive the command that it worked for by what a kernel takes to return."""

_BEAT_S = 0.1


class Stopped(BaseException):
    """What ends a computation that nobody waits for any more."""


def apart(work: Callable[[Callable[[], None]], T], /) -> T:
    """Call `work` in a thread, wait for it, and return or raise as it does.

    Python hears Ctrl-C between two of its own steps, and in the main thread only: there a kernel, or the copy
    of a gigabyte, would have to end first (7 s for 19 million triangles). In a thread that compiles, an
    interrupt may even be lost, since LLVM's destructors swallow it; this one only waits.

    Parameters
    ----------
    work : function
        Writes nothing to disk. Is given a function to be called now and then, which raises `Stopped` once
        the one that waits was interrupted.
    """
    if threading.current_thread() is not threading.main_thread():
        return work(lambda: None)  # who is never interrupted need not wait
    is_over = threading.Event()
    results: list[T] = []
    errors: list[BaseException] = []

    def heed() -> None:
        if is_over.is_set():
            raise Stopped

    def run() -> None:
        try:
            results.append(work(heed))
        except BaseException as error:
            errors.append(error)

    thread = threading.Thread(target=run, name=NAME, daemon=True)
    try:
        thread.start()  # which waits a little, too, and may be interrupted there
        while thread.is_alive():
            thread.join(_BEAT_S)
    finally:
        is_over.set()
    if errors:
        raise errors[0]
    return results[0]
