"""Small maps of intervals of every sort, and their trees."""

import numpy as np

from shadows.naive_shadows import tree_of_pixels

FAR = (1 << 32) - 1


def things(side, seed, *, images=None):
    """Intervals of balls over a tilted floor, and of nothing: between first and second surface."""
    random = np.random.default_rng(seed)
    y, x = np.mgrid[:side, :side] / side
    floor = 0.8 + 0.1 * x + 0.05 * y
    near = np.where(x + y > 1.85, FAR / 2**32, floor)
    far = near.copy()
    middles, radii = random.random((6, 2)), 0.05 + 0.2 * random.random(6)
    stack = []
    for image in range(images or 1):
        low, high = near.copy(), far.copy()
        for (cx, cy), radius in zip(middles, radii, strict=True):
            rest = radius**2 - (x - cx - 0.01 * image) ** 2 - (y - cy) ** 2
            half = np.sqrt(np.maximum(rest, 0))
            is_first = (rest > 0) & (0.5 - half < low)
            low, high = np.where(is_first, 0.5 - half, low), np.where(is_first, 0.5 + half, high)
        stack.append((low, high))
    steps = np.floor(np.array(stack) * 2.0**32).astype(np.int64).clip(0, FAR)
    lower, upper = steps[:, 0], np.maximum(steps[:, 0], steps[:, 1] - 1)
    return (lower, upper) if images else (lower[0], upper[0])


def noise(shape, seed):
    """No two pixels alike, some free, so that the tree is as large as can be."""
    random = np.random.default_rng(seed)
    lower = random.integers(0, FAR, shape)
    upper = np.where(random.random(shape) < 0.1, FAR, lower)
    return lower, upper


def uneven(side, seed):
    """Noise in one corner, one value in the rest."""
    lower, upper = noise((side, side), seed)
    rest = np.ones((side, side), bool)
    rest[: side // 2, side // 4 : side // 2] = False
    lower[rest], upper[rest] = 5, FAR // 3
    return lower, upper


TREES = {
    "one_value": lambda: tree_of_pixels(np.full((8, 8), 7), np.full((8, 8), FAR - 1)),
    "one_pixel": lambda: tree_of_pixels(np.full((1, 1), 9), np.full((1, 1), 9)),
    "things": lambda: tree_of_pixels(*things(32, 1)),
    "noise": lambda: tree_of_pixels(*noise((16, 16), 2)),
    "uneven": lambda: tree_of_pixels(*uneven(32, 3)),
    "stack": lambda: tree_of_pixels(*things(16, 4, images=11)),
    "noisy_stack": lambda: tree_of_pixels(*noise((8, 8, 8), 5)),
}
