# mypy: allow-untyped-defs, allow-untyped-calls
"""Whether a ball is behind what a depth buffer shows."""

from foveal.base.jit import lean

#: Where `view` goes on with a depth buffer: its camera's basis and eye, pixels per radian, size, depths.
BASIS, EYE, PIXELS, SIZE, DEPTHS = 24, 33, 36, 37, 39


@lean
def is_hidden(view, x, y, z, radius):
    """Whether the ball around (x, y, z) is behind all that the depth buffer, if there is one, shows."""
    if len(view) <= BASIS:
        return False
    dx, dy, dz = x - view[EYE], y - view[EYE + 1], z - view[EYE + 2]
    depth = -(view[BASIS + 6] * dx + view[BASIS + 7] * dy + view[BASIS + 8] * dz)
    near, far = depth - radius, depth + radius
    if near <= 0.0:
        return False
    width, height = int(view[SIZE]), int(view[SIZE + 1])
    across = view[BASIS] * dx + view[BASIS + 1] * dy + view[BASIS + 2] * dz
    down = -(view[BASIS + 3] * dx + view[BASIS + 4] * dy + view[BASIS + 5] * dz)
    left, right = span(across, radius, near, far, view[PIXELS], width)
    top, bottom = span(down, radius, near, far, view[PIXELS], height)
    if left < 0 or top < 0 or right >= width or bottom >= height:
        return False
    begin = DEPTHS
    while right - left > 1 or bottom - top > 1:  # up to where it is two by two squares at most
        begin += width * height
        width, height = (width + 1) // 2, (height + 1) // 2
        left, right, top, bottom = left // 2, right // 2, top // 2, bottom // 2
    for row in range(top, bottom + 1):
        for column in range(left, right + 1):
            if view[begin + row * width + column] >= near:
                return False
    return True


@lean
def span(across, radius, near, far, pixels, size):
    """The first and last pixel that a ball may cover, -1 and beyond where it leaves the picture."""
    low, high = across - radius, across + radius
    first = 0.5 * size + pixels * low / (near if low < 0.0 else far)
    last = 0.5 * size + pixels * high / (near if high > 0.0 else far)
    if not (first >= 0.0 and last < size):
        return -1, -1
    return int(first), int(last)
