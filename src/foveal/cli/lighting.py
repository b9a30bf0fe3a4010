"""The options that say which light shines, and the light that they make."""

import math
import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from foveal.base.progress import Progress

from .options import Up, UpAxis

if TYPE_CHECKING:
    from foveal.shadows import AreaLight, Directional, Light, Spot, Sun, SunPath

__all__ = ["Lighting", "lighting", "numbers"]

_KINDS = ("--sun", "--direction", "--spot", "--point")
_NEEDS = {
    "--at": ("--sun",),
    "--north": ("--sun",),
    "--up": ("--sun",),
    "--sun-path": ("--sun",),
    "--steps": ("--sun-path",),
    "--target": ("--spot",),
    "--angle": ("--spot",),
    "--area-light": ("--sun", "--direction", "--spot"),
    "--samples": ("--area-light",),
    "--jitter": ("--area-light",),
    "--seed": ("--jitter",),
}
"""What each option says more of."""
_ANGLE = 60.0
_SAMPLES = 64
_STEPS = 32


def numbers(option: str, text: str, count: int, example: str, /) -> tuple[float, ...]:
    """Numbers with commas between them.

    Examples
    --------
    >>> numbers("--point", "1, -2.5,3e2", 3, "0,0,5")
    (1.0, -2.5, 300.0)
    """
    try:
        found = tuple(float(word) for word in text.split(","))
    except ValueError:
        found = ()
    if len(found) != count or not all(map(math.isfinite, found)):
        raise typer.BadParameter(
            f"{text!r:.60} is not {count} numbers with commas between; write for instance {example}.",
            param_hint=option,
        )
    return found


@dataclass(frozen=True, slots=True)
class Lighting:
    """What was said of the light, by option; what was not said is not in it."""

    said: dict[str, Any]

    def light(self, source: Path, progress: Progress, /) -> "Light":
        """The light, of whose sun the source may say which axis points up.

        Raises
        ------
        typer.BadParameter
            If a text is not as it should be.
        FovealError
            If there is no such light.
        """
        from foveal.shadows import Point

        if "--point" in self.said:
            return Point(self._vector("--point"))
        base = self._sun(source, progress) if "--sun" in self.said else self._straight()
        return base if "--area-light" not in self.said else self._area(base)

    def _vector(self, option: str) -> tuple[float, float, float]:
        x, y, z = numbers(option, self.said[option], 3, "0,0,5")
        return x, y, z

    def _straight(self) -> "Directional | Spot":
        from foveal.shadows import Directional, Spot

        if "--direction" in self.said:
            return Directional(self._vector("--direction"))
        angle = math.radians(self.said.get("--angle", _ANGLE))
        return Spot(self._vector("--spot"), self._vector("--target"), angle)

    def _sun(self, source: Path, progress: Progress) -> "Sun | SunPath":
        from foveal.scene.shadow import up_of_source
        from foveal.shadows import Sun, SunPath
        from foveal.shadows.sun import has_offset, moment

        text = self.said["--sun"]
        time = moment(text)
        if not has_offset(text):
            progress.note(f"{text}: taken as UTC, since it tells no offset such as +02:00.")
        latitude, longitude = numbers("--at", self.said["--at"], 2, "43.72,10.40")
        up: UpAxis | None = self.said.get("--up")
        place = latitude, longitude, up.value if up else up_of_source(source), self.said.get("--north")
        if "--sun-path" not in self.said:
            return Sun(time, *place)
        first, last = _times(self.said["--sun-path"])
        begin, end = (time.replace(hour=h, minute=m, second=0, microsecond=0) for h, m in (first, last))
        return SunPath(begin, end, self.said.get("--steps", _STEPS), *place)

    def _area(self, base: "Sun | SunPath | Directional | Spot") -> "AreaLight":
        from foveal.shadows import AreaLight, Spot, SunPath

        assert not isinstance(base, SunPath)
        text = self.said["--area-light"].lower().replace("×", "x")
        scale = 1.0 if isinstance(base, Spot) else math.radians(1)
        extents = [length * scale for length in _extents(text)]
        return AreaLight(
            base,
            extents[0] if len(extents) == 1 else None,
            (extents[0], extents[1]) if len(extents) == 2 else None,
            self.said.get("--samples", _SAMPLES),
            self.said.get("--jitter", False),
            self.said.get("--seed", 0),
        )


def _extents(text: str) -> tuple[float, ...]:
    count = text.count("x") + 1
    if count > 2:
        raise typer.BadParameter(
            f"{text!r:.60} is neither a radius nor a width and height; write 0.3 or 0.6x0.2.",
            param_hint="--area-light",
        )
    return numbers("--area-light", text.replace("x", ","), count, "0.3 or 0.6x0.2")


def _times(text: str) -> tuple[tuple[int, int], tuple[int, int]]:
    """Hours and minutes, from and to.

    Examples
    --------
    >>> _times("08:00..18:30")
    ((8, 0), (18, 30))
    """
    match = re.fullmatch(r"\s*(\d{1,2}):(\d{2})\s*(?:\.\.|…)\s*(\d{1,2}):(\d{2})\s*", text)
    found = [int(number) for number in match.groups()] if match else []
    if not found or max(found[0], found[2]) > 23 or max(found[1], found[3]) > 59:
        raise typer.BadParameter(
            f"{text!r:.60} is not a time from and a time to; write for instance 08:00..18:00.",
            param_hint="--sun-path",
        )
    return (found[0], found[1]), (found[2], found[3])


def lighting(
    sun: Annotated[
        str | None,
        typer.Option(
            metavar="TIME",
            help="Sunlight of a time, e.g. 2026-06-21T15:00+02:00; without an offset it is UTC. Needs --at.",
        ),
    ] = None,
    at: Annotated[
        str | None,
        typer.Option(metavar="LAT,LON", help="Where the sun is seen from, in degrees, e.g. 43.72,10.40."),
    ] = None,
    up: Up = None,
    north: Annotated[
        str | None,
        typer.Option(
            metavar="AXIS",
            help="Axis that points north, such as y or -z, or degrees that north is turned clockwise from "
            "-z (up y), y (up z) or z (up x).",
        ),
    ] = None,
    sun_path: Annotated[
        str | None,
        typer.Option(
            metavar="FROM..TO",
            help="The sun from a time of that day to another, e.g. 08:00..18:00: a stack of maps.",
        ),
    ] = None,
    steps: Annotated[
        int | None,
        typer.Option(
            min=2,
            max=4096,
            metavar="N",
            help="Times of the path, 32 by default. More is smoother, and larger.",
        ),
    ] = None,
    direction: Annotated[
        str | None, typer.Option(metavar="X,Y,Z", help="Parallel light that travels this way.")
    ] = None,
    spot: Annotated[
        str | None, typer.Option(metavar="X,Y,Z", help="A spot light here. Needs --target.")
    ] = None,
    target: Annotated[str | None, typer.Option(metavar="X,Y,Z", help="What it shines at.")] = None,
    angle: Annotated[
        float | None,
        typer.Option(
            metavar="DEGREES", help="Of its whole cone, 60 by default. Smaller gives finer shadows."
        ),
    ] = None,
    point: Annotated[
        str | None, typer.Option(metavar="X,Y,Z", help="A light here that shines all around: six maps.")
    ] = None,
    area_light: Annotated[
        str | None,
        typer.Option(
            metavar="RADIUS|WxH",
            help="The light has a surface, a disc or a rectangle, in the file's unit; of --sun and "
            "--direction in degrees (the sun's radius is 0.27). Soft shadows: a stack of maps.",
        ),
    ] = None,
    samples: Annotated[
        int | None,
        typer.Option(
            metavar="N", help="Maps over that surface: 4, 16, 64 (the default), 256, ... More is softer."
        ),
    ] = None,
    jitter: Annotated[
        bool, typer.Option("--jitter", help="Samples at random within their cells: noise in place of steps.")
    ] = False,
    seed: Annotated[
        int | None, typer.Option(min=0, metavar="N", help="By which random numbers; 0 by default.")
    ] = None,
) -> Lighting:
    """Which light shines, by one of `--sun`, `--direction`, `--spot`, `--point` and what goes with it."""
    given = {
        **{"--sun": sun, "--at": at, "--up": up, "--north": north, "--sun-path": sun_path},
        **{"--steps": steps, "--direction": direction, "--spot": spot, "--target": target, "--angle": angle},
        **{"--point": point, "--area-light": area_light, "--samples": samples, "--jitter": jitter or None},
        "--seed": seed,
    }
    said = {option: value for option, value in given.items() if value is not None}
    _refuse_mixture(said)
    return Lighting(said)


def _refuse_mixture(said: dict[str, Any]) -> None:
    """Exactly one kind of light, and with it only what says more of it."""
    kinds = [option for option in _KINDS if option in said]
    if len(kinds) != 1:
        got = " and ".join(kinds) or "none"
        raise typer.BadParameter(
            f"one light is needed, {', '.join(_KINDS[:-1])} or {_KINDS[-1]}; got {got}.",
            param_hint=" / ".join(_KINDS),
        )
    for option, needed in _NEEDS.items():
        if option in said and not said.keys() & {*needed}:
            raise typer.BadParameter(f"it goes with {' or '.join(needed)} only.", param_hint=option)
    for option, needs in (("--sun", "--at"), ("--spot", "--target")):
        if option in said and needs not in said:
            raise typer.BadParameter(f"it needs {needs}, too.", param_hint=option)
    if "--sun-path" in said and "--area-light" in said:
        raise typer.BadParameter("it cannot go with --sun-path. Leave one out.", param_hint="--area-light")
