"""Words and constructs that the house does without."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PYTHON = sorted(
    path for folder in ("src", "tests", "examples", "benchmarks") for path in (ROOT / folder).rglob("*.py")
)
TEXT = [
    *PYTHON,
    *sorted(ROOT.glob("*.md")),
    *sorted((ROOT / "docs").rglob("*.md")),
    *sorted((ROOT / "spec").rglob("*.md")),
]
BANNED = {
    r"\b(colou?r)(?<=color)(s|ed|ing)?\b": "colour",
    r"\bneighbor": "neighbour",
    r"\bquantiz": "quantise",
    r"\bserializ": "serialise",
    r"\b(TODO|FIXME|XXX|HACK)\b": "an issue, or the work itself",
    r"(?<![\w./])/(home|root|Users)/\w": "a path of no machine in particular",
    r"\butils?\.py\b": "a file named for what is in it",
}
# Names that others gave: formats, libraries, protocols.
FOREIGN = re.compile(
    r"""["'`]?(?:\.color\b|\w*_color\w*|\w*Color\w*|COLOR_\d|color(?:ama|s?["'`(=])|vertex_colors|face_colors|baseColor\w*|color-scheme|quantization_\w+)"""
)


def is_spared(path: Path) -> bool:
    return path == Path(__file__) or path.name in ("STYLE.md",)


@pytest.mark.parametrize("path", TEXT, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_words(path):
    if is_spared(path):
        return
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        text = FOREIGN.sub("", line)
        for pattern, better in BANNED.items():
            found = re.search(pattern, text)
            assert found is None, f"{path.name}:{number}: {found[0]!r}; say {better}"


@pytest.mark.parametrize(
    "path",
    [path for path in PYTHON if path.is_relative_to(ROOT / "src")],
    ids=lambda p: p.relative_to(ROOT).as_posix(),
)
def test_constructs(path):
    text = path.read_text(encoding="utf-8")
    name = path.relative_to(ROOT / "src" / "foveal").as_posix()
    assert path.stem not in ("utils", "util", "helpers", "common", "misc")
    assert not re.search(r"^from \S+ import \*", text, re.M), "no star imports"
    assert not re.search(r"^\s*except:", text, re.M), "no bare except"
    if not name.startswith("cli/"):
        assert not re.search(r"^\s*print\(", text, re.M), "only the command line prints"
    assert not re.search(r"https?://(?!127\.0\.0\.1|localhost|\{)", re.sub(r"https?://\.\.\.", "", text)), (
        "no foreign host"
    )
