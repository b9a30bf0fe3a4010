# mypy: allow-untyped-defs, allow-untyped-calls
"""One interval of depth that is legal for all pixels of a tile, without looking at any of them.

With E an upper bound of where rays enter and X a lower bound of where they leave, every value in [E, X] is
legal wherever E <= X. A bound that is not tight ends no recursion wrongly; it only lets it go on.
"""

import numpy as np

from foveal.base.jit import lean

from ._kernels_flat import BACK, FRONT, SHEET, covers, depth_range, edge_meets

FAR = 4294967295
SLOTS = 2048
MOST = 400
"""Triangles above which a tile is divided without being tried: it is too large to be of one depth."""


@lean
def common_interval(flat, triangles, begin, end, x0, y0, x1, y1, is_strict, work):
    """(low, high) legal for all samples in a closed rectangle, or (1, 0): none was found.

    `triangles[begin:end]` are all that meet the rectangle; its corners are samples.
    """
    if end - begin > MOST:
        return 1, 0
    back = sheet = np.int64(FAR) + 1
    fronts = 0
    for i in range(begin, end):
        t = triangles[i]
        least, greatest = depth_range(flat, t, x0, y0, x1, y1)
        work.least[i - begin] = least
        work.greatest[i - begin] = greatest
        side = flat.sides[t]
        if side == BACK:
            back = min(back, least)
        elif side == SHEET:
            sheet = min(sheet, least)
        else:
            fronts += 1
    if fronts > 0:
        low, high = within_solids(flat, triangles, begin, end, x0, y0, x1, y1, work, back, sheet)
        if low <= high:
            return low, high
    if sheet <= FAR:
        return below_sheet(flat, triangles, begin, end, x0, y0, x1, y1, is_strict, work, sheet)
    return 1, 0


@lean
def within_solids(flat, triangles, begin, end, x0, y0, x1, y1, work, back, sheet):
    """Fronts of closed parts before all else: a ray that meets one first leaves no sooner than at a back."""
    before = min(back, sheet)
    low = np.int64(-1)
    work.near[0] = 0
    for i in range(begin, end):
        t = triangles[i]
        if flat.sides[t] == FRONT and work.greatest[i - begin] < before:
            low = max(low, work.greatest[i - begin])
            work.near[work.near[0] + 1] = t
            work.near[0] += 1
    if low < 0 or layers(flat, x0, y0, x1, y1, work) < 1:
        return np.int64(1), np.int64(0)
    return low, back - 1


@lean
def below_sheet(flat, triangles, begin, end, x0, y0, x1, y1, is_strict, work, sheet):
    """One layer of open parts before all else: rays that meet it may be said to leave before the next."""
    # The nearest layer: what begins no deeper than it ends, until nothing more does.
    reach, count = sheet, -1
    work.near[0] = 0
    while work.near[0] != count:
        count = work.near[0]
        work.near[0] = 0
        deepest = reach
        for i in range(begin, end):
            if work.least[i - begin] <= reach:
                t = triangles[i]
                if flat.sides[t] != SHEET:
                    return np.int64(1), np.int64(0)
                deepest = max(deepest, work.greatest[i - begin])
                work.near[work.near[0] + 1] = t
                work.near[0] += 1
        reach = deepest
    if is_strict and reach > sheet:
        return np.int64(1), np.int64(0)
    behind = reach + 1 if is_strict else np.int64(FAR) + 1
    for i in range(begin, end):
        if not is_strict and work.least[i - begin] > reach:
            behind = min(behind, work.least[i - begin])
    if layers(flat, x0, y0, x1, y1, work) != 1:
        return np.int64(1), np.int64(0)
    return reach, behind - 1


@lean
def layers(flat, x0, y0, x1, y1, work):
    """How often the near triangles cover each place of a rectangle, or -1 where that may differ.

    Where every edge of theirs that meets the rectangle is run as often one way as the other, how often they
    cover a place is the same all over it: what changes it is crossing an edge that is not undone by another.
    """
    work.stamp[0] += 1
    stamp = work.stamp[0]
    used = 0
    for i in range(1, work.near[0] + 1):
        t = work.near[i]
        for a in range(3):
            if not edge_meets(flat.corners, t, a, x0, y0, x1, y1):
                continue
            number = flat.edges[t, a]
            key, step = (number, 1) if number > 0 else (-number, -1)
            slot = (key * 40503) & (SLOTS - 1)
            while work.stamps[slot] == stamp and work.keys[slot] != key:
                slot = (slot + 1) & (SLOTS - 1)
            if work.stamps[slot] != stamp:
                work.stamps[slot] = stamp
                work.keys[slot] = key
                work.sums[slot] = 0
                work.slots[used] = slot
                used += 1
            work.sums[slot] += step
    for i in range(used):
        if work.sums[work.slots[i]] != 0:
            return -1
    count = 0
    for i in range(1, work.near[0] + 1):
        if covers(flat.corners, work.near[i], x0, y0):
            count += 1
    return count
