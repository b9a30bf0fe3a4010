"""All formats we do not stream ourselves, through trimesh, as one mesh in memory."""

import io
import warnings
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError

from ..colours import linear_of_srgb, srgb_of_linear
from ..normals import unit_normals
from ..trimesh import TriMesh
from .checks import bytes_of_colours
from .gltf import prepare_gltf
from .stream import ByteStream
from .textures import picture_array, sample_picture

__all__ = ["read_other"]


def read_other(path: Path, kind: str, /) -> tuple[TriMesh, list[str]]:
    """Read a file of format `kind` ("glb", "gltf", ...): the mesh and notes about it.

    Scenes become one mesh, each part where its node's transform puts it.

    Raises
    ------
    FovealError
        If trimesh cannot read it, it has no triangles, or an extra is needed that is missing.
    """
    parts, notes = [], []
    for geometry, transform in _load(path, kind):
        part, note = _part(geometry, transform)
        parts.append(part)
        notes += [note] if note and note not in notes else []
    if not parts:
        raise FovealError(f"{path.name}: there is no triangle in it. Choose a file with a triangle mesh.")
    return _joined(parts, path.name), notes


def _load(path: Path, kind: str) -> list[tuple[Any, NDArray[np.float64]]]:
    """The triangle meshes in a file, each with its (4, 4) transform."""
    import trimesh  # takes a third of a second, and PLY, STL and OBJ do without

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            data = prepare_gltf(path, kind) if kind in ("glb", "gltf") else _all_bytes(path)
            resolver = trimesh.resolvers.FilePathResolver(str(path))
            loaded = trimesh.load(io.BytesIO(data), file_type=kind, resolver=resolver, process=False)
            scene = loaded if isinstance(loaded, trimesh.Scene) else trimesh.Scene(loaded)
            found = []
            for node in scene.graph.nodes_geometry:
                transform, name = scene.graph[node]
                geometry = scene.geometry[name]
                if isinstance(geometry, trimesh.Trimesh) and len(geometry.faces):
                    found.append((geometry, np.asarray(transform, dtype=np.float64)))
            return found
    except FovealError:
        raise
    except MemoryError as error:
        raise FovealError(f"{path.name}: it does not fit into memory. Convert it to PLY.") from error
    except Exception as error:  # trimesh raises whatever its parsers meet
        raise FovealError(
            f"{path.name}: it cannot be read as {kind.upper()} ({_short(error)}). The file is damaged or"
            " mislabelled; export it again, for example as PLY."
        ) from error


def _all_bytes(path: Path) -> bytes:
    with ByteStream(path) as stream:
        return stream.read(-1)


def _short(error: Exception) -> str:
    text = " ".join(str(error).split())
    return f"{type(error).__name__}: {text[:80]}" if text else type(error).__name__


Part = tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.float32] | None, NDArray[np.uint8] | None]


def _part(geometry: Any, transform: NDArray[np.float64]) -> tuple[Part, str]:
    linear = transform[:3, :3]
    points = np.asarray(geometry.vertices, dtype=np.float64) @ linear.T + transform[:3, 3]
    faces = np.asarray(geometry.faces, dtype=np.int64)
    if np.linalg.det(linear) < 0:  # a mirror turns triangles over
        faces = faces[:, ::-1]
    normals = None
    if "vertex_normals" in geometry._cache:  # only then did the file give them
        given = np.asarray(geometry.vertex_normals, dtype=np.float64)
        if given.shape == points.shape:
            # Normals go by the inverse transpose; the cofactors are that without dividing.
            cofactors = np.stack([np.cross(linear[(i + 1) % 3], linear[(i + 2) % 3]) for i in range(3)])
            normals = unit_normals(given @ cofactors.T * np.sign(np.linalg.det(linear)))
    colours, note = _colours(geometry, len(points))
    return (points, faces, normals, colours), note


def _colours(geometry: Any, count: int) -> tuple[NDArray[np.uint8] | None, str]:
    """The vertices' colours as the file gives them, or looked up in its texture."""
    visual = geometry.visual
    if visual.kind == "vertex":
        return np.ascontiguousarray(np.asarray(visual.vertex_colors)[:, :3], dtype=np.uint8), ""
    if visual.kind == "face":
        return None, "its colours belong to triangles, not vertices, and were left out"
    light, note = np.ones((count, 3)), ""
    is_coloured = False
    if visual.kind == "texture":
        picture, factor = _material(visual.material)
        uvs = getattr(visual, "uv", None)
        if picture is not None and uvs is not None and np.shape(uvs) == (count, 2):
            samples = bytes_of_colours(sample_picture(picture, np.asarray(uvs)), 1.0)
            light, is_coloured = linear_of_srgb(samples), True
            note = "its texture was sampled into vertex colours"
        is_coloured |= bool((factor < 0.999).any())
        light = light * factor
    given = _gltf_colours(geometry, count)
    if given is not None:
        light, is_coloured = light * given, True
    return (srgb_of_linear(light) if is_coloured else None), note


def _gltf_colours(geometry: Any, count: int) -> NDArray[np.float64] | None:
    """COLOR_0 as linear light; see `prepare_gltf` for its name."""
    values = np.asarray(geometry.vertex_attributes.get("_COLOR_0", ()))
    if values.ndim != 2 or values.shape[0] != count or values.shape[1] not in (3, 4):
        return None
    scale = float(np.iinfo(values.dtype).max) if values.dtype.kind in "iu" else 1.0
    return values[:, :3].astype(np.float64) / scale


def _material(material: Any) -> tuple[NDArray[np.uint8] | None, NDArray[np.float64]]:
    """A material's picture and the factor, 0 to 1 in linear light, that tints it."""
    image = getattr(material, "baseColorTexture", None)
    image = getattr(material, "image", None) if image is None else image
    factor = np.ones(3)
    given = getattr(material, "baseColorFactor", None)
    if given is not None and len(given) >= 3:
        array = np.asarray(given)[:3]
        factor = array / 255.0 if array.dtype.kind in "iu" else array.astype(np.float64)
    return (None if image is None else picture_array(image)), factor


def _joined(parts: list[Part], name: str) -> TriMesh:
    """One mesh; what a part does not have is made up where another has it: white, no normal."""
    starts = np.cumsum([0] + [len(p[0]) for p in parts[:-1]])
    normals = colours = None
    if any(p[2] is not None for p in parts):
        normals = np.concatenate([np.zeros(p[0].shape, np.float32) if p[2] is None else p[2] for p in parts])
    if any(p[3] is not None for p in parts):
        colours = np.concatenate(
            [np.full(p[0].shape, 255, np.uint8) if p[3] is None else p[3] for p in parts]
        )
    return TriMesh.of(
        np.concatenate([p[0] for p in parts]),
        np.concatenate([p[1] + start for p, start in zip(parts, starts, strict=True)]),
        normals=normals,
        colours=colours,
        name=name,
    )
