"""Checking: a sound file passes, each kind of damage is found and named, deep bounds hold."""

import json

import numpy as np
import pytest

from foveal import multires
from foveal.base.errors import FovealError
from foveal.container import create, open_container
from foveal.mesh.shapes import bumpy_sphere
from foveal.multires import graph_chunk

MESH = bumpy_sphere(4, seed=1)


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("check") / "ball.fov"
    multires.build(MESH, path, cell_triangles=512)
    return path


def written_again(path, to, *, change_header=None, change_graph=None):
    """The same file with another header or graph and all checksums right."""
    with open_container(path) as old, create(to, kind="multires", version=1) as new:
        header = json.loads(json.dumps(old.header))
        graph, tables = graph_chunk.unpack(old.chunk(0), header["nodes"], header["patches"], name="it")
        if change_graph is not None:
            change_graph(graph)
        if change_header is not None:
            change_header(header)
        for number in range(1, len(old)):
            new.add_chunk(old.chunk(number))
        kept = {k: v for k, v in header.items() if k not in ("kind", "version", "first_bytes")}
        new.finish(kept, graph_chunk.pack(graph, bytes(tables)))


def halve_an_error(graph):
    inner = np.unique(graph.owner[graph.finer >= 0])
    graph.errors[inner[-1]] = graph.errors[1:].min() / 2


def shrink_a_sphere(graph):
    graph.radii[len(graph.radii) // 2] /= 4


def lose_a_node(graph):
    graph.finer[graph.finer == graph.finer.max()] = graph.finer.max() - 1


def miscount(header):
    header["triangles"] += 1


def narrow_the_box(header):
    header["box"][1][0] -= 10


def test_a_sound_file_passes(path):
    report = multires.check(path, deep=True, original=MESH)
    assert report.is_closed
    assert report.cuts == 8
    assert report.triangles > len(MESH.faces)
    assert min(report.looseness) >= 1
    assert max(report.looseness) < 4


def test_without_the_original_the_finest_level_stands_in(path):
    assert len(multires.check(path, deep=True).looseness) >= 4


def test_writing_again_alone_does_no_harm(path, tmp_path):
    written_again(path, tmp_path / "same.fov")
    assert multires.check(tmp_path / "same.fov").is_closed


@pytest.mark.parametrize("place", [0.3, 0.6, 0.99])
def test_a_flipped_bit_is_found(path, place, tmp_path):
    data = bytearray(path.read_bytes())
    data[int(place * len(data))] ^= 16
    (tmp_path / "flipped.fov").write_bytes(data)
    with pytest.raises(FovealError, match=r"flipped\.fov"):
        multires.check(tmp_path / "flipped.fov")


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"change_graph": halve_an_error}, "smaller error than one below"),
        ({"change_graph": shrink_a_sphere}, "sphere"),
        ({"change_graph": lose_a_node}, "no patch leads to|refines|graph"),
        ({"change_header": miscount}, "as many triangles as the header"),
        ({"change_header": narrow_the_box}, "leaves the box"),
    ],
)
def test_each_kind_of_damage_is_named(path, change, sentence, tmp_path):
    with pytest.raises(FovealError, match=sentence):
        written_again(path, tmp_path / "bad.fov", **change)
        multires.check(tmp_path / "bad.fov")


def test_an_error_that_is_too_small_a_promise_is_found_by_depth(path, tmp_path):
    def promise_more(graph):
        graph.errors[1:] /= 20

    written_again(path, tmp_path / "bold.fov", change_graph=promise_more)
    multires.check(tmp_path / "bold.fov")
    with pytest.raises(FovealError, match="from the original"):
        multires.check(tmp_path / "bold.fov", deep=True, original=MESH)
