"""Extraction: what is found is what looking at every face would find."""

import numpy as np
import pytest

from foveal.refine import _kernels_extract as kernels
from foveal.refine.cage import Cage
from foveal.refine.criteria import view_of
from foveal.refine.extract import front_faces, frustum_faces, silhouette_faces
from foveal.view.camera import Camera
from refine import naive_filter as naive
from refine.surfaces import SURFACES, around


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("name", SURFACES)
def test_each_search_is_what_looking_at_every_face_finds(name, seed):
    cage = Cage.of(SURFACES[name]())
    p, faces = cage.positions, cage.faces
    rng = np.random.default_rng(seed)
    camera = around(cage, rng.uniform(0, 6), rng.uniform(-1, 1), rng.choice([0.2, 0.6, 1.0]))
    seen = frustum_faces(p, faces, camera)
    assert seen.tolist() == [i for i, f in enumerate(faces) if naive.in_frustum(p, f, camera)[0]]
    front = front_faces(p, faces, camera, among=seen)
    assert front.tolist() == [i for i in seen if naive.is_front(p, faces[i], camera)]
    strip = silhouette_faces(p, faces, cage.beside, camera, among=front)
    assert len(set(strip.tolist())) == len(strip)
    assert set(strip.tolist()) == naive.silhouette(p, faces.tolist(), front, camera)
    everything = silhouette_faces(p, faces, cage.beside, camera)
    assert set(everything.tolist()) == naive.silhouette(p, faces.tolist(), range(len(faces)), camera)


def test_what_is_searched_is_left_as_it_was():
    cage = Cage.of(SURFACES["icosphere"]())
    among = np.arange(len(cage.faces), dtype=np.int32)
    frustum_faces(cage.positions, cage.faces, Camera.of([0, 0, 3], [9, 0, 0]), among=among)
    assert (among == np.arange(len(cage.faces))).all()


def test_a_face_that_fills_the_view_is_seen_though_none_of_its_corners_is():
    cage = Cage.of(SURFACES["single_triangle"]())
    camera = Camera.of([0.3, 0.3, 0.01], [0.3, 0.3, 0])
    assert frustum_faces(cage.positions, cage.faces, camera).tolist() == [0]


def test_where_no_face_turns_away_there_is_no_silhouette():
    cage = Cage.of(SURFACES["terrain"]())
    assert (
        len(
            silhouette_faces(cage.positions, cage.faces, cage.beside, Camera.of([0.5, 0.4, 9], [0.5, 0.5, 0]))
        )
        == 0
    )


def test_what_is_inherited_is_not_tested_again():
    cage = Cage.of(SURFACES["icosphere"]())
    p, faces = cage.positions, cage.faces
    view = view_of(Camera.of([0, 0, 3], [0, 0, 9]))  # it looks away: nothing is in its frustum
    flags = np.zeros(len(faces), np.uint8)
    flags[3], flags[5] = kernels.INSIDE, kernels.KNOWN
    among = np.arange(len(faces), dtype=np.int32)
    assert among[: kernels.keep_inside(p, faces, flags, view, among)].tolist() == [3]
    flags[:] = kernels.KNOWN
    kernels.face_the_eye(p, faces, flags, view, np.arange(len(faces), dtype=np.int32))
    assert not (flags & kernels.FRONT).any()
