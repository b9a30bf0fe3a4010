"""Pictures on a surface, read and looked up where the vertices are."""

import warnings
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

__all__ = ["picture_array", "read_picture", "sample_picture"]


def read_picture(path: Path) -> NDArray[np.uint8] | None:
    """(h, w, 3) sRGB bytes, or None if it is no picture that can be read."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # pictures of 100 megapixels are usual on scans
            with Image.open(path) as picture:
                return picture_array(picture)
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError):
        return None


def picture_array(picture: Image.Image) -> NDArray[np.uint8]:
    """(h, w, 3) sRGB bytes of a Pillow image."""
    return np.asarray(picture.convert("RGB"), dtype=np.uint8)


def sample_picture(picture: NDArray[np.uint8], uvs: NDArray[np.floating]) -> NDArray[np.float64]:
    """(k, 3) colours, 0 to 255, at texture coordinates `uvs` (k, 2).

    (0, 0) is the lower left corner of the picture, which repeats beyond 0 and 1. Bilinear between the
    middles of its pixels.

    Examples
    --------
    >>> two = np.array([[[0, 0, 0], [200, 100, 50]]], dtype=np.uint8)
    >>> sample_picture(two, np.array([[0.25, 0.5], [0.5, 0.5], [1.75, 0]]))
    array([[  0.,   0.,   0.],
           [100.,  50.,  25.],
           [200., 100.,  50.]])
    """
    height, width = picture.shape[:2]
    with np.errstate(invalid="ignore"):
        inside = np.nan_to_num(uvs - np.floor(uvs), nan=0.0).astype(np.float64)
    x = inside[:, 0] * width - 0.5
    y = (1 - inside[:, 1]) * height - 0.5
    column, row = np.floor(x).astype(np.int64), np.floor(y).astype(np.int64)
    right, down = (x - column)[:, None], (y - row)[:, None]
    columns = [column % width, (column + 1) % width]
    rows = [row % height, (row + 1) % height]
    above = picture[rows[0], columns[0]] * (1 - right) + picture[rows[0], columns[1]] * right
    below = picture[rows[1], columns[0]] * (1 - right) + picture[rows[1], columns[1]] * right
    result: NDArray[np.float64] = above * (1 - down) + below * down
    return result
