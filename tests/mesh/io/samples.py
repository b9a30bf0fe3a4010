"""Small files of every format, as bytes, all of the same tetrahedron with attributes where they go."""

import gzip
import io
import struct

import numpy as np

from foveal.mesh.io.glb_writer import write_glb
from foveal.mesh.io.ply_writer import write_ply
from foveal.mesh.shapes import tetrahedron
from foveal.mesh.trimesh import TriMesh

SOLID = tetrahedron()
ATTRIBUTED = TriMesh.of(
    SOLID.positions,
    SOLID.faces,
    normals=SOLID.positions,
    colours=np.array([[255, 0, 0], [0, 128, 0], [0, 0, 64], [7, 77, 177]]),
)


def _rows(array):
    return "".join(" ".join(map(repr, row)) + "\n" for row in array.tolist())


def ply_ascii():
    head = "ply\nformat ascii 1.0\ncomment hello\nelement vertex 4\nproperty double x\nproperty double y\n"
    head += "property double z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
    return (head + _rows(SOLID.positions) + _rows(np.insert(SOLID.faces, 0, 3, axis=1))).encode()


def ply_binary(order="<", count="B", index="i"):
    """Attributes, an element nobody knows, extra properties before and after the list."""
    names = {"B": "uchar", "b": "char", "H": "ushort", "i": "int", "I": "uint", "h": "short"}
    what = {"<": "binary_little_endian", ">": "binary_big_endian"}[order]
    head = (
        f"ply\nformat {what} 1.0\nelement vertex 4\nproperty float nx\nproperty double x\nproperty double y\n"
    )
    head += "property double z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
    head += "property float ny\nproperty float nz\nelement strange 2\n"
    head += "property short a\nproperty list uint short b\n"
    head += (
        f"element face 4\nproperty float quality\nproperty list {names[count]} {names[index]} vertex_index\n"
    )
    head += "property uchar flag\nend_header\n"
    body = b""
    for p, c in zip(SOLID.positions, ATTRIBUTED.colours, strict=True):
        body += struct.pack(order + "fdddBBBff", p[0], *p, *c.tolist(), p[1], p[2])
    body += struct.pack(order + "hIhhh", 5, 3, 1, 2, 3) + struct.pack(order + "hI", 6, 0)
    for f in SOLID.faces.tolist():
        body += struct.pack(order + "f" + count + 3 * index + "B", 0.5, 3, *f, 1)
    return head.encode() + body


def ply_strips(order="<"):
    """The tetrahedron as one list: a strip of 2 triangles, a restart, another of 2."""
    head = "ply\nformat " + {"<": "binary_little_endian", ">": "binary_big_endian"}[order] + " 1.0\n"
    head += "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    head += "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
    strip = [0, 1, 2, 3, -1, 1, 0, 3, 2]
    body = SOLID.positions.astype(order + "f4").tobytes() + struct.pack(order + "10i", 9, *strip)
    return head.encode() + body


def ply_written():
    return _written(write_ply, "mesh.ply")


def glb_written():
    return _written(write_glb, "mesh.glb")


def _written(write, name):
    import tempfile
    from pathlib import Path

    with tempfile.TemporaryDirectory() as folder:
        write(ATTRIBUTED, Path(folder, name))
        return Path(folder, name).read_bytes()


def stl_binary(header=b"solid but binary"):
    corners = SOLID.positions[SOLID.faces].astype("<f4")
    rows = [struct.pack("<3f", 0, 0, 0) + c.tobytes() + b"\0\0" for c in corners]
    return header.ljust(80, b"\0") + struct.pack("<I", 4) + b"".join(rows)


def stl_ascii():
    text = io.StringIO()
    text.write("solid tetra\n")
    for triangle in SOLID.positions[SOLID.faces]:
        text.write(" facet normal 0 0 0\n  outer loop\n")
        for p in triangle.tolist():
            text.write(f"   vertex {p[0]!r} {p[1]:.17e} {p[2]!r}\n")
        text.write("  endloop\n endfacet\n")
    text.write("endsolid tetra\n")
    return text.getvalue().encode()


def obj():
    text = "# a comment\nmtllib none.mtl\no solid\n"
    for p, c in zip(SOLID.positions.tolist(), (ATTRIBUTED.colours / 255).tolist(), strict=True):
        text += "v " + " ".join(map(repr, p + c)) + "\n"
    for p in SOLID.positions.tolist():
        text += "vn " + " ".join(map(repr, p)) + "\n"
    text += "usemtl stone\ns 1\nt crease 2/1/0 0 1 2.5\n"
    for a, b, c in (SOLID.faces + 1).tolist():
        text += f"f {a}//{a} \\\n {b}//{b} {c}//{c} # corner\n"
    return text.encode()


def off():
    return ("OFF\n4 4 6\n" + _rows(SOLID.positions) + _rows(np.insert(SOLID.faces, 0, 3, axis=1))).encode()


FILES = {
    "ascii.ply": ply_ascii,
    "little.ply": ply_binary,
    "big.ply": lambda: ply_binary(">"),
    "strips.ply": ply_strips,
    "written.ply": ply_written,
    "binary.stl": stl_binary,
    "ascii.stl": stl_ascii,
    "solid.obj": obj,
    "solid.off": off,
    "written.glb": glb_written,
    "packed.ply.gz": lambda: gzip.compress(ply_binary(), mtime=0),
    "packed.obj.gz": lambda: gzip.compress(obj(), mtime=0),
    "packed.stl.gz": lambda: gzip.compress(stl_binary(), mtime=0),
}
"""Name -> function that gives the bytes of a file of that name."""
