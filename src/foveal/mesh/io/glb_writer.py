"""Writing GLB: one mesh in one binary file, glTF 2.0."""

import json
import os
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError
from foveal.base.files import whole_file

from ..colours import linear_of_srgb
from ..trimesh import TriMesh

__all__ = ["write_glb"]

_FLOAT, _UINT16, _UINT32 = 5126, 5123, 5125
_VERTICES, _INDICES = 34962, 34963
_HALF = 0.5**0.5
# The rotation that turns the data's up axis to glTF's, which is y; as a quaternion x, y, z, w.
_TURNS = {"x": [0.0, 0.0, _HALF, _HALF], "z": [-_HALF, 0.0, 0.0, _HALF]}


def write_glb(mesh: TriMesh, path: str | os.PathLike[str], /, *, up: str = "y") -> None:
    """Write a mesh with its normals, colours and texture coordinates; the file appears when it is whole.

    Positions are float32 relative to the middle of the mesh, which the node's translation (JSON, hence
    float64) puts back, so that UTM coordinates survive. Colours are linear in glTF: sRGB bytes become
    16-bit linear light, fine enough that all 256 levels stay apart. Texture coordinates are from the upper
    left in glTF, so the second becomes 1 - v. `up` names the axis of the data
    that points up; a node turns it to y, the data themselves stay as they are.

    Raises
    ------
    FovealError
        If the file cannot be written there, or would exceed the 4 GiB of a GLB.
    """
    body = _Body()
    centre = (mesh.positions.min(axis=0) + mesh.positions.max(axis=0)) / 2
    attributes = {"POSITION": body.add((mesh.positions - centre).astype("<f4"), _FLOAT, "VEC3", bounds=True)}
    if mesh.normals is not None:
        # The standard wants unit normals everywhere; where there is none, any will do.
        normals = np.where((mesh.normals == 0).all(axis=1, keepdims=True), [[0, 0, 1]], mesh.normals)
        attributes["NORMAL"] = body.add(normals.astype("<f4"), _FLOAT, "VEC3")
    if mesh.colours is not None:
        light = np.full((len(mesh.colours), 4), 65535, dtype="<u2")  # four, for rows must align to 4 bytes
        light[:, :3] = np.rint(linear_of_srgb(mesh.colours) * 65535)
        attributes["COLOR_0"] = body.add(light, _UINT16, "VEC4", normalised=True)
    if mesh.uvs is not None:
        attributes["TEXCOORD_0"] = body.add((mesh.uvs * [1, -1] + [0, 1]).astype("<f4"), _FLOAT, "VEC2")
    kind, width = (_UINT16, "<u2") if len(mesh.positions) <= 65535 else (_UINT32, "<u4")
    indices = body.add(mesh.faces.reshape(-1).astype(width), kind, "SCALAR", target=_INDICES)
    nodes: list[dict[str, Any]] = [{"mesh": 0, "translation": centre.tolist()}]
    if up in _TURNS:
        nodes.append({"rotation": _TURNS[up], "children": [0]})
    tree = {
        "asset": {"version": "2.0", "generator": "foveal"},
        "scene": 0,
        "scenes": [{"nodes": [len(nodes) - 1]}],
        "nodes": nodes,
        "meshes": [{"primitives": [{"attributes": attributes, "indices": indices, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0.0}, "doubleSided": True}],
        "accessors": body.accessors,
        "bufferViews": body.views,
        "buffers": [{"byteLength": body.size}],
    }
    _write(path, tree, body)


class _Body:
    """The binary chunk while it grows, with its accessors and views, one each an array."""

    def __init__(self) -> None:
        self.accessors: list[dict[str, Any]] = []
        self.views: list[dict[str, Any]] = []
        self.parts: list[NDArray[Any]] = []
        self.size = 0

    def add(
        self,
        array: NDArray[Any],
        kind: int,
        shape: str,
        *,
        bounds: bool = False,
        normalised: bool = False,
        target: int = _VERTICES,
    ) -> int:
        """Append an array; gives the number of its accessor."""
        accessor = {"bufferView": len(self.views), "componentType": kind, "count": len(array), "type": shape}
        if bounds:
            accessor["min"] = [float(v) for v in array.min(axis=0)]
            accessor["max"] = [float(v) for v in array.max(axis=0)]
        if normalised:
            accessor["normalized"] = True
        self.accessors.append(accessor)
        self.views.append(
            {"buffer": 0, "byteOffset": self.size, "byteLength": array.nbytes, "target": target}
        )
        self.parts.append(array)
        self.size += array.nbytes + -array.nbytes % 4
        return len(self.accessors) - 1


def _write(path: str | os.PathLike[str], tree: dict[str, Any], body: _Body) -> None:
    text = json.dumps(tree, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    total = 12 + 8 + len(text) + 8 + body.size
    if total >= 1 << 32:
        raise FovealError(f"{path}: a GLB holds at most 4 GiB and this is {total} bytes. Write a PLY.")
    with whole_file(path) as file:
        file.write(b"glTF" + (2).to_bytes(4, "little") + total.to_bytes(4, "little"))
        file.write(len(text).to_bytes(4, "little") + b"JSON" + text)
        file.write(body.size.to_bytes(4, "little") + b"BIN\0")
        for part in body.parts:
            file.write(np.ascontiguousarray(part).data)
            file.write(b"\0" * (-part.nbytes % 4))
