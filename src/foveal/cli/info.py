"""foveal info: what is in a file."""

from typing import Any

from .options import Debug, Json, Source, Up
from .report import counted, print_json, table

__all__ = ["info"]


def info(file: Source, up: Up = None, json: Json = False, debug: Debug = False) -> None:
    """Say what is in a .fov, a mesh or a scene.json.

    Of a .fov only the beginning is read: quick for any size. A mesh is read whole, its defects counted.
    """
    import foveal

    facts = foveal.info(file, up=None if up is None else up.value)
    if json:
        print_json(facts)
    elif facts["kind"] == "scene":
        print(f"{facts['file']}: scene {facts['title']!r}, {counted(len(facts['layers']), 'layer')}")
        for layer in facts["layers"]:
            print(f"\n{layer['name']}{'' if layer['visible'] else ' (hidden at first)'}")
            _print_fov(layer)
    elif facts["kind"] == "multires":
        _print_fov(facts)
    else:
        _print_mesh(facts)


def _print_common(facts: dict[str, Any]) -> None:
    counts = f"{counted(facts['triangles'], 'triangle')}, {counted(facts['vertices'], 'vertex', 'vertices')}"
    print(f"{facts['file']}: {counts}, {facts['bytes']:,} bytes")
    low, high = facts["box"]
    print(f"  size         {' x '.join(f'{b - a:.6g}' for a, b in zip(low, high, strict=True))}")
    print(f"  from, to     ({', '.join(f'{x:.9g}' for x in low)}), ({', '.join(f'{x:.9g}' for x in high)})")
    print(f"  attributes   {', '.join(facts['attributes']) or 'none'}")


def _print_fov(facts: dict[str, Any]) -> None:
    _print_common(facts)
    print(f"  per vertex   {facts['bits_per_vertex']:.2f} bits, all levels together")
    print(f"  grid step    {facts['step']:.6g}")
    print(f"  up           {facts['up']}")
    print(f"  patches      {facts['patches']:,} in {facts['nodes']:,} nodes, codec {facts['codec']}")
    share = 100 * facts["overhead_share"]
    print(f"  overhead     {facts['overhead_bytes']:,} bytes ({share:.2f} %) of header, index and graph\n")
    rows = [
        [
            str(row["level"]),
            f"{row['nodes']:,}",
            f"{row['patches']:,}",
            f"{row['triangles']:,}",
            f"{row['error']:.4g}",
            f"{row['bytes']:,}",
        ]
        for row in facts["level_table"]
    ]
    print(table(["level", "nodes", "patches", "triangles", "error", "bytes"], rows))


def _print_mesh(facts: dict[str, Any]) -> None:
    _print_common(facts)
    for name, value in facts["topology"].items():
        if name not in ("vertices", "triangles"):
            shown = ("yes" if value else "no") if isinstance(value, bool) else f"{value:,}"
            print(f"  {name.removeprefix('is_').replace('_', ' '):<22} {shown}")
