"""Which format a file has, by its content; a suffix that says otherwise is refused."""

import re
import struct
from pathlib import Path

from foveal.base.errors import FovealError

from .stream import ByteStream

__all__ = ["detect"]

_HEAD_BYTES = 1 << 14
_OURS = {"ply", "stl", "obj"}
_THEIRS = {"off", "glb", "gltf", "dae", "3mf", "3dxml", "xyz", "ctm", "zae", "xaml"}

# What is no mesh for us, but can be named: (how it begins, what it is, what to do).
_STRANGERS = [
    (b"\x89PNG", "a PNG picture", "Choose a mesh file"),
    (b"\xff\xd8\xff", "a JPEG picture", "Choose a mesh file"),
    (b"%PDF", "a PDF document", "Choose a mesh file"),
    (b"FOV\x1a", "a .fov file, already built", "View it, or export it to PLY first"),
    (b"LASF", "a LAS or LAZ point cloud", "Make a surface of the points first"),
    (b"ASTM-E57", "an E57 point cloud", "Make a surface of the points first"),
    (b"# .PCD", "a PCD point cloud", "Make a surface of the points first"),
    (b"# vtk DataFile", "a VTK file", "Convert it to PLY first"),
    (b"Kaydara FBX", "an FBX file", "Convert it to GLB first"),
    (b"BLENDER", "a Blender file", "Export it as GLB first"),
    (b"PK\x03\x04", "a ZIP archive", "Unpack it first"),
    (b"SQLite", "a database", "Choose a mesh file"),
    (b"<!DOCTYPE html", "a web page", "Download the file itself"),
    (b"<html", "a web page", "Download the file itself"),
]


def detect(path: Path) -> str:
    """The format's name, such as "ply", "stl", "obj", "glb".

    Raises
    ------
    FovealError
        If the file is missing, empty, named as another format than it has, or of none that is known.
    """
    with ByteStream(path) as stream:
        head = stream.read(_HEAD_BYTES)
        size = None if stream.is_gzipped else stream.size
    if not head:
        raise FovealError(f"{path}: the file is empty. Copy or export it again.")
    suffix = _suffix(path)
    kind = _by_content(head, size)
    if kind == "zip" and suffix in ("3mf", "3dxml", "zae"):
        return suffix
    if kind is not None and kind != "zip":
        if suffix in _OURS | _THEIRS and suffix != kind:
            # Nothing would be lost by reading it, but a name that is wrong tends to be a wrong file.
            raise FovealError(
                f"{path}: it is named .{suffix} but holds {kind.upper()}. Rename it to .{kind}."
            )
        return kind
    for start, what, remedy in _STRANGERS:
        if head.lstrip().startswith(start):
            raise FovealError(f"{path}: this looks like {what}, not a mesh. {remedy}.")
    if suffix == "obj" and _is_text(head) and re.search(rb"(?m)^\s*v[ \t]+[-+.0-9]", head):
        return "obj"
    if suffix in _OURS and suffix != "stl":
        shown = "text" if _is_text(head) else "binary data"
        raise FovealError(
            f"{path}: it is named .{suffix} but does not begin like one; it looks like {shown}."
            " Check which file it is."
        )
    if suffix == "stl" or (suffix in _THEIRS and suffix not in ("off", "glb", "gltf")):
        return suffix
    raise FovealError(
        f"{path}: this is no mesh format that is known. Convert it to PLY, STL, OBJ, OFF or GLB."
    )


def _suffix(path: Path) -> str:
    names = path.name.lower().split(".")
    return names[-2] if names[-1] == "gz" and len(names) > 2 else names[-1]


def _is_text(head: bytes) -> bool:
    return b"\0" not in head and sum(b < 9 or 13 < b < 32 for b in head) <= len(head) // 100


def _by_content(head: bytes, size: int | None) -> str | None:
    if re.match(rb"ply[ \t]*[\r\n]", head):
        return "ply"
    if head.startswith(b"glTF"):
        return "glb"
    if head.startswith(b"PK\x03\x04"):
        return "zip"
    if size is not None and len(head) >= 84 and size == 84 + 50 * struct.unpack_from("<I", head, 80)[0]:
        return "stl"
    if not _is_text(head):
        return None
    if re.match(rb"(?i)\s*solid\b", head) and re.search(rb"(?i)\b(facet|endsolid)\b", head):
        return "stl"
    if re.match(rb"(\s|#.*\n)*(ST)?C?N?4?n?OFF\b", head):
        return "off"
    if re.match(rb"\s*\{", head) and b'"asset"' in head:
        return "gltf"
    if re.match(rb"\s*<", head):
        return "dae" if b"<COLLADA" in head else None
    return _obj_or_none(head)


def _obj_or_none(head: bytes) -> str | None:
    """OBJ has no magic: the first line that is no comment must begin with one of its words."""
    for line in re.split(rb"[\r\n]+", head):
        words = line.split()
        if words and not words[0].startswith(b"#"):
            known = (b"v", b"vn", b"vt", b"vp", b"f", b"o", b"g", b"s", b"l", b"p", b"mtllib", b"usemtl")
            return "obj" if words[0] in known else None
    return None
