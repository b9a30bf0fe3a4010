"""Outputs appear whole or not at all, and nothing is left lying about."""

import os
import subprocess
import sys
import time

import pytest

from foveal.base.errors import FovealError
from foveal.base.files import refuse_unwritable, scratch, whole_file, whole_folder


def names(folder):
    return sorted(entry.name for entry in folder.iterdir())


def test_a_file_appears_when_its_block_ends(tmp_path):
    path = tmp_path / "deep" / "a.bin"
    with whole_file(path) as stream:
        stream.write(b"abc")
        assert not path.exists()
    assert path.read_bytes() == b"abc"
    assert names(path.parent) == ["a.bin"]


def test_a_block_that_fails_leaves_the_old_file(tmp_path):
    path = tmp_path / "a.bin"
    path.write_bytes(b"old")
    with pytest.raises(KeyboardInterrupt), whole_file(path) as stream:
        stream.write(b"new")
        raise KeyboardInterrupt
    assert path.read_bytes() == b"old"
    assert names(tmp_path) == ["a.bin"]


@pytest.mark.parametrize("what", ["whole_file", "whole_folder", "scratch"])
def test_a_killed_writer_leaves_nothing_whole_and_the_next_run_sweeps(tmp_path, what):
    target = tmp_path if what == "scratch" else tmp_path / "out"
    code = (
        f"from foveal.base.files import refuse_unwritable, {what}; import time\n"
        f"with {what}(r'{target}') as x:\n"
        f"    print('in', flush=True); time.sleep(60)\n"
    )
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE)
    assert process.stdout.readline() == b"in" + os.linesep.encode()
    process.kill()
    process.wait()
    process.stdout.close()
    assert not (tmp_path / "out").exists()
    assert len(names(tmp_path)) == 1  # the hidden part file
    with globals()[what](target):
        pass
    assert names(tmp_path) == ([] if what == "scratch" else ["out"])


def test_a_running_writer_is_left_alone(tmp_path):
    with scratch(tmp_path) as first, scratch(tmp_path) as second:
        assert first != second
        assert first.is_dir()
        time.sleep(0)
    assert names(tmp_path) == []


def test_a_folder_with_something_in_it_is_refused_unless_forced(tmp_path):
    folder = tmp_path / "site"
    folder.mkdir()
    (folder / "old.txt").write_text("old")
    with pytest.raises(FovealError, match="--force"), whole_folder(folder):
        pass
    with pytest.raises(ZeroDivisionError), whole_folder(folder, force=True):
        _ = 1 / 0
    assert names(folder) == ["old.txt"]
    with whole_folder(folder, force=True) as part:
        (part / "new.txt").write_text("new")
    assert names(folder) == ["new.txt"]
    assert names(tmp_path) == ["site"]


def test_places_that_cannot_be_written_get_a_sentence(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(FovealError, match="this is a folder"), whole_file(tmp_path):
        pass
    with pytest.raises(FovealError, match="this is a file"), whole_folder(tmp_path / "file"):
        pass
    with pytest.raises(FovealError, match="cannot be written"), whole_file(tmp_path / "file" / "below"):
        pass


def test_what_cannot_be_written_is_said_beforehand_and_nothing_is_made(tmp_path):
    refuse_unwritable(tmp_path / "new" / "deep" / "a.bin")
    (tmp_path / "old.bin").write_bytes(b"old")
    refuse_unwritable(tmp_path / "old.bin")
    refuse_unwritable(tmp_path, is_folder=True)
    assert names(tmp_path) == ["old.bin"]
    with pytest.raises(FovealError, match="cannot be written here"):
        refuse_unwritable(tmp_path / "old.bin" / "a.bin")
    with pytest.raises(FovealError, match="cannot be written here"):
        refuse_unwritable(tmp_path / "old.bin" / "a", is_folder=True)
    with pytest.raises(FovealError, match="this is a folder"):
        refuse_unwritable(tmp_path)
    with pytest.raises(FovealError, match="cannot be written here"), whole_folder(tmp_path / "old.bin" / "a"):
        pass
