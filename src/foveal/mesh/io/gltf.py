"""glTF on its way to trimesh: what it claims is checked before anything allocates by it."""

import importlib.util
import json
from pathlib import Path
from typing import Any

from foveal.base.errors import FovealError

from .stream import ByteStream

__all__ = ["prepare_gltf"]

_MOST_ELEMENTS = 1 << 31
_DRACO = "KHR_draco_mesh_compression"
_READ_EXTENSIONS = {
    _DRACO,
    *("KHR_materials_unlit", "KHR_mesh_quantization", "KHR_texture_transform"),
    *("KHR_materials_pbrSpecularGlossiness", "KHR_materials_specular", "KHR_materials_ior"),
}
_COMPONENT_BYTES = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}


def prepare_gltf(path: Path, kind: str) -> bytes:
    """The file's bytes, fit for trimesh; refused is what would take memory out of proportion to the file.

    Vertex colours come under the name `_COLOR_0`: trimesh makes bytes of COLOR_0 by cutting off what is
    above 255, where glTF has 16-bit ones, too; attributes of other names it leaves as they are.

    Raises
    ------
    FovealError
        Not glTF 2, JSON that is damaged, accessors larger than the data, an extension that is required
        and unknown, Draco where the extra `draco` is missing.
    """
    with ByteStream(path) as stream:
        data = stream.read(-1)
    try:
        tree = json.loads(_json_of(data) if kind == "glb" else data)
        version = tree["asset"]["version"]
        known = sum(int(b["byteLength"]) for b in tree.get("buffers", []))
        lengths = [_accessor_bytes(a) for a in tree.get("accessors", [])]
        views = [int(v["byteLength"]) for v in tree.get("bufferViews", [])]
        required = set(tree.get("extensionsRequired", []))
        used = set(tree.get("extensionsUsed", [])) | required
        _rename_colours(tree)
    except (ValueError, KeyError, TypeError, IndexError, AttributeError, RecursionError) as error:
        raise FovealError(
            f"{path.name}: its glTF description is damaged ({type(error).__name__}). Export it again."
        ) from error
    if str(version).split(".")[0] != "2":
        raise FovealError(f"{path.name}: it is glTF {version}, and only version 2 is read. Convert it first.")
    unknown = required - _READ_EXTENSIONS
    if unknown:
        raise FovealError(
            f"{path.name}: it needs {', '.join(sorted(map(str, unknown)))}, which is not read here."
            " Export it without that extension."
        )
    if _DRACO in used and importlib.util.find_spec("DracoPy") is None:
        raise FovealError(
            f'{path.name}: it is compressed with Draco. Install the extra: pip install "foveal[draco]".'
        )
    # Draco says how many elements it will unpack to, and does so from few bytes; 512 to 1 is generous.
    room = max(known, len(data)) * (512 if _DRACO in used else 1)
    if any(length > room for length in lengths) or any(v > max(known, len(data)) for v in views):
        raise FovealError(f"{path.name}: it claims more data than it has. Copy or export it again.")
    return _glb(tree, data) if kind == "glb" else json.dumps(tree).encode()


def _json_of(data: bytes) -> bytes:
    """The JSON chunk of a GLB."""
    length = int.from_bytes(data[12:16], "little")
    if data[16:20] != b"JSON" or len(data) < 20 + length:
        raise ValueError("no JSON chunk")
    return data[20 : 20 + length]


def _accessor_bytes(accessor: dict[str, Any]) -> int:
    count = int(accessor["count"])
    if not 0 <= count < _MOST_ELEMENTS:
        raise ValueError("count")
    return count * _COMPONENT_BYTES[accessor["componentType"]] * _WIDTHS[accessor["type"]]


def _rename_colours(tree: dict[str, Any]) -> None:
    for mesh in tree.get("meshes", []):
        for primitive in mesh["primitives"]:
            draco = primitive.get("extensions", {}).get(_DRACO, {})
            for attributes in (primitive["attributes"], draco.get("attributes", {})):
                if "COLOR_0" in attributes:
                    attributes["_COLOR_0"] = attributes.pop("COLOR_0")


def _glb(tree: dict[str, Any], data: bytes) -> bytes:
    """The GLB `data` with another description."""
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    rest = data[20 + int.from_bytes(data[12:16], "little") :]
    total = 20 + len(text) + len(rest)
    return data[:8] + total.to_bytes(4, "little") + len(text).to_bytes(4, "little") + b"JSON" + text + rest
