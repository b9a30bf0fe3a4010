# mypy: allow-untyped-defs, allow-untyped-calls
"""Cosine and sine of a share of a full turn, the same to the last bit on every machine and in the viewer.

Libraries differ in the last bit of a cosine, and positions that are compared bit for bit lean on it. So the
angle is brought into the first eighth of a turn in whole numbers, where the first terms of the series are
exact to rounding. The same as `viewer/src/refine/turn.ts`.
"""

from foveal.base.jit import lean

FULL = 6.283185307179586


@lean
def turn(i, n):
    """(cosine, sine) of i / n of a full turn; 0 <= i < n."""
    is_below = 2 * i > n
    part = 2 * (n - i if is_below else i)  # of 2 n: up to half a turn
    is_left = 2 * part > n
    if is_left:
        part = n - part
    is_steep = 4 * part > n  # nearer to a quarter of a turn
    x = FULL * (n - 2 * part) / (4 * n) if is_steep else FULL * part / (2 * n)
    across, along = cosine_of(x * x), x * sine_of(x * x)
    cosine, sine = (along, across) if is_steep else (across, along)
    return -cosine if is_left else cosine, -sine if is_below else sine


@lean
def sine_of(q):
    """Up to an eighth of a turn, whose square is q: the sine over the angle."""
    total = 2.8114572543455206e-15
    total = total * q - 7.647163731819816e-13
    total = total * q + 1.6059043836821613e-10
    total = total * q - 2.505210838544172e-08
    total = total * q + 2.7557319223985893e-06
    total = total * q - 0.0001984126984126984
    total = total * q + 0.008333333333333333
    total = total * q - 0.16666666666666666
    return total * q + 1.0


@lean
def cosine_of(q):
    """The same: the cosine."""
    total = 4.779477332387385e-14
    total = total * q - 1.1470745597729725e-11
    total = total * q + 2.08767569878681e-09
    total = total * q - 2.755731922398589e-07
    total = total * q + 2.48015873015873e-05
    total = total * q - 0.001388888888888889
    total = total * q + 0.041666666666666664
    total = total * q - 0.5
    return total * q + 1.0
