"""Textures of OBJ files, sampled into one colour a vertex."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .checks import bytes_of_colours
from .obj_parser import ObjRows
from .textures import read_picture, sample_picture

__all__ = ["TexturedColours"]

_WHITE = np.full(3, 255.0)
_MOST_LIBRARY_BYTES = 1 << 24


class TexturedColours:
    """Follows an OBJ file and gathers, for each vertex, the texture's colours at its corners.

    Nothing is gathered until a material with a picture that exists is named: most files have none. Then
    it takes 16 bytes a vertex and 8 a texture coordinate.
    """

    def __init__(self, folder: Path) -> None:
        self.notes: list[str] = []
        self._folder = folder
        self._colours: dict[str, NDArray[np.float64]] = {}
        self._pictures: dict[str, Path] = {}
        self._present = ""
        self._opened: tuple[Path | None, NDArray[np.uint8] | None] = (None, None)
        self._uvs = np.empty((0, 2), dtype=np.float32)
        self._uv_count = 0
        self._sums = np.empty((0, 4), dtype=np.float32)
        self._is_used = False
        self._unread: set[str] = set()

    def take(self, rows: ObjRows) -> None:
        """Gather from the next rows, then heed the statement after them."""
        if self._pictures:
            self._keep_uvs(rows.uvs)
            if len(rows.triangles):
                self._gather(rows)
        if len(rows.statement) == 2:
            word, rest = rows.statement
            if word == "usemtl":
                self._present = rest.strip()
            elif word == "mtllib":
                self._read_library(rest.strip())

    def finish(self, vertices: int) -> NDArray[np.uint8] | None:
        """(vertices, 3) colours, or None if no texture was seen."""
        for name in sorted(self._unread):
            self.notes.append(f"the texture {name} cannot be read and was left out")
        if not self._is_used:
            return None
        self.notes.append("its texture was sampled into vertex colours")
        self._grow(vertices)
        sums = self._sums[:vertices]
        count = sums[:, 3:]
        return bytes_of_colours(np.where(count > 0, sums[:, :3] / np.maximum(count, 1), 255.0), 1.0)

    def _keep_uvs(self, uvs: NDArray[np.float64]) -> None:
        need = self._uv_count + len(uvs)
        if need > len(self._uvs):
            grown = np.zeros((max(need, 2 * len(self._uvs)), 2), dtype=np.float32)
            grown[: self._uv_count] = self._uvs[: self._uv_count]
            self._uvs = grown
        with np.errstate(over="ignore", invalid="ignore"):
            # Fractions first: float32 has few digits left for the place within a far repeat.
            self._uvs[self._uv_count : need] = np.nan_to_num(uvs - np.floor(uvs))
        self._uv_count = need

    def _grow(self, count: int) -> None:
        if count > len(self._sums):
            grown = np.zeros((max(count, 2 * len(self._sums)), 4), dtype=np.float32)
            grown[: len(self._sums)] = self._sums
            self._sums = grown

    def _gather(self, rows: ObjRows) -> None:
        corners, places = rows.triangles.ravel(), rows.triangle_uvs.ravel()
        limit = 2 * len(self._sums) + 4 * len(corners) + (1 << 20)
        good = corners < limit  # an index far beyond is refused later; it must not cost memory here
        picture = self._picture()
        if picture is not None:
            good &= (places >= 0) & (places < self._uv_count)
            values = sample_picture(picture, self._uvs[places[good]])
            self._is_used = True
        else:
            values = np.broadcast_to(self._colours.get(self._present, _WHITE), (int(good.sum()), 3))
        corners = corners[good]
        if len(corners):
            self._grow(int(corners.max()) + 1)
            np.add.at(self._sums[:, :3], corners, values.astype(np.float32))
            np.add.at(self._sums[:, 3], corners, np.float32(1))

    def _picture(self) -> NDArray[np.uint8] | None:
        """The present material's picture; only the last one used is kept in memory."""
        path = self._pictures.get(self._present)
        if path is None:
            return None
        if self._opened[0] != path:
            self._opened = (path, read_picture(path))
            if self._opened[1] is None:
                self._unread.add(path.name)
        return self._opened[1]

    def _read_library(self, name: str) -> None:
        path = self._folder / name.replace("\\", "/")
        try:
            if not path.is_file():
                return  # a missing library is usual, and plain geometry is what remains
            with path.open("rb") as file:
                text = file.read(_MOST_LIBRARY_BYTES).decode("utf-8", "replace")
        except (OSError, ValueError):
            return
        present = ""
        for line in text.splitlines():
            words = line.split(maxsplit=1)
            if len(words) < 2:
                continue
            if words[0] == "newmtl":
                present = words[1].strip()
            elif words[0] == "Kd":
                self._take_colour(present, words[1].split())
            elif words[0].lower() == "map_kd":
                self._take_picture(present, words[1].strip())

    def _take_colour(self, material: str, words: list[str]) -> None:
        try:
            colour = np.array([float(w) for w in words[:3]])
        except ValueError:
            return
        if colour.shape == (3,) and np.isfinite(colour).all():
            self._colours[material] = np.clip(colour, 0, 1) * 255

    def _take_picture(self, material: str, text: str) -> None:
        """The file's name comes after options, and may have blanks: the longest end that exists is it."""
        words = text.replace("\\", "/").split(" ")
        for start in range(min(len(words), 40)):
            path = self._folder / " ".join(words[start:])
            try:
                if path.is_file():
                    self._pictures[material] = path
                    return
            except (OSError, ValueError):
                continue
        self._unread.add(words[-1])
