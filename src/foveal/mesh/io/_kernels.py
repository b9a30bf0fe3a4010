# mypy: allow-untyped-defs, allow-untyped-calls
"""Inner loops of the readers: bytes to numbers, lists to triangles.

Decimal numbers are read exactly (the nearest double, as Python's `float` does) or reported as not
read, never approximately. Based on: William D. Clinger. How to read floating point numbers
accurately. PLDI 1990 (the case of exact powers of ten), and T. J. Dekker. A floating-point technique
for extending the available precision. Numerische Mathematik 18, 1971 (the case of 17 digits).
"""

import numpy as np

from foveal.base.jit import kernel

_POWERS = 10.0 ** np.arange(23)  # all exact

# What a slow-table row holds: begin and end of the token in the buffer, then where its value belongs.
SLOW_COLUMNS = 3


@kernel
def _product(a, b):
    """a b = high + low exactly (Dekker)."""
    high = a * b
    t = 134217729.0 * a
    a1 = t - (t - a)
    a2 = a - a1
    t = 134217729.0 * b
    b1 = t - (t - b)
    b2 = b - b1
    low = ((a1 * b1 - high) + a1 * b2 + a2 * b1) + a2 * b2
    return high, low


@kernel
def _scaled(mantissa, power):
    """mantissa 10^power for |power| <= 22, and whether it is surely the nearest double."""
    high = float(mantissa)
    if -9007199254740992 <= mantissa <= 9007199254740992:
        if power >= 0:
            return high * _POWERS[power], True
        return high / _POWERS[-power], True
    low = float(mantissa - np.int64(high))
    if power >= 0:
        first, second = _product(high, _POWERS[power])
        second += low * _POWERS[power]
    else:
        ten = _POWERS[-power]
        first = high / ten
        back, rest = _product(first, ten)
        second = ((high - back) - rest + low) / ten
    near = first + second
    off = (first - near) + second
    # The pair is right to 2^-100: the nearest double is sure unless that could cross a midpoint.
    doubt = abs(near) * 2.0**-90
    return near, near + (off + doubt) == near and near + (off - doubt) == near


@kernel
def parse_number(buffer, at, end):
    """Read a decimal number: its value, where it ends, and whether the value is exact."""
    is_negative = False
    if at < end and (buffer[at] == 45 or buffer[at] == 43):  # - +
        is_negative = buffer[at] == 45
        at += 1
    mantissa = np.int64(0)
    digits = 0  # without leading zeros
    fraction = 0
    seen = 0
    is_fraction = False
    while at < end:
        c = np.int64(buffer[at])
        if 48 <= c <= 57:
            if digits < 18:
                mantissa = mantissa * 10 + (c - 48)
            digits += 1 if mantissa != 0 else 0
            fraction += 1 if is_fraction else 0
            seen += 1
        elif c == 46 and not is_fraction:  # .
            is_fraction = True
        else:
            break
        at += 1
    is_exact = seen > 0 and digits <= 18
    power = 0
    if at < end and (buffer[at] == 101 or buffer[at] == 69) and seen > 0:  # e E
        at += 1
        is_small = False
        if at < end and (buffer[at] == 45 or buffer[at] == 43):
            is_small = buffer[at] == 45
            at += 1
        first = at
        while at < end and 48 <= buffer[at] <= 57:
            if power < 100000:
                power = power * 10 + (np.int64(buffer[at]) - 48)  # type: ignore[assignment]
            at += 1
        is_exact = is_exact and at > first
        power = -power if is_small else power
    power -= fraction
    value = 0.0
    if mantissa != 0:
        if not -22 <= power <= 22:
            return 0.0, at, False
        value, is_sure = _scaled(mantissa, power)
        is_exact = is_exact and is_sure
    return -value if is_negative else value, at, is_exact


@kernel
def parse_tokens(buffer, end, is_last, values, slow):
    """Read numbers parted by white space into `values`: bytes used, numbers, rows of `slow`.

    What cannot be read exactly is a row of `slow` (begin, end, index). A token that touches the end
    is left for the next time unless `is_last`. Stops when `slow` is full.
    """
    at = 0
    count = 0
    doubts = 0
    while count < len(values) and doubts < len(slow):
        while at < end and buffer[at] <= 32:
            at += 1
        if at >= end:
            break
        begin = at
        value, at, is_exact = parse_number(buffer, at, end)
        if not is_exact or (at < end and buffer[at] > 32):
            while at < end and buffer[at] > 32:
                at += 1
            is_exact = False
        if at >= end and not is_last:
            at = begin
            break
        if not is_exact:
            slow[doubts, 0] = begin
            slow[doubts, 1] = at
            slow[doubts, 2] = count
            doubts += 1
        values[count] = value
        count += 1
    return at, count, doubts


@kernel
def parse_vertex_lines(buffer, end, values, slow):
    """Read `vertex x y z` lines of an ASCII STL: vertices, rows of `slow`, line at fault or -1, ended.

    `buffer[:end]` holds whole lines. The last result is whether the last word seen was `endsolid`.
    """
    at = 0
    count = 0
    doubts = 0
    is_ended = False
    while at < end:
        while at < end and buffer[at] <= 32:
            at += 1
        if at >= end:
            break
        line = at
        first = buffer[at] | 32
        if first == 118 and at + 6 < end and (buffer[at + 1] | 32) == 101 and buffer[at + 6] <= 32:  # ve
            at += 6
            for axis in range(3):
                while at < end and (buffer[at] == 32 or buffer[at] == 9):
                    at += 1
                begin = at
                value, at, is_exact = parse_number(buffer, at, end)
                if not is_exact or (at < end and buffer[at] > 32):
                    while at < end and buffer[at] > 32:
                        at += 1
                    if at == begin or doubts == len(slow):
                        return count, doubts, line, False
                    slow[doubts, 0] = begin
                    slow[doubts, 1] = at
                    slow[doubts, 2] = 3 * count + axis
                    doubts += 1
                values[3 * count + axis] = value
            count += 1
            is_ended = False
        elif first == 101 and at + 3 < end and (buffer[at + 3] | 32) == 115:  # ends(olid)
            is_ended = True
        while at < end and buffer[at] != 10 and buffer[at] != 13:
            at += 1
    return count, doubts, -1, is_ended
