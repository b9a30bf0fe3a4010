"""USD: meshes with the tags of subdivision, in both encodings; what is not read is told."""

import sys

import numpy as np
import pytest

from foveal.base.errors import FovealError
from foveal.mesh import read_polygons
from foveal.mesh.io.usd import meshes_of
from foveal.mesh.poly_shapes import quad_grid

pytest.importorskip("pxr", reason="reading USD needs usd-core")

HOUSE = """#usda 1.0
(
    defaultPrim = "town"
    upAxis = "Z"
)
def Xform "town"
{
    double3 xformOp:translate = (9, 9, 9)
    uniform token[] xformOpOrder = ["xformOp:translate"]
    def Cube "block" {}
    def Mesh "house"
    {
        point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 2, 0)]
        int[] faceVertexCounts = [4, 3]
        int[] faceVertexIndices = [0, 1, 2, 3, 3, 2, 4]
    }
    def Mesh "shed"
    {
        point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0)]
        int[] faceVertexCounts = [3]
        int[] faceVertexIndices = [0, 1, 2]
        uniform token subdivisionScheme = "none"
    }
}
"""


def house(*further):
    """The file with further attributes of the house."""
    return HOUSE.replace("3, 3, 2, 4]", "3, 3, 2, 4]\n" + "\n".join(further))


def read(tmp_path, text, **options):
    path = tmp_path / "town.usda"
    path.write_text(text)
    return read_polygons(path, **options)


def faces_of(mesh):
    return [ring.tolist() for ring in np.split(mesh.corners, mesh.starts[1:-1])]


def test_the_first_mesh_with_the_defaults_of_the_schema(tmp_path):
    mesh = read(tmp_path, HOUSE)
    assert mesh.positions.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 2, 0]]
    assert faces_of(mesh) == [[0, 1, 2, 3], [3, 2, 4]]
    assert mesh.boundary == "edge_and_corner"  # USD's default, other than an OBJ's
    assert len(mesh.crease_edges) == len(mesh.corner_vertices) == 0
    assert mesh.colours is mesh.uvs is None


def test_an_animation_is_read_at_its_first_frame(tmp_path):
    points = HOUSE.split("points = ")[1].split("\n")[0]
    moved = points.replace("(0, 0, 0)", "(0, 0, -1)")
    text = HOUSE.replace(f"points = {points}", f"points.timeSamples = {{ 3: {points}, 1: {moved} }}", 1)
    assert read(tmp_path, text).positions[0].tolist() == [0, 0, -1]


def test_holes(tmp_path):
    assert read(tmp_path, house("int[] holeIndices = [1]")).holes.tolist() == [1]
    assert read(tmp_path, HOUSE).holes.tolist() == []
    with pytest.raises(FovealError, match="face 2 is to be a hole, but faces go from 0 to 1"):
        read(tmp_path, house("int[] holeIndices = [2]"))


def test_all_meshes_are_named(tmp_path):
    with pytest.raises(
        FovealError, match=r'no Mesh "/town" in it\. Choose one by --prim: /town/house, /town/shed\.'
    ):
        read(tmp_path, HOUSE, prim="/town")
    assert meshes_of(tmp_path / "town.usda") == ["/town/house", "/town/shed"]


def test_tags(tmp_path):
    text = house(
        "int[] creaseIndices = [0, 1, 2, 3, 2]",
        "int[] creaseLengths = [3, 2]",
        "float[] creaseSharpnesses = [2.5, 10]",
        "int[] cornerIndices = [4, 0]",
        "float[] cornerSharpnesses = [1.4, 3]",
        'token interpolateBoundary = "edgeOnly"',
    )
    mesh = read(tmp_path, text)
    assert mesh.crease_edges.tolist() == [[0, 1], [1, 2], [2, 3]]
    assert mesh.crease_sharpness.tolist() == [2.5, 2.5, 10]
    assert mesh.corner_vertices.tolist() == [0, 4]
    assert mesh.corner_sharpness.tolist() == [3, np.float32(1.4)]
    assert mesh.boundary == "edge_only"
    each = read(tmp_path, text.replace("[2.5, 10]", "[1, 2, 3]"))
    assert each.crease_sharpness.tolist() == [1, 2, 3]


def test_left_handed_faces_are_turned_round(tmp_path):
    mesh = read(tmp_path, house('uniform token orientation = "leftHanded"'))
    assert faces_of(mesh) == [[0, 3, 2, 1], [3, 4, 2]]


@pytest.mark.parametrize(("kind", "kept"), [("vertex", True), ("varying", True), ("faceVarying", False)])
def test_texture_coordinates(kind, kept, tmp_path):
    values = "[(0, 0), (1, 0), (1, 1), (0, 1), (0.5, 2)]"
    text = house(f'texCoord2f[] primvars:st = {values} ( interpolation = "{kind}" )')
    uvs = read(tmp_path, text).uvs
    assert (uvs is not None) == kept
    if kept:
        assert uvs.tolist() == [[0, 0], [1, 0], [1, 1], [0, 1], [0.5, 2]]


def test_indexed_colours_and_one_for_all(tmp_path):
    values = "color3f[] primvars:displayColor = [(1, 0, 0), (0, 0.5, 0)]"
    text = house(
        values + ' ( interpolation = "vertex" )', "int[] primvars:displayColor:indices = [0, 1, 0, 1, 0]"
    )
    red, green = [255, 0, 0], [0, 188, 0]
    assert read(tmp_path, text).colours.tolist() == [red, green, red, green, red]
    one = house("color3f[] primvars:displayColor = [(0, 0.5, 0)]")
    assert read(tmp_path, one).colours.tolist() == [green] * 5


def test_binary_files(tmp_path):
    from pxr import Usd, UsdGeom

    grid = quad_grid(3, 2)
    stage = Usd.Stage.CreateNew(str(tmp_path / "grid.usdc"))
    mesh = UsdGeom.Mesh.Define(stage, "/grid")
    mesh.CreatePointsAttr(grid.positions.tolist())
    mesh.CreateFaceVertexCountsAttr([4] * grid.faces)
    mesh.CreateFaceVertexIndicesAttr(grid.corners.tolist())
    stage.Save()
    read_back = read_polygons(tmp_path / "grid.usdc")
    np.testing.assert_array_equal(read_back.corners, grid.corners)
    np.testing.assert_allclose(read_back.positions, grid.positions, atol=1e-7)


@pytest.mark.parametrize(
    ("further", "prim", "sentence"),
    [
        ([], "/town/shed", 'town.usda: /town/shed: its subdivisionScheme is "none", and only "catmullClark"'),
        (['uniform token subdivisionScheme = "loop"'], None, 'its subdivisionScheme is "loop"'),
        ([], "/town/barn", 'there is no Mesh "/town/barn" in it'),
        ([], "/town/block", 'there is no Mesh "/town/block" in it'),
        (["int[] creaseIndices = [0, 1]"], None, "creaseLengths, creaseIndices and creaseSharpnesses do not"),
        (
            ["int[] creaseIndices = [0, 2]", "int[] creaseLengths = [2]", "float[] creaseSharpnesses = [1]"],
            None,
            "/town/house: there is no edge between vertices 0 and 2",
        ),
        (["int[] cornerIndices = [0]"], None, r"corner sharpness must be real numbers of shape \(1,\)"),
        (['token interpolateBoundary = "some"'], None, 'interpolateBoundary "some" is not known'),
    ],
)
def test_faults_are_told_in_a_sentence(further, prim, sentence, tmp_path):
    with pytest.raises(FovealError, match=f"^town.usda: .*{sentence.removeprefix('town.usda: ')}"):
        read(tmp_path, house(*further), prim=prim)


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("[4, 3]", "[4, 4]", "faceVertexCounts add up to 8, but there are 7"),
        ("[4, 3]", "[7]", "face 0 has vertex 2 twice"),
        ("[0, 1, 2, 3, 3, 2, 4]", "[0, 1, 2, 3, 3, 2, 5]", "face 1 names vertex 5"),
        ("def Mesh", "def Sphere", "there is no Mesh in it"),
        ("def Mesh", "def Mesh {", "cannot be read as USD"),
        ("#usda 1.0", "nonsense", "cannot be read as USD"),
    ],
)
def test_damaged_files_are_told_in_a_sentence(old, new, sentence, tmp_path):
    with pytest.raises(FovealError, match=sentence):
        read(tmp_path, HOUSE.replace(old, new))


def test_no_such_file_and_no_such_library(tmp_path, monkeypatch):
    with pytest.raises(FovealError, match="there is no such file"):
        read_polygons(tmp_path / "none.usda")
    monkeypatch.setitem(sys.modules, "pxr", None)
    with pytest.raises(
        FovealError, match=r"none.usda: reading USD needs usd-core.* pip install foveal\[usd\]"
    ):
        read_polygons(tmp_path / "none.usda")
