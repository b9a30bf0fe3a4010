"""The `.fov` of kind "shadow": what goes in comes out, level by level, and no byte that can do harm."""

import json
import struct
from types import SimpleNamespace

import numpy as np
import pytest

from foveal import FovealError
from foveal.container import open_container
from foveal.mesh.shapes import icosphere
from foveal.shadows import AreaLight, Directional, Point, build
from foveal.shadows.file import read_parts, read_shadow, write_shadow
from scene.damage import rewritten
from shadows import golden_trees
from shadows.random_trees import assert_same, random_tree

LIGHTS = {
    "directional": (Directional((0.2, -1, 0.1)), 64),
    "point": (Point((3, 0, 0)), 32),
    "area": (AreaLight(Directional((0.2, -1, 0.1)), radius=0.1, samples=4), 16),
}


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    """A tree of several parts in a file that is small."""
    path = tmp_path_factory.mktemp("shadows") / "small.fov"
    golden_trees.write("any", path)
    return path.read_bytes()


@pytest.mark.parametrize("name", LIGHTS)
def test_what_is_saved_is_read(tmp_path, name):
    light, resolution = LIGHTS[name]
    shadow = build(icosphere(2), light, resolution=resolution)
    shadow.save(tmp_path / "a.fov")
    found = read_shadow(tmp_path / "a.fov")
    assert type(found.light) is type(light)  # angles are in degrees there, so equal but for rounding
    assert len(found.trees) == len(shadow.trees)
    for tree, again in zip(shadow.trees, found.trees, strict=True):
        assert_same(again, tree)
    for projection, again in zip(shadow.projections, found.projections, strict=True):
        assert (again.matrix == projection.matrix).all()
    points = np.random.default_rng(2).uniform(-1.2, 1.2, (500, 3))
    assert (found.lookup(points) == shadow.lookup(points)).all()
    with open_container(tmp_path / "a.fov") as file:
        nodes = file.header["nodes"]
        assert file.header["images"] == shadow.images
    assert nodes["leaf"] + nodes["inner"] == sum(len(tree.values) for tree in shadow.trees)
    assert nodes["empty"] + nodes["inner"] == sum(len(tree.masks) for tree in shadow.trees)


@pytest.mark.parametrize("name", golden_trees.CASES)
def test_the_golden_files_are_read_and_written(tmp_path, name):
    path = golden_trees.FOLDER / f"shadow_tree_{name}.fov"
    with open_container(path) as file:
        assert golden_trees.expected(file) == json.loads(path.with_suffix(".json").read_text())
        found, wanted = read_shadow(file), golden_trees.CASES[name]()
    assert found.light == wanted[0]
    for tree, again in zip(wanted[2], found.trees, strict=True):
        assert_same(again, tree)
    golden_trees.write(name, tmp_path / "again.fov")
    with open_container(path) as old, open_container(tmp_path / "again.fov") as new:
        assert [old.chunk(i) for i in range(len(old))] == [new.chunk(i) for i in range(len(new))]
        unlike = {"generator": 0, "first_bytes": 0, "light": 0}  # lights may come to tell more
        assert {**old.header, **unlike} == {**new.header, **unlike}


def test_fewer_levels_are_read_of_fewer_chunks():
    path = golden_trees.FOLDER / "shadow_tree_six.fov"
    with open_container(path) as file:
        parts = file.header["parts"]
        assert len(parts) > 2
        asked = []
        chunk = file.chunk
        file.chunk = lambda number: asked.append(number) or chunk(number)
        for levels in range(5):
            asked.clear()
            trees = read_parts(file, levels=levels)[2]
            have = next(part for part in parts if part >= levels)
            assert [tree.levels for tree in trees] == [have] * 6
            assert sorted(asked) == list(range(1 + 6 * (parts.index(have) + 1)))
    assert read_shadow(path, levels=2).resolution < read_shadow(path).resolution


def test_a_stack_without_its_finest_levels_is_not_written(tmp_path):
    path = golden_trees.FOLDER / "shadow_tree_stack.fov"
    coarse = read_shadow(path, levels=2)
    assert coarse.trees[0].spread < 0
    with pytest.raises(FovealError, match="Read it whole"):
        coarse.save(tmp_path / "a.fov")
    read_shadow(path).save(tmp_path / "a.fov")


@pytest.mark.parametrize("spread", [-1, 2, 30, 0.5])
def test_images_that_have_no_place_are_refused(spread):
    data = (golden_trees.FOLDER / "shadow_tree_stack.fov").read_bytes()
    with pytest.raises(FovealError, match="spread"):
        read_shadow(rewritten(data, {"spread": spread}))


def test_the_bytes_are_those_of_the_spec(tmp_path):
    tree = random_tree(np.random.default_rng(1), 2, 4)
    light, matrices, _ = golden_trees.CASES["map"]()
    write_shadow(SimpleNamespace(light=light, projections=matrices, trees=(tree,)), tmp_path / "a.fov")
    with open_container(tmp_path / "a.fov") as file:
        assert (file.kind, file.version, len(file), file.header["parts"]) == ("shadow", 1, 2, [2])
        numbers = struct.unpack("<6I", file.chunk(0))
    assert numbers == (tree.root, *np.diff(tree.mask_starts), *np.diff(tree.value_starts))


def test_no_bit_can_be_another_and_no_prefix_is_read(small):
    with open_container(small) as file:
        padding = [at + length for at, length in zip(file.offsets, file.lengths, strict=True)]
    for at in range(len(small)):
        if at in (6, 7) or any(0 <= at - end < -end % 4 for end in padding):
            continue  # what is reserved is not looked at, and neither is padding
        flipped = bytearray(small)
        flipped[at] ^= 1 << at % 8
        with pytest.raises(FovealError):
            read_shadow(bytes(flipped))
    for end in range(0, len(small)):
        with pytest.raises(FovealError):
            read_shadow(small[:end])


@pytest.mark.parametrize(
    ("header", "says"),
    [
        ({"kind": "cage"}, "'shadow' is wanted"),
        ({"version": 2}, "version 2 is not known"),
        ({"levels": 25}, "levels"),
        ({"levels": 4}, "parts"),
        ({"levels": True}, "levels"),
        ({"children": 5}, "damaged"),
        ({"children": 8}, "damaged"),
        ({"children": ...}, "children"),
        ({"parts": []}, "parts"),
        ({"parts": [5]}, "lengths"),
        ({"parts": [3, 3, 5]}, "parts"),
        ({"parts": [-1, 5]}, "parts"),
        ({"parts": [1.0, 5]}, "parts"),
        ({"projections": []}, "projections"),
        ({"projections": [[1, 2], [3]]}, "projections"),
        ({"projections": [[[0] * 4] * 4] * 2}, "lengths"),
        ({"projections": [[[1e999] * 4] * 4]}, "projections"),
        ({"projections": [[["a"] * 4] * 4]}, "projections"),
        ({"light": ...}, "light"),
        ({"light": {"kind": "candle"}}, "candle"),
    ],
)
def test_headers_that_make_no_sense_are_refused(small, header, says):
    with pytest.raises(FovealError, match=says):
        read_shadow(rewritten(small, header))


def test_counts_that_are_wrong_are_refused(small):
    with open_container(small) as file:
        first = file.chunk(0)
    for at in range(0, len(first), 4):
        for value in (0, 7, 1 << 20, (1 << 32) - 1):
            changed = first[:at] + struct.pack("<I", value) + first[at + 4 :]
            if changed != first:
                with pytest.raises(FovealError, match="damaged"):
                    read_shadow(rewritten(small, first=changed))
    with pytest.raises(FovealError, match="lengths"):
        read_shadow(rewritten(small, first=first[:-4]))


def test_trees_that_do_not_fit_each_other_are_not_written(tmp_path):
    light, matrices, trees = golden_trees.CASES["six"]()
    other = golden_trees.CASES["map"]()[2]
    for wrong in (trees[:5], (*trees[:5], *other)):
        with pytest.raises(ValueError):
            write_shadow(SimpleNamespace(light=light, projections=matrices, trees=wrong), tmp_path / "a.fov")
    assert not (tmp_path / "a.fov").exists()
