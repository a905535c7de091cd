"""Parts of files that were written, as pages download them."""

from __future__ import annotations

import base64
import os
from pathlib import Path

import pytest

from webviz.api.errors import Error
from webviz.engine.commands import PROGRAM
from webviz.engine.parts.outputs import MAX_OUTPUTS, Outputs
from webviz.features.outputs import BLOCK, part_of


def test_the_parts_of_a_file_make_it_up(tmp_path: Path) -> None:
    data = os.urandom(BLOCK * 2 + 17)
    (tmp_path / "run.mcap").write_bytes(data)
    got, sizes = b"", set()
    while len(got) < len(data):
        part = part_of(tmp_path / "run.mcap", 0, len(got))
        got += base64.b64decode(part["data"])
        sizes.add((part["name"], part["size"], part["count"]))
    assert got == data
    assert sizes == {("run.mcap", str(len(data)), "1")}


def test_a_folder_has_its_files_by_name(tmp_path: Path) -> None:
    for name in ("b.mcap", "a.yaml"):
        (tmp_path / name).write_text(name)
    parts = [part_of(tmp_path, number, 0) for number in range(2)]
    assert [base64.b64decode(part["data"]) for part in parts] == [b"a.yaml", b"b.mcap"]
    assert {part["count"] for part in parts} == {"2"}


@pytest.mark.parametrize(("number", "offset"), [(1, 0), (-1, 0), (0, -1)])
def test_a_missing_part_is_refused(tmp_path: Path, number: int, offset: int) -> None:
    (tmp_path / "x").write_text("x")
    with pytest.raises(Error, match="has no such part"):
        part_of(tmp_path / "x", number, offset)


def test_links_and_pipes_in_place_of_a_file_are_not_read(tmp_path: Path) -> None:
    (tmp_path / "secret").write_text("secret")
    (tmp_path / "link").symlink_to(tmp_path / "secret")
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(Error, match="Cannot read link"):
        part_of(tmp_path / "link", 0, 0)
    with pytest.raises(Error, match="is not a regular file"):
        part_of(tmp_path / "pipe", 0, 0)
    with pytest.raises(Error, match="Cannot read gone"):
        part_of(tmp_path / "gone", 0, 0)


def test_the_newest_are_kept() -> None:
    outputs = Outputs()
    for number in range(MAX_OUTPUTS + 5):
        outputs.add(Path(str(number)), "report", "Saved.", PROGRAM)
    assert len(outputs.all) == MAX_OUTPUTS
    assert outputs.find(1) is None
    result = outputs.find(MAX_OUTPUTS + 5)
    assert result
    assert result.path == Path(str(MAX_OUTPUTS + 4)).absolute()
