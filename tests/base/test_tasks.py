"""ordered_map: order, bounded work in flight, and nothing left running."""

import threading
import time

import pytest

from foveal.base.tasks import ordered_map, thread_count, threads, threads_unless


def test_results_come_in_order_and_few_are_in_flight():
    taken = []

    def items():
        for i in range(50):
            taken.append(i)
            yield i

    with threads(3) as pool:
        for done, result in enumerate(ordered_map(pool, lambda i: i * i, items(), ahead=4)):
            assert result == done * done
            assert len(taken) <= done + 5


def test_an_error_reaches_the_caller_and_stops_the_rest():
    running = threading.Semaphore(0)
    finished = []

    def work(i):
        if i == 3:
            raise ValueError("three")
        time.sleep(0.01)
        running.release()
        finished.append(i)
        return i

    with threads(2) as pool:
        with pytest.raises(ValueError, match="three"):
            list(ordered_map(pool, work, range(100), ahead=6))
        count = len(finished)
        time.sleep(0.05)
        assert len(finished) == count < 20


def test_worker_counts():
    assert thread_count(3) == 3
    assert thread_count() >= 1
    with pytest.raises(ValueError, match="at least 1"):
        thread_count(0)


def test_threads_where_no_executor_is_given_and_a_given_one_stays_its_owners():
    with threads(1) as own:
        with threads_unless(own) as pool:
            assert pool is own
        assert own.submit(abs, -1).result() == 1
    with threads_unless(None) as pool:
        assert pool.submit(abs, -1).result() == 1
    with pytest.raises(RuntimeError):
        pool.submit(abs, -1)
