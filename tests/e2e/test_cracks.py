"""No crack at any cut: in no picture does the background show through a border of patches."""

import numpy as np
import pytest
from scipy import ndimage

from e2e.page import build, idle, picture, scene_of, stats
from foveal import multires
from foveal.mesh.shapes import bumpy_sphere
from foveal.mesh.trimesh import TriMesh

MAGENTA = "#ff00ff"
VIEWS = 24


def shell():
    """Two thirds of a ball with bumps: open at the back, so that behind a crack there is background."""
    ball = bumpy_sphere(5)
    is_front = ball.positions[ball.faces].mean(axis=1)[:, 2] > -0.2
    return TriMesh.of(ball.positions, ball.faces[is_front])


@pytest.fixture(scope="module")
def shell_file(tmp_path_factory):
    return build(shell(), tmp_path_factory.mktemp("shell") / "shell.fov")


def border_points(path):
    """Places that patches of one node share, off the rim: whatever the cut, patches meet there or near by."""
    with multires.open(path) as asset:
        nodes = [asset.node_patches(node) for node in range(1, min(6, len(asset.graph.errors)))]
        found = []
        for patches in nodes:
            each = [np.unique(patch.positions, axis=0) for patch in patches]
            points, counts = np.unique(np.concatenate(each), axis=0, return_counts=True)
            found.append(points[counts > 1])
        points = asset.origin + asset.step * np.concatenate(found)
    return points[points[:, 2] > 0.2]


def holes(pixels):
    """How many pixels of background are not connected with the picture's edge."""
    is_behind = (pixels[..., 0] > 200) & (pixels[..., 1] < 60) & (pixels[..., 2] > 200)
    parts, count = ndimage.label(is_behind, structure=np.ones((3, 3)))
    rim = np.concatenate([parts[0], parts[-1], parts[:, 0], parts[:, -1]])
    outside = np.isin(parts, rim[rim > 0])
    return int((is_behind & ~outside).sum()) if count else 0


def test_holes_are_counted():
    pixels = np.zeros((9, 9, 3), np.uint8)
    pixels[:, :3] = pixels[5, 5] = pixels[6, 6:8] = (255, 0, 255)
    assert holes(pixels) == 3


def test_the_background_shows_through_no_border(open_page, site, shell_file):
    """From afar to a five thousandth of the radius, where the last bit of a matrix is pixels wide."""
    site.files["data/shell.fov"] = shell_file
    site.files["scene.json"] = scene_of("data/shell.fov", background=MAGENTA)
    page = open_page("#v=1&i=0", reduced_motion="reduce")
    rng = np.random.default_rng(1)
    points = border_points(shell_file)
    most = 0
    for view in range(VIEWS):
        point = points[rng.integers(len(points))]
        outwards = point / np.linalg.norm(point) + 0.3 * rng.normal(size=3)
        away = 10 ** (rng.uniform(-3, 0.5) if view % 3 == 0 else rng.uniform(-4.5, -3))
        camera = {"position": (point + outwards * away).tolist(), "target": point.tolist()}
        budget = int(rng.choice([3000, 8000, 20000]))
        page.evaluate("triangles => foveal.setBudgets({ triangles })", budget)
        page.evaluate(
            "camera => foveal.setCamera(camera)", camera | {"up": [0, 1, 0], "fieldOfViewDegrees": 60}
        )
        idle(page)
        most = max(most, stats(page)["patches"])
        seen = picture(page)
        assert holes(seen) == 0, f"view {view}, {away:.2g} from {point}, {budget} triangles"
    assert most > 5
