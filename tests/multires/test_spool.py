"""Stores and columns: the same content in memory and in files, nothing left behind."""

import numpy as np
import pytest

from foveal.multires.spool import Column, Room, Store


@pytest.mark.parametrize("limit", [0, 5_000, 1 << 30])
def test_a_store_gives_back_what_was_put(limit, tmp_path):
    rng = np.random.default_rng(0)
    room = Room(limit, tmp_path)
    store = Store(room)
    content = [(rng.random((n, 3)), np.arange(n, dtype=np.int32)) for n in (0, 1, 100, 7)]
    refs = [store.put(arrays) for arrays in content]
    for ref, arrays in zip(refs, content, strict=True):
        for got, put in zip(store.get(ref), arrays, strict=True):
            np.testing.assert_array_equal(got, put)
    store.close()
    assert room.left == limit
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("limit", [0, 5_000, 1 << 30])
def test_a_column_is_read_by_ranges_and_by_numbers(limit, tmp_path):
    rng = np.random.default_rng(0)
    table = rng.integers(0, 1000, (5000, 3)).astype(np.int32)
    room = Room(limit, tmp_path)
    column = Column(room, np.int32, 3)
    for begin in range(0, 5000, 700):
        column.append(table[begin : begin + 700])
    column.seal()
    np.testing.assert_array_equal(column.part(4000, 9000), table[4000:])
    numbers = rng.integers(0, 5000, 300)
    np.testing.assert_array_equal(column.take(numbers), table[numbers])
    column.set(10, table[:5])
    np.testing.assert_array_equal(column.part(10, 15), table[:5])
    column.close()
    assert room.left == limit
    assert list(tmp_path.iterdir()) == []
