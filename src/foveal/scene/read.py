"""Any file that holds one surface, as one mesh in memory."""

from pathlib import Path

from foveal.base.errors import FovealError
from foveal.base.files import PathLike, refuse_missing
from foveal.mesh.trimesh import TriMesh

from .cage_file import is_cage, read_cage

__all__ = ["read"]


def read(path: PathLike, /) -> TriMesh:
    """Read a mesh file (PLY, STL, OBJ, OFF, GLB and more, also gzipped), or all triangles of a `.fov`.

    Of a control mesh these are its own, not refined.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    TriMesh
        Positions (n, 3) float64 in the file's unit and axes, faces (m, 3) int32, normals and colours
        where the file has them. Vertices are those of the file, in its order; STL repeats a vertex for
        each of its triangles.

    Raises
    ------
    FovealError
        In one sentence: missing, truncated, no mesh, NaN coordinates, indices out of range.

    Examples
    --------
    >>> import pathlib, tempfile, foveal
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "triangle.off"
    >>> _ = path.write_text("OFF\\n3 1 0\\n0 0 0\\n1 0 0\\n0 1 0\\n3 0 1 2\\n")
    >>> foveal.read(path).faces
    array([[0, 1, 2]], dtype=int32)
    """
    path = Path(path)
    refuse_missing(path)
    suffix = path.suffix.lower()
    if suffix == ".json":
        raise FovealError(f"{path}: a scene.json may hold several surfaces; read its files one by one.")
    if suffix == ".fov":
        if is_cage(path):
            return read_cage(path).mesh
        from foveal import multires

        with multires.open(path) as asset:
            return multires.extract(asset)
    from foveal.mesh.io import read_mesh

    return read_mesh(path)
