"""Where the sun stands: published figures, and what symmetry asks for."""

import math
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from foveal import FovealError
from foveal.shadows import Sun, SunPath
from foveal.shadows.sun import elevation, ground_axes, moment, refraction, sun_on_the_ground

TIMES = st.datetimes(datetime(1950, 1, 1), datetime(2050, 1, 1), timezones=st.just(UTC))
LATITUDES = st.floats(-90, 90)
LONGITUDES = st.floats(-180, 180)


def azimuth(direction):
    return math.degrees(math.atan2(direction[0], direction[1])) % 360


def test_the_example_of_nrel():
    """Reda, Andreas: Solar Position Algorithm for Solar Radiation Applications, NREL 2008, table A5.1.

    There the air is of 820 hPa and 11 °C; 50.12795 is the zenith angle without any.
    """
    time = datetime.fromisoformat("2003-10-17T12:30:30-07:00")
    direction = sun_on_the_ground(time, 39.742476, -105.1786, has_air=False)
    assert 90 - elevation(direction) == pytest.approx(50.12795, abs=0.01)
    assert azimuth(direction) == pytest.approx(194.34024, abs=0.01)
    thinner = refraction(elevation(direction)) * 820 / 1010 * 283 / 284
    assert 90 - elevation(direction) - thinner == pytest.approx(50.11162, abs=0.01)
    lifted = sun_on_the_ground(time, 39.742476, -105.1786)
    assert elevation(lifted) - elevation(direction) == pytest.approx(
        refraction(elevation(direction)), abs=1e-6
    )
    assert azimuth(lifted) == pytest.approx(azimuth(direction), abs=1e-9)


@pytest.mark.parametrize(
    ("time", "declination"),
    [
        ("2000-06-21T01:48", 23.44),  # the solstices and equinoxes of 2000, Meeus table 27.E
        ("2000-12-21T13:37", -23.44),
        ("2000-03-20T07:35", 0.0),
        ("2000-09-22T17:28", 0.0),
    ],
)
def test_at_the_pole_the_height_is_the_declination(time, declination):
    height = elevation(sun_on_the_ground(moment(time), 90.0, 0.0, has_air=False))
    assert height == pytest.approx(declination, abs=0.01)


@given(TIMES, LATITUDES, LONGITUDES)
def test_a_turn_of_the_earth_is_a_turn_of_the_place(time, latitude, longitude):
    """As seen at one moment, from the other side of the Earth all is the other way round, parallax apart."""
    here = sun_on_the_ground(time, latitude, longitude, has_air=False)
    there = sun_on_the_ground(time, -latitude, longitude + 180, has_air=False)
    east, north, up = there
    np.testing.assert_allclose(here, [-east, north, -up], atol=1e-4)
    assert np.linalg.norm(here) == pytest.approx(1, abs=1e-12)


@given(TIMES, LATITUDES, LONGITUDES)
def test_air_lifts_and_turns_nothing(time, latitude, longitude):
    bare = sun_on_the_ground(time, latitude, longitude, has_air=False)
    seen = sun_on_the_ground(time, latitude, longitude)
    assert np.linalg.norm(seen) == pytest.approx(1, abs=1e-12)
    assert -1e-9 <= elevation(seen) - elevation(bare) <= 1.0
    np.testing.assert_allclose(np.cross([*bare[:2], 0], [*seen[:2], 0]), 0, atol=1e-12)


@settings(max_examples=25)
@given(TIMES, st.floats(-66, 66), LONGITUDES)
def test_a_day_is_alike_before_and_after_noon(time, latitude, longitude):
    """Around the moment of greatest height, heights agree as far as the declination stays as it is."""
    day = [time + timedelta(minutes=2 * i) for i in range(740)]
    heights = [elevation(sun_on_the_ground(t, latitude, longitude, has_air=False)) for t in day]
    is_top = np.diff(np.sign(np.diff(heights))) < 0
    noon = next(t for t, top in zip(day[1:], is_top, strict=False) if top)
    for hours in (1, 3, 5):
        before = sun_on_the_ground(noon - timedelta(hours=hours), latitude, longitude, has_air=False)
        after = sun_on_the_ground(noon + timedelta(hours=hours), latitude, longitude, has_air=False)
        assert elevation(before) == pytest.approx(elevation(after), abs=0.7)
        assert before[0] == pytest.approx(-after[0], abs=0.02)
        assert before[0] > 0  # in the morning it is in the east


@given(st.sampled_from("xyz"), st.none() | st.floats(-360, 360))
def test_ground_axes_are_right_handed(up, north):
    axes = ground_axes(up, north)
    np.testing.assert_allclose(axes.T @ axes, np.eye(3), atol=1e-12)
    assert np.linalg.det(axes) == pytest.approx(1)
    assert (axes[:, 2] == np.eye(3)["xyz".index(up)]).all()


def test_north_by_name_and_by_degrees():
    np.testing.assert_array_equal(ground_axes("z"), np.eye(3))
    assert ground_axes("z", "-x")[:, 1].tolist() == [-1, 0, 0]
    assert ground_axes("y", "+Z")[:, 1].tolist() == [0, 0, 1]
    np.testing.assert_allclose(
        ground_axes("z", 90), ground_axes("z", "x"), atol=1e-12
    )  # clockwise: to the east
    np.testing.assert_allclose(ground_axes("z", "-90"), ground_axes("z", "-x"), atol=1e-12)


@pytest.mark.parametrize(
    ("up", "north", "sentence"),
    [
        ("w", None, "up must be"),
        ("y", "y", "cannot be the axis that points up"),
        ("y", "-y", "cannot be the axis"),
        ("y", "w", "neither an axis"),
        ("y", math.nan, "neither an axis"),
        ("y", 361.0, "up to 360"),
    ],
)
def test_axes_that_are_none(up, north, sentence):
    with pytest.raises(FovealError, match=sentence):
        ground_axes(up, north)


def test_times():
    assert moment("2026-06-21T15:00Z") == moment("2026-06-21T17:00+02:00") == moment("2026-06-21 15:00")
    for time in ("noon", "2026-13-01", ""):
        with pytest.raises(FovealError, match="not a time"):
            moment(time)
    with pytest.raises(FovealError, match="beyond the years"):
        moment("0001-01-01T00:00+10:00")


def test_the_sun_goes_by_the_ground_of_the_model():
    """The same sun, whatever axes a model has."""
    where = "2026-06-21T15:00+02:00", 43.72, 10.40
    as_on_maps = Sun(*where, up="z").towards([[0, 0, 0]])[0]
    assert as_on_maps[0] < 0  # afternoon: in the west
    assert as_on_maps[1] < 0  # and in the south
    for up, north in (("y", None), ("x", "-y"), ("z", "30")):
        axes = ground_axes(up, north)
        np.testing.assert_allclose(
            Sun(*where, up, north).towards([[0, 0, 0]])[0], axes @ as_on_maps, atol=1e-12
        )


def test_a_night_is_told():
    with pytest.raises(FovealError, match=r"degrees below the horizon"):
        Sun("2026-06-21T02:00+02:00", 43.72, 10.40)
    with pytest.raises(FovealError, match="no place"):
        Sun("2026-06-21T12:00", 91, 0)
    with pytest.raises(FovealError, match="no place"):
        Sun("2026-06-21T12:00", 0, math.nan)


def test_a_path_leaves_out_the_night_and_keeps_even_steps():
    path = SunPath("2026-12-21T00:00+01:00", "2026-12-21T23:30+01:00", 48, 43.72, 10.40)
    gaps = {b - a for a, b in zip(path.times, path.times[1:], strict=False)}
    assert gaps == {timedelta(minutes=30)}
    assert path.images + path.left_out == 48
    assert 17 <= path.images <= 18  # the shortest day there has 8.9 hours
    assert not path.directions[:, 1].max() > 0  # light falls
    with pytest.raises(FovealError, match="below the horizon"):
        SunPath("2026-12-21T00:00+01:00", "2026-12-21T04:00+01:00", 5, 43.72, 10.40)
    with pytest.raises(FovealError, match="not after its beginning"):
        SunPath("2026-12-21T12:00", "2026-12-21T12:00", 5, 43.72, 10.40)
    with pytest.raises(FovealError, match="steps"):
        SunPath("2026-12-21T10:00", "2026-12-21T12:00", 1, 43.72, 10.40)
