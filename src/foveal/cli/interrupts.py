"""Ctrl-C that nothing can swallow.

LLVM's objects are taken down by Python functions whose errors Python only prints: an interrupt that falls
into one of them while a kernel is compiled is gone, or comes out as another error. So it is noted as well as
raised, and heeded when the next stage begins or the last one ends, and before an error is told.
"""

import signal
from types import FrameType

__all__ = ["heed", "listen"]

_noted: list[int] = []


def listen() -> None:
    """Note interrupts from here on, unless they are ignored or somebody else's."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, _note)


def heed() -> None:
    """Raise an interrupt that was noted, again if need be."""
    if _noted:
        raise KeyboardInterrupt


def _note(number: int, frame: FrameType | None) -> None:
    _noted.append(number)
    raise KeyboardInterrupt
