"""Uploads of pages: what is taken, and what is refused."""

from __future__ import annotations

import base64
from collections.abc import Iterator
from pathlib import Path

import pytest
from bags import strings

from tests.features.bags.conftest import LibraryViewer
from tests.support.guest import Guest, Served
from webviz.api.errors import Error
from webviz.api.roles import Role
from webviz.features.bags import uploading
from webviz.features.bags.uploading import BLOCK, MAX_BYTES, Uploads
from webviz.server.access import rules


@pytest.fixture
def uploads() -> Iterator[Uploads]:
    uploads = Uploads()
    yield uploads
    uploads.close()


def text(data: bytes) -> str:
    return base64.b64encode(data).decode()


def test_a_file_comes_whole_and_is_gone_at_the_end(uploads: Uploads) -> None:
    token = uploads.begin(1, "run.mcap", 6)
    assert uploads.add(1, token, 0, text(b"abc")) is None
    assert uploads.complete == frozenset()
    path = uploads.add(1, token, 3, text(b"def"))
    assert path
    assert (path.name, path.read_bytes()) == ("run.mcap", b"abcdef")
    assert uploads.complete == {path}
    uploads.close()
    assert not path.exists()


@pytest.mark.parametrize(
    "name",
    [
        *("../run.mcap", "/etc/run.mcap", "a/b.mcap", "a\\b.mcap", "", ".mcap", "run.yaml", "run"),
        *("-run.mcap", "a\nb.mcap", "a\u202eb.mcap", "x" * 300 + ".mcap", "..", "run.mcap\0"),
    ],
)
def test_an_invalid_name_of_a_bag_is_refused(uploads: Uploads, name: str) -> None:
    with pytest.raises(Error, match="Not uploaded: "):
        uploads.begin(1, name, 10)


@pytest.mark.parametrize("size", [0, -1, MAX_BYTES + 1])
def test_a_file_has_a_limit(uploads: Uploads, size: int) -> None:
    with pytest.raises(Error, match="the limit is 4 GB"):
        uploads.begin(1, "run.mcap", size)


def test_a_full_disk_and_all_files_together_are_refused(
    uploads: Uploads, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(uploading, "RESERVE", 1 << 60)
    with pytest.raises(Error, match="too full"):
        uploads.begin(1, "run.mcap", 10)
    monkeypatch.undo()
    monkeypatch.setattr(uploading, "MAX_TOTAL", 10)
    uploads.add(1, uploads.begin(1, "run.mcap", 6), 0, text(b"123456"))
    with pytest.raises(Error, match="which is the limit"):
        uploads.begin(1, "run.mcap", 5)


@pytest.mark.parametrize(
    ("offset", "data"),
    [(1, b"a"), (-1, b"a"), (0, b""), (0, b"a" * 7), (0, b"a" * (BLOCK + 1))],
)
def test_parts_that_do_not_fit_end_it(uploads: Uploads, offset: int, data: bytes) -> None:
    token = uploads.begin(1, "run.mcap", 6 if len(data) < BLOCK else BLOCK * 2)
    with pytest.raises(Error, match="do not fit"):
        uploads.add(1, token, offset, text(data))
    with pytest.raises(Error, match="it was ended"):
        uploads.add(1, token, 0, text(b"a"))


def test_another_page_cannot_add_to_it_nor_end_it(
    uploads: Uploads, monkeypatch: pytest.MonkeyPatch
) -> None:
    token = uploads.begin(1, "run.mcap", 6)
    with pytest.raises(Error, match="it was ended"):
        uploads.add(2, token, 0, text(b"a"))
    with pytest.raises(Error, match="a part is damaged"):
        uploads.add(1, token, 0, "*")
    with pytest.raises(Error, match="another file is under way"):
        uploads.begin(2, "other.mcap", 6)
    monkeypatch.setattr(uploading, "SILENCE_S", -1.0)
    assert uploads.begin(2, "other.mcap", 6)
    with pytest.raises(Error, match="it was ended"):
        uploads.add(1, token, 0, text(b"a"))


def test_only_owners_upload() -> None:
    for name in ("BeginUpload", "UploadPart"):
        assert [bool(rules.refusal(role, "CommandRequest", name)) for role in Role] == [
            True,
            True,
            False,
        ]


def test_a_page_uploads_a_bag_and_opens_it(library: LibraryViewer, tmp_path: Path) -> None:
    path = strings(0.0, 1.0).write_file(tmp_path / "dropped.mcap")
    data = path.read_bytes()
    guest = Guest(Served(library.viewer.port))
    guest.send(
        "CommandRequest",
        number=1,
        command="BeginUpload",
        arguments={"name": path.name, "size": len(data)},
    )
    token = guest.receive("CommandResult")["result"]["token"]
    part = {"token": token, "offset": 0, "text": text(data)}
    guest.send("CommandRequest", number=2, command="UploadPart", arguments=part)
    there = guest.receive("CommandResult")["result"]["path"]
    assert guest.do("OpenRecording", path=f"{Path(there).parent}/other.mcap") != ""
    assert guest.do("OpenRecording", path=there) == ""
    assert library.names() == ("dropped.mcap",)
    guest.close()
