"""Bytes of a file over HTTP: every header, in one process without sockets."""

import email
import os

import pytest

from foveal.server.data_file import DataFile

PATH = "/data/statue.fov"


def get(client, **headers):
    return client.get(PATH, headers={name.replace("_", "-"): value for name, value in headers.items()})


def test_the_whole_file(client, content):
    answer = get(client)
    assert answer.status == 200
    assert answer.content == content
    assert answer.headers["content-length"] == str(len(content))
    assert answer.headers["accept-ranges"] == "bytes"
    assert answer.headers["content-type"] == "application/octet-stream"
    assert answer.headers["cache-control"] == "no-cache"
    assert answer.headers["etag"].startswith('"')
    assert answer.headers["x-content-type-options"] == "nosniff"
    assert "content-encoding" not in answer.headers
    assert answer.headers["last-modified"].endswith("GMT")


@pytest.mark.parametrize(
    ("asked", "part"),
    [
        ("0-99", slice(0, 100)),
        ("2999990-", slice(2999990, None)),
        ("-7", slice(-7, None)),
        ("5-5", slice(5, 6)),
    ],
)
def test_one_range(client, content, asked, part):
    answer = get(client, range=f"bytes={asked}")
    start, stop, _ = part.indices(len(content))
    assert answer.status == 206
    assert answer.content == content[part]
    assert answer.headers["content-range"] == f"bytes {start}-{stop - 1}/{len(content)}"
    assert answer.headers["content-length"] == str(stop - start)


def test_a_range_longer_than_a_piece_is_streamed(client, content):
    answer = get(client, range="bytes=10-2999998")
    assert answer.status == 206
    assert answer.content == content[10:2999999]


@pytest.mark.parametrize(
    "asked", [[(0, 10), (100, 300), (2999000, 3000000)], [(0, 1500000), (1500000, 2900000)]]
)
def test_several_ranges_come_as_a_multipart_message(client, content, asked):
    answer = get(client, range="bytes=" + ",".join(f"{a}-{b - 1}" for a, b in asked))
    assert answer.status == 206
    assert "content-range" not in answer.headers
    assert answer.headers["content-length"] == str(len(answer.content))
    head = f"Content-Type: {answer.headers['content-type']}\r\n\r\n".encode()
    parts = email.message_from_bytes(head + answer.content).get_payload()
    assert [part["Content-Range"] for part in parts] == [
        f"bytes {a}-{b - 1}/{len(content)}" for a, b in asked
    ]
    # The email module guesses at line ends; the bytes are looked for as they are.
    assert all(b"\r\n\r\n" + content[a:b] + b"\r\n--" in answer.content for a, b in asked)


def test_nothing_behind_the_end(client, content):
    answer = get(client, range="bytes=3000000-")
    assert answer.status == 416
    assert answer.headers["content-range"] == f"bytes */{len(content)}"
    assert answer.headers["content-type"].startswith("text/plain")


@pytest.mark.parametrize("asked", ["bytes=9-1", "lines=1-2", "bytes=x", "bytes"])
def test_a_range_that_is_not_understood_is_ignored(client, content, asked):
    answer = get(client, range=asked)
    assert answer.status == 200
    assert len(answer.content) == len(content)


def test_head_tells_all_and_sends_nothing(client, content):
    answer = client.head(PATH, headers={"Range": "bytes=0-9"})  # Range is for GET alone
    assert answer.status == 200
    assert answer.headers["content-length"] == str(len(content))
    assert answer.headers["accept-ranges"] == "bytes"
    assert answer.content == b""


def test_conditional_requests(client):
    first = get(client)
    tag, date = first.headers["etag"], first.headers["last-modified"]
    same = get(client, if_none_match=tag)
    assert same.status == 304
    assert same.content == b""
    assert same.headers["etag"] == tag
    assert get(client, if_modified_since=date).status == 304
    assert get(client, if_none_match='"other"').status == 200
    assert get(client, if_match='"other"').status == 412
    assert get(client, if_none_match=tag, range="bytes=0-9").status == 304
    assert get(client, if_range=tag, range="bytes=0-9").status == 206
    assert get(client, if_range='"other"', range="bytes=0-9").status == 200
    assert get(client, if_range=f"W/{tag}", range="bytes=0-9").status == 200


def test_data_is_never_compressed(client, content):
    answer = get(client, accept_encoding="gzip", range="bytes=0-99")
    assert "content-encoding" not in answer.headers
    assert answer.content == content[:100]


def test_a_rebuilt_file_is_noticed(client, scene, content):
    path = scene.layers[0].path
    old = get(client, range="bytes=0-9").headers["etag"]
    new = path.with_suffix(".new")
    new.write_bytes(b"!" * len(content))
    os.utime(new, ns=(path.stat().st_atime_ns, path.stat().st_mtime_ns))  # same size, same time
    new.replace(path)
    answer = get(client, range="bytes=0-9", if_range=old)
    assert answer.status == 200
    assert answer.headers["etag"] != old
    assert answer.content == b"!" * len(content)


def test_a_file_deleted_while_it_is_shown_goes_on(client, scene, content):
    get(client, range="bytes=0-9")
    scene.layers[0].path.unlink()
    assert get(client, range="bytes=10-19").content == content[10:20]


def test_a_file_that_was_never_there_is_missing(client, scene):
    scene.layers[0].path.unlink()
    answer = get(client)
    assert answer.status == 404
    assert "statue.fov" in answer.text


def test_descriptors_are_given_back(scene):
    file = DataFile(scene.layers[0].path)
    file._look()
    descriptor = file._descriptor
    file.close()
    with pytest.raises(OSError, match="Bad file descriptor"):
        os.fstat(descriptor)


def test_without_pread_the_answers_are_the_same(client, content, monkeypatch):
    monkeypatch.setattr("foveal.server.data_file._IS_SHARED", False)
    assert get(client, range="bytes=100-199").content == content[100:200]
    assert get(client, range="bytes=0-9,20-29").status == 206
    assert get(client).content == content
