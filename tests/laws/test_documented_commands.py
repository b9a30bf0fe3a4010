"""What the documentation tells people to type exists, and what exists is told."""

import re
import shlex
from pathlib import Path

import pytest
import typer

from foveal.cli.app import app

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
COMMANDS = typer.main.get_command(app).commands


def documented() -> list[tuple[str, str]]:
    found = []
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        lines = [
            line for block in re.findall(r"```(?:\w*)\n(.*?)```", text, re.S) for line in block.splitlines()
        ]
        lines += re.findall(r"`(foveal [^`]+)`", text)
        found += [(page.name, line.strip()) for line in lines if line.strip().startswith("foveal ")]
    return found


@pytest.mark.parametrize(("page", "line"), documented())
def test_a_documented_command_exists_with_its_options(page, line):
    words = shlex.split(line, comments=True)[1:]
    if words[0] in ("--help", "--version") or "." in words[0]:
        return
    assert words[0] in COMMANDS, f"{page}: {line}"
    known = {name for parameter in COMMANDS[words[0]].params for name in parameter.opts} | {"--help", "-h"}
    for word in words[1:]:
        if word.startswith("-"):
            assert word.partition("=")[0] in known, f"{page}: {line}: there is no {word}"


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_is_in_the_readme(name):
    assert f"foveal {name} " in PAGES[0].read_text(encoding="utf-8")


@pytest.mark.parametrize("name", COMMANDS)
def test_every_option_says_what_it_does(name):
    for parameter in COMMANDS[name].params:
        assert getattr(parameter, "help", None), f"{name}: {parameter.opts} is not explained"


@pytest.mark.parametrize("name", COMMANDS)
def test_every_option_is_tried_by_a_test(name):
    tried = "".join(
        path.read_text(encoding="utf-8") for path in sorted((ROOT / "tests" / "cli").glob("*.py"))
    )
    for parameter in COMMANDS[name].params:
        is_tried = any(f'"{option}"' in tried for option in parameter.opts)
        assert is_tried or not parameter.opts[0].startswith("-"), f"{name}: {parameter.opts} is never tried"


def test_the_options_that_the_guide_tells_exist():
    guide = (ROOT / "docs" / "guide.md").read_text(encoding="utf-8")
    known = {name for command in COMMANDS.values() for parameter in command.params for name in parameter.opts}
    for option in re.findall(r"`(--[a-z-]+)", guide):
        assert option in known, f"the guide tells of {option}"
