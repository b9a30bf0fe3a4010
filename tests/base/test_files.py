"""Outputs appear whole or not at all, nothing is left lying about, and what cannot be is said beforehand."""

import errno
import os
import subprocess
import sys
import time

import pytest

from foveal.base.errors import FovealError
from foveal.base.files import (
    _MACHINE,
    is_filled,
    read_json,
    refuse_missing,
    refuse_same,
    refuse_unwritable,
    scratch,
    whole_file,
    whole_folder,
)


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


def test_what_another_machine_writes_on_a_shared_disk_is_left_alone(tmp_path):
    theirs = [".a.bin.01234567-999999999.part", ".foveal-scratch-01234567-999999999-x"]
    for name in theirs:
        (tmp_path / name).mkdir()
    with whole_file(tmp_path / "a.bin"), scratch(tmp_path):
        pass
    assert names(tmp_path) == [*theirs, "a.bin"]


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


def test_a_folder_that_is_there_stays_itself_and_gets_new_content(tmp_path, monkeypatch):
    real, link = tmp_path / "real", tmp_path / "link"
    real.mkdir()
    (real / "old.txt").write_text("old")
    link.symlink_to(real)
    before = real.stat().st_ino
    with whole_folder(link, force=True) as part:
        (part / "new.txt").write_text("new")
        assert (real / "old.txt").exists()
    assert (link.is_symlink(), names(real), real.stat().st_ino) == (True, ["new.txt"], before)
    (tmp_path / "empty").mkdir()
    monkeypatch.chdir(tmp_path / "empty")
    with whole_folder(".") as part:
        (part / "a").mkdir()
    assert names(tmp_path / "empty") == ["a"]


def test_an_exchange_that_fails_half_way_is_taken_back(tmp_path, monkeypatch):
    folder = tmp_path / "site"
    folder.mkdir()
    for name in ("a", "b", "c"):
        (folder / name).write_text("old")
    real, left = type(folder).replace, [4]  # all three old ones go, one new one comes

    def replace(self, target):
        if left[0] == 0:
            left[0] = 99
            raise KeyboardInterrupt
        left[0] -= 1
        return real(self, target)

    def fill():
        with whole_folder(folder, force=True) as part:
            for name in ("a", "b", "d"):
                (part / name).write_text("new")
            monkeypatch.setattr(type(folder), "replace", replace)

    with pytest.raises(KeyboardInterrupt):
        fill()
    assert [(path.name, path.read_text()) for path in sorted(folder.iterdir())] == [
        ("a", "old"),
        ("b", "old"),
        ("c", "old"),
    ]


def test_a_folder_with_litter_only_is_empty(tmp_path):
    litter = tmp_path / f".foveal-new.{_MACHINE}-999999999.part"
    litter.mkdir()
    (litter / "half").write_text("half")
    assert not is_filled(tmp_path)
    assert names(tmp_path) == []


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EFBIG])
def test_a_full_disk_gets_a_sentence_that_names_the_place(tmp_path, number):
    for room, path in ((whole_file, tmp_path / "a"), (whole_folder, tmp_path / "b"), (scratch, tmp_path)):
        with pytest.raises(FovealError, match=rf"^{path}: .*Free some space"), room(path):
            raise OSError(number, os.strerror(number))
        with pytest.raises(PermissionError), room(path):
            raise PermissionError(errno.EACCES, "about something else")
    assert names(tmp_path) == []


def test_what_is_no_file_is_said(tmp_path):
    refuse_missing(__file__)
    with pytest.raises(FovealError, match="no such file"):
        refuse_missing(tmp_path / "none")
    with pytest.raises(FovealError, match="folder"):
        refuse_missing(tmp_path)
    if hasattr(os, "mkfifo"):
        os.mkfifo(tmp_path / "pipe")
        with pytest.raises(FovealError, match="pipe"):
            refuse_missing(tmp_path / "pipe")


def test_an_output_that_is_the_input_is_said_by_any_name(tmp_path):
    one, two, link = tmp_path / "one", tmp_path / "two", tmp_path / "link"
    one.write_text("")
    two.write_text("")
    link.symlink_to(one)
    os.link(one, tmp_path / "hard")
    refuse_same(two, one)
    refuse_same(tmp_path / "none", one)
    for name in (one, link, tmp_path / "hard", tmp_path / "." / "one"):
        with pytest.raises(FovealError, match="the input itself"):
            refuse_same(name, one)


def test_json_files_and_what_is_none(tmp_path, monkeypatch):
    path = tmp_path / "a.json"
    path.write_bytes(b'\xef\xbb\xbf{"a": [1]}')  # with the mark that Windows editors set
    assert read_json(path) == {"a": [1]}
    for text in (b"", b"{", b"\xff\xfe\x00", b"[" * 10**5, b"9" * 5000):
        path.write_bytes(text)
        with pytest.raises(FovealError, match=rf"^{path}: this is not JSON"):
            read_json(path)
    monkeypatch.setattr("foveal.base.files._JSON_BYTES", 10)
    path.write_text("[" + "1," * 9 + "1]")
    with pytest.raises(FovealError, match="too large"):
        read_json(path)
