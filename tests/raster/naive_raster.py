"""Slow, obvious twins of the rasteriser: rays in floating point, and `spec/shading.md` word by word."""

import numpy as np

KEY = (-0.35, 0.45, float(np.sqrt(1 - 0.35**2 - 0.45**2)))


def rays(camera, *, shift=(0.0, 0.0)):
    """(height, width, 3): direction through each sample, one unit deep, moved by so many pixels."""
    right, up, backward = camera.basis()
    x = (np.arange(camera.width) + 0.5 + shift[0] - camera.width / 2) / camera.pixels_per_radian()
    y = (camera.height / 2 - np.arange(camera.height) - 0.5 - shift[1]) / camera.pixels_per_radian()
    return x[None, :, None] * right + y[:, None, None] * up - backward


def cast(positions, faces, camera, *, shift=(0.0, 0.0)):
    """(face ids, depths) by meeting every ray with every triangle."""
    directions = rays(camera, shift=shift)
    depths = np.full(directions.shape[:2], np.inf)
    ids = np.full(directions.shape[:2], -1)
    for f, corners in enumerate(np.asarray(positions, dtype=float)[np.asarray(faces)]):
        a, b, c = corners - camera.position
        volumes = np.stack([directions @ np.cross(p, q) for p, q in ((b, c), (c, a), (a, b))])
        total = volumes.sum(axis=0)
        with np.errstate(divide="ignore", invalid="ignore"):
            inside = (volumes / total >= 0).all(axis=0)
            depth = (a @ np.cross(b, c)) / total
        better = inside & (depth >= camera.near) & (depth <= camera.far) & (depth < depths)
        depths[better] = depth[better]
        ids[better] = f
    return ids, depths


def shade(colour, normal, facing, shadow=1.0, to_light=KEY):
    """The pixel of a point, in the camera's frame; `facing` is the triangle's normal on the eye's side."""
    normal = np.asarray(normal, dtype=float)
    if normal @ facing < 0:
        normal = -normal
    key = max(0.0, float(normal @ to_light))
    light = 0.08 + 0.17 * (0.5 + 0.5 * normal[1]) + 0.90 * shadow * key
    return [int(np.floor(255 * encode(min(1.0, decode(c / 255) * light)) + 0.5)) for c in colour]


def decode(c):
    return c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4


def encode(x):
    return 12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055
