"""What a shadow cannot be made of, and parts that are closed."""

import numpy as np
import pytest

from foveal.base.errors import FovealError
from foveal.mesh.trimesh import TriMesh
from foveal.shadows import AreaLight, Directional, Point, Spot, build, intervals
from foveal.shadows.casters import casters_of, winding_number

from .scenes import ball, box, mixed, sheet, solids

DOWN = Directional((0, 0, -1))


@pytest.mark.parametrize(
    ("light", "options", "words"),
    [
        (DOWN, {"resolution": 1000}, "power of two"),
        (DOWN, {"resolution": 0}, "power of two"),
        (DOWN, {"resolution": 1 << 21}, "power of two"),
        (DOWN, {"method": "best"}, "method must be one of"),
        (DOWN, {"exits": "none"}, "exits must be"),
        (DOWN, {"method": "top-down", "resolution": 16384}, "needs all pixels"),
        (Point((0.0, 0.0, 1.2)), {}, "inside a closed part"),
        (Spot((0.0, 0.0, -0.2), (0.0, 0.0, 5.0), 1.0), {}, "inside a closed part"),
        (Spot((0.0, 0.0, 9.0), (0.0, 0.0, 20.0), 0.5), {}, "."),
    ],
)
def test_what_cannot_be_is_said(light, options, words):
    with pytest.raises(FovealError, match=words):
        build(solids(), light, **{"resolution": 64, **options})


def test_nothing_casts():
    line = TriMesh.of([[0, 0, 0], [1, 0, 0], [1, 0, 0]], [[0, 1, 2]])
    for nothing in ([], [line]):
        with pytest.raises(FovealError, match="nothing casts"):
            build(nothing, DOWN, resolution=16)
    with pytest.raises(FovealError, match="16384 at most"):
        intervals(solids(), DOWN, resolution=32768)


def test_what_is_seen_from_the_edge_casts_nothing():
    upright = TriMesh.of([[0, 0, 0], [1, 0, 0], [1, 0, 1]], [[0, 1, 2]])
    with pytest.raises(FovealError, match="meets nothing"):
        build(upright, DOWN, resolution=16)


def test_one_sheet_alone_shades_nothing_of_itself():
    shadow = build(sheet((-1, -1), (1, 1), 0.0), Directional((0.3, 0.2, -1)), resolution=64)
    assert shadow.lookup([[0, 0, 0], [0.5, 0, 0]]).all()


def test_phases_are_timed():
    shadow = build(solids(), DOWN, resolution=64)
    assert list(shadow.times) == ["joining", "projecting", "tracing"]
    assert min(shadow.times.values()) > 0


def test_an_area_light_is_a_stack():
    light = AreaLight(DOWN, np.radians(2), samples=4)
    shadow = build(solids(), light, resolution=32)
    assert shadow.is_stack
    assert len(shadow.projections) == 4


def test_closed_parts():
    meshes = mixed()
    casters = casters_of(meshes)
    closed = sum(len(m.faces) for m in solids())
    assert casters.is_closed.sum() == closed  # the sheet that is there from both sides encloses nothing
    assert not casters_of([sheet((0, 0), (1, 1), 0)]).is_closed.any()


def test_faces_in_one_place_are_one_sheet():
    """A leaf drawn from both sides, and one drawn twice; a solid that is there twice stays two."""
    leaf = sheet((0, 0), (1, 1), 0.0)
    for other in (leaf, sheet((0, 0), (1, 1), 0.0, is_turned=True)):
        casters = casters_of([leaf, other])
        assert (len(casters.faces), casters.is_closed.any()) == (2, False)
    assert casters_of([ball((0, 0, 0)), ball((0, 0, 0))]).is_closed.sum() == 640


def test_a_part_with_a_face_turned_is_open():
    mesh = ball((0, 0, 0))
    faces = mesh.faces.copy()
    faces[7] = faces[7, ::-1]
    assert not casters_of([TriMesh(mesh.positions, faces)]).is_closed.any()


def test_parts_that_share_corners_alone_are_two():
    """A closed box and a sheet that meet in one corner."""
    assert casters_of([box((0, 0, 0), (1, 1, 1)), sheet((1, 1), (2, 2), 1.0)]).is_closed.sum() == 12


def test_corners_at_one_place_are_one():
    soup = ball((0, 0, 0))
    corners = TriMesh(
        soup.positions[soup.faces].reshape(-1, 3), np.arange(3 * len(soup.faces)).reshape(-1, 3)
    )
    casters = casters_of([corners])
    assert len(casters.positions) == len(soup.positions)
    assert casters.is_closed.all()


def test_how_often_a_point_is_enclosed():
    casters = casters_of([ball((0, 0, 0)), ball((0.5, 0, 0)), sheet((-3, -3), (3, 3), 0.2)])
    for point, times in (((0.3, 0, 0), 2), ((-0.8, 0, 0), 1), ((0, 0, 3), 0)):
        assert winding_number(casters, np.array(point, float)) == pytest.approx(times, abs=1e-9)


def test_more_nodes_than_memory_holds(monkeypatch):
    """Strictly, a sheet askew to the light takes as many values as pixels."""
    monkeypatch.setattr("foveal.shadows.construct.MOST_NODES", 1 << 19)
    roof = sheet((-1, -1), (1, 1), 0.0)
    light = Directional((0.3, 0.2, -1))
    assert build(roof, light, resolution=1 << 11).trees
    for more in (0, 2):
        with pytest.raises(FovealError, match="lower resolution"):
            build(roof, light, resolution=1 << (11 + more), exits="strict")
