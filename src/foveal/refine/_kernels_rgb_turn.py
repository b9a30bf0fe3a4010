# mypy: allow-untyped-defs, allow-untyped-calls
"""Cosine and sine of a turn's n-th part by sums and products: every machine gets the same bits."""

from ._kernels_rgb_layout import lean

PI = 3.141592653589793


@lean
def turn(n):
    """(cos, sin) of 2 pi / n for n >= 2: the series of half the angle, which is at most pi / 2."""
    x = PI / n
    square = x * x
    sine, cosine = 0.0, 0.0
    for i in range(12, -1, -1):  # the next terms are below 1e-18
        sine = 1.0 - sine * square / ((2.0 * i + 2.0) * (2.0 * i + 3.0))
        cosine = 1.0 - cosine * square / ((2.0 * i + 1.0) * (2.0 * i + 2.0))
    sine *= x
    return cosine * cosine - sine * sine, 2.0 * sine * cosine
