"""`apart`: a computation that can be left at once."""

import signal
import sys
import threading
import time

import pytest

from foveal.scene.apart import NAME, Stopped, apart


def test_it_returns_and_raises_as_the_work_does():
    assert apart(lambda heed: heed() or 7) == 7

    def fails(heed):
        raise ValueError("seven")

    with pytest.raises(ValueError, match="seven"):
        apart(fails)


@pytest.mark.skipif(sys.platform == "win32", reason="Windows cannot send SIGINT to one thread")
def test_an_interrupt_is_heard_while_the_work_hears_nothing():
    ended = threading.Event()

    def deaf(heed):
        signal.raise_signal(signal.SIGINT)  # heard by the main thread, which waits
        time.sleep(1.0)
        try:
            heed()
        except Stopped:
            ended.set()
            raise

    begin = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        apart(deaf)
    assert time.monotonic() - begin < 0.9
    assert ended.wait(10)  # and the work ends when it next asks
    for thread in threading.enumerate():
        if thread.name == NAME:
            thread.join(10)


def test_another_thread_than_the_main_one_works_by_itself():
    found = []
    thread = threading.Thread(target=lambda: found.append(apart(lambda heed: threading.current_thread())))
    thread.start()
    thread.join()
    assert found == [thread]
