"""Golden patches: spec/golden/patch_*.bin with patch_tables.bin, and what they decode to in patch_*.json.

    python tests/multires/codec_golden.py        write them anew and say what changed

Only for a new version of the format: bytes that were written must stay readable.
"""

import json
import sys
from pathlib import Path

FOLDER = Path(__file__).parents[2] / "spec" / "golden"


def expectation(patch):
    return {
        "positions": patch.positions.tolist(),
        "faces": patch.faces.tolist(),
        "normals": None if patch.normals is None else patch.normals.tolist(),
        "colours": None if patch.colours is None else patch.colours.tolist(),
    }


def write():
    from codec_meshes import meshes

    from foveal.multires.codec import decode, encode, train

    named = meshes()
    tables = train(named.values())
    files = {"patch_tables.bin": tables.to_bytes()}
    for name, patch in named.items():
        data = encode(patch, tables)
        decoded = decode(
            data, tables, has_normals=patch.normals is not None, has_colours=patch.colours is not None
        )
        files[f"patch_{name}.bin"] = data
        files[f"patch_{name}.json"] = (
            json.dumps(expectation(decoded), separators=(",", ":")) + "\n"
        ).encode()
    for name, data in files.items():
        path = FOLDER / name
        if not path.exists() or path.read_bytes() != data:
            print(f"{name}: {'changed' if path.exists() else 'new'}, {len(data)} bytes")
            path.write_bytes(data)


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parent))
    write()
