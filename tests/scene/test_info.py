"""What `info` tells of a file made by hand."""

import json

import pytest

from foveal import FovealError
from foveal.scene import scene_of, write_scene
from foveal.scene.info import info


def test_a_fov_is_told_by_its_numbers(fov):
    facts = info(fov)
    assert facts["kind"] == "multires"
    assert (facts["triangles"], facts["vertices"], facts["nodes"], facts["patches"]) == (110, 62, 3, 4)
    assert facts["box"] == [[100.0, 0.0, 0.0], [102.0, 4.0, 1.0]]
    assert facts["attributes"] == ["position", "colour"]
    assert facts["bytes"] == fov.stat().st_size
    assert facts["bits_per_vertex"] == pytest.approx(8 * facts["bytes"] / 62, abs=1e-3)
    assert facts["overhead_bytes"] == facts["bytes"] - 27
    table = [
        (r["level"], r["nodes"], r["patches"], r["triangles"], r["error"], r["bytes"])
        for r in facts["level_table"]
    ]
    assert table == [
        (0, 1, 2, 30, 0.5, 11),
        (1, 1, 1, 60, pytest.approx(0.433, abs=1e-3), 7),
        (2, 1, 1, 110, pytest.approx(0.5 * 0.75**0.5), 9),
    ]
    json.dumps(facts, allow_nan=False)


def test_a_scene_tells_its_layers(fov, tmp_path):
    write_scene(scene_of(fov), tmp_path / "scene.json")
    facts = info(tmp_path / "scene.json")
    assert (facts["kind"], facts["title"]) == ("scene", "statue")
    assert facts["layers"][0]["triangles"] == 110
    json.dumps(facts, allow_nan=False)


@pytest.mark.parametrize(
    "change", [{"nodes": 2}, {"patches": 9}, {"nodes": -1}, {"patches": "4"}, {"nodes": 10**9}]
)
def test_a_header_that_does_not_agree_with_the_graph_is_said(tmp_path, make_fov, change):
    with pytest.raises(FovealError, match=r"damaged|agree"):
        info(make_fov(tmp_path / "odd.fov", **change))


@pytest.mark.parametrize("key", ["origin", "box", "step", "streams", "triangles", "codec", "nodes"])
def test_a_header_without_a_key_is_said(tmp_path, make_fov, key):
    with pytest.raises(FovealError, match=key):
        info(make_fov(tmp_path / "odd.fov", **{key: None}))


def test_what_is_not_there_is_said(tmp_path):
    with pytest.raises(FovealError, match="no such file"):
        info(tmp_path / "none.fov")
    with pytest.raises(FovealError, match="folder"):
        info(tmp_path)
    (tmp_path / "text.fov").write_text("hello")
    with pytest.raises(FovealError, match=r"not a \.fov"):
        info(tmp_path / "text.fov")
