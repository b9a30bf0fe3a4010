"""foveal info: what is in a file."""

from typing import Any

from .options import Debug, Json, Source, Up
from .result import counted, print_json, print_lines, table

__all__ = ["info"]


def info(file: Source, up: Up = None, json: Json = False, debug: Debug = False) -> None:
    """Say what is in a .fov, a mesh or a scene.json.

    Of a .fov only the beginning is read: quick for any size. A mesh is read whole, its defects counted.
    """
    import foveal

    facts = foveal.info(file, up=up and up.value)
    if json:
        print_json(facts)
    else:
        print_lines(_LINES[facts["kind"]](facts))


def _scene(facts: dict[str, Any]) -> list[str]:
    lines = [f"{facts['file']}: scene {facts['title']!r}, {counted(len(facts['layers']), 'layer')}"]
    for layer in facts["layers"]:
        lines += [
            "",
            f"{layer['name']}{'' if layer['visible'] else ' (hidden at first)'}",
            *_LINES[layer["kind"]](layer),
        ]
    return lines if "light" not in facts else [*lines, "", "light", *_shadow(facts["light"])]


def _common(facts: dict[str, Any]) -> list[str]:
    counts = f"{counted(facts['triangles'], 'triangle')}, {counted(facts['vertices'], 'vertex', 'vertices')}"
    low, high = facts["box"]
    return [
        f"{facts['file']}: {counts}, {facts['bytes']:,} bytes",
        f"  size         {' x '.join(f'{b - a:.6g}' for a, b in zip(low, high, strict=True))}",
        f"  from, to     ({', '.join(f'{x:.9g}' for x in low)}), ({', '.join(f'{x:.9g}' for x in high)})",
        f"  up           {facts['up']}",
        f"  attributes   {', '.join(facts['attributes']) or 'none'}",
    ]


def _fov(facts: dict[str, Any]) -> list[str]:
    overhead = f"{facts['overhead_bytes']:,} bytes ({100 * facts['overhead_share']:.2f} %)"
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
    return [
        *_common(facts),
        f"  per vertex   {facts['bits_per_vertex']:.2f} bits, all levels together",
        f"  grid step    {facts['step']:.6g}",
        f"  patches      {facts['patches']:,} in {facts['nodes']:,} nodes, codec {facts['codec']}",
        f"  overhead     {overhead} of header, index and graph",
        "",
        *table(["level", "nodes", "patches", "triangles", "error", "bytes"], rows),
    ]


def _mesh(facts: dict[str, Any]) -> list[str]:
    lines = _common(facts)
    for name, value in facts["topology"].items():
        if name not in ("vertices", "triangles"):
            shown = ("yes" if value else "no") if isinstance(value, bool) else f"{value:,}"
            lines.append(f"  {name.removeprefix('is_').replace('_', ' '):<22} {shown}")
    return lines


def _cage(facts: dict[str, Any]) -> list[str]:
    if "depths" in facts:
        return [*_common(facts), *_polygons(facts), *_depths(facts)]
    lines = [*_common(facts), f"  scheme       {facts['scheme']}, {facts['positions']} positions"]
    if facts["sharp_edges"]:
        lines.append(f"  sharp edges  {facts['sharp_edges']:,}")
    for name, region in facts["criteria"].items():
        limits = f"{region['iterations']} iterations, edge {region['edge_px']:g} px"
        lines.append(f"  {name:<12} {limits}, bend {region['bend_degrees']:.4g} degrees")
    return lines


def _polygons(facts: dict[str, Any]) -> list[str]:
    from foveal.scene.cage_polygons import PolygonCounts, told

    if "polygons" not in facts:
        return []
    counts = PolygonCounts(**facts["polygons"])
    lines = [f"  made of      {told(counts)}", f"  boundary     {counts.boundary.replace('_', ' ')}"]
    return [*lines, f"  placements   {facts['placements']:,}"] if "placements" in facts else lines


def _depths(facts: dict[str, Any]) -> list[str]:
    depths = facts["depths"]
    cone, size = depths["cone_degrees"], depths["size_px"]
    rules = [
        "no curvature" if cone is None else f"curvature {cone:.4g} degrees",
        *(name if depths[name] else f"no {name}" for name in ("backs", "silhouettes")),
        "no size" if size is None else f"radius {size[0]:g} to {size[1]:g} px",
    ]
    return [
        f"  scheme       {facts['scheme']}, depth {depths['most']} at most",
        f"  rules        {', '.join(rules)}",
    ]


def _shadow(facts: dict[str, Any]) -> list[str]:
    side, light = facts["resolution"], facts["light"]
    maps = counted(facts["maps"], "map")
    said = ", ".join(f"{key} {light[key]}" for key in _OF_A_LIGHT if light.get(key) is not None)
    return [
        f"{facts['file']}: shadows of {said or 'a light'}, {facts['bytes']:,} bytes",
        f"  pixels       {facts['pixels']:,} ({side:,} x {side:,}, {maps})",
        f"  ratio        1/{4 * facts['pixels'] / facts['bytes']:,.0f} of 32 bits a pixel",
        f"  nodes        {', '.join(f'{count:,} {kind}' for kind, count in facts['nodes'].items())}",
    ]


_OF_A_LIGHT = ("kind", "time", "begin", "end", "latitude", "longitude", "direction", "position", "target")
_LINES = {"scene": _scene, "multires": _fov, "mesh": _mesh, "cage": _cage, "shadow": _shadow}
