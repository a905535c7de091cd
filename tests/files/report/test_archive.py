"""Zip files of bug reports, which may come from strangers."""

from __future__ import annotations

import contextlib
import zipfile
from collections.abc import Mapping
from pathlib import Path

import msgspec
import pytest

from webviz.files.report import BugReport, PrivateNames, ReportError, read_report, write_report

REPORT = BugReport(source="live", made=1.0, at_ns=2, first_ns=1, last_ns=3)


def with_number(name: str, digits: str) -> bytes:
    """The main part of a report with another number."""
    values = msgspec.to_builtins(REPORT) | {name: msgspec.Raw(digits.encode())}
    return msgspec.json.encode(values)


WHOLE: Mapping[str, bytes] = {
    "report.json": msgspec.json.encode(REPORT),
    "config.yaml": b"version: 1\n",
    "slice.mcap": b"slice",
}


def zipped(path: Path, members: Mapping[str, bytes]) -> Path:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return path


def test_a_written_report_is_read(tmp_path: Path) -> None:
    path = tmp_path / "bug.zip"
    (tmp_path / "a.mcap").write_bytes(b"slice")
    size = write_report(path, {**WHOLE, "slice.mcap": tmp_path / "a.mcap"})
    assert size == path.stat().st_size
    assert path.stat().st_mode & 0o077 == 0
    (tmp_path / "out").mkdir()
    report = read_report(path, tmp_path / "out")
    assert (report.report, report.bag.read_bytes(), report.picture) == (REPORT, b"slice", None)
    assert sorted(each.name for each in tmp_path.iterdir()) == ["a.mcap", "bug.zip", "out"]


def test_missing_parts_of_a_report_are_empty() -> None:
    least = {"source": "live", "made": 1.0, "at_ns": 3_500_000_000, "first_ns": 10**9}
    report = msgspec.convert(least | {"last_ns": 5 * 10**9, "version": REPORT.version}, BugReport)
    assert report.at_s == 2.5
    assert not any((report.has_names, report.statuses, report.findings, report.moments))


def test_a_report_of_any_time_and_with_a_comment_is_read(tmp_path: Path) -> None:
    first = with_number("first_ns", str(-(2**63)))
    path = zipped(tmp_path / "bug.zip", {**WHOLE, "report.json": first})
    with zipfile.ZipFile(path, "a") as archive:
        archive.comment = b"x" * 65_535
    (tmp_path / "out").mkdir()
    assert read_report(path, tmp_path / "out").report.first_ns == -(2**63)


def test_members_of_other_names_are_never_unpacked(tmp_path: Path) -> None:
    others = {"../evil": b"x", "/tmp/evil": b"x", "config.yaml/../../evil": b"x", "big": b"x" * 9}
    path = zipped(tmp_path / "bug.zip", {**others, **WHOLE})
    (out := tmp_path / "out").mkdir()
    read_report(path, out)
    assert sorted(each.name for each in out.iterdir()) == ["bug.mcap", "config.yaml"]
    assert not (tmp_path / "evil").exists()


@pytest.mark.parametrize(
    ("members", "reason"),
    [
        ({}, "report.json is missing"),
        ({"report.json": b"{}"}, "config.yaml is missing"),
        ({**WHOLE, "report.json": b"{}"}, "report.json is invalid"),
        ({**WHOLE, "report.json": b"[" * 100_000}, "report.json is invalid"),
        ({**WHOLE, "report.json": with_number("at_ns", "9" * 400)}, "report.json is invalid"),
        ({**WHOLE, "report.json": with_number("first_ns", "-" + "9" * 400)}, "json is invalid"),
        ({**WHOLE, "report.json": with_number("last_ns", str(2**63))}, "report.json is invalid"),
        ({**WHOLE, "report.json": with_number("made", "1e999")}, "report.json is invalid"),
        ({**WHOLE, "config.yaml": bytes(5 << 20)}, "config.yaml is larger than 4 MB"),
        ({**WHOLE, "picture.png": bytes(33 << 20)}, "picture.png is larger than 32 MB"),
        ({**WHOLE, **{f"{number}": b"" for number in range(2000)}}, "too many files"),
    ],
)
def test_bombs_and_foreign_zip_files(
    tmp_path: Path, members: Mapping[str, bytes], reason: str
) -> None:
    path = zipped(tmp_path / "bug.zip", members)
    (tmp_path / "out").mkdir()
    with pytest.raises(ReportError, match=reason):
        read_report(path, tmp_path / "out")


def test_a_name_of_a_member_that_has_no_end_is_not_quoted(tmp_path: Path) -> None:
    data = zipped(tmp_path / "bug.zip", WHOLE).read_bytes()
    at = data.index(b"config.yaml") - 4
    long = data[:at] + (50_000).to_bytes(2, "little") + data[at + 2 :] + bytes(50_000)
    # The table of contents stays where it was: only the header of the member claims the name.
    path = tmp_path / "long.zip"
    path.write_bytes(long[: len(data)])
    (tmp_path / "out").mkdir()
    with pytest.raises(ReportError) as error:
        read_report(path, tmp_path / "out")
    assert len(str(error.value)) < 500


def test_a_member_that_is_there_twice(tmp_path: Path) -> None:
    path = zipped(tmp_path / "bug.zip", WHOLE)
    with zipfile.ZipFile(path, "a") as archive, pytest.warns(UserWarning, match="Duplicate"):
        archive.writestr("slice.mcap", b"other")
    (tmp_path / "out").mkdir()
    with pytest.raises(ReportError, match=r"slice\.mcap twice"):
        read_report(path, tmp_path / "out")


def test_any_cut_or_changed_file_gives_a_sentence(tmp_path: Path) -> None:
    whole = zipped(tmp_path / "whole.zip", WHOLE).read_bytes()
    damaged = [whole[:cut] for cut in range(0, len(whole), 7)]
    damaged += [
        whole[:at] + bytes([whole[at] ^ 0x55]) + whole[at + 1 :] for at in range(len(whole))
    ]
    path = tmp_path / "bug.zip"
    for number, data in enumerate(damaged):
        path.write_bytes(data)
        (out := tmp_path / f"out{number}").mkdir()
        with contextlib.suppress(ReportError):  # any other exception fails
            read_report(path, out)


def test_a_full_disk_leaves_the_old_report(tmp_path: Path) -> None:
    path = tmp_path / "bug.zip"
    path.write_bytes(b"old")
    with pytest.raises(ReportError, match=r"Cannot write .*bug\.zip"):
        write_report(path, {**WHOLE, "slice.mcap": tmp_path / "missing"})
    assert path.read_bytes() == b"old"
    assert [each.name for each in tmp_path.iterdir()] == ["bug.zip"]


def test_names_are_replaced_by_as_many_characters() -> None:
    names = PrivateNames(["/scan"], ["labhost", "alice", "root"], "/home/alice")
    text = "alice@LABHOST in /home/alice/ws, /home/bob and alices root of 'base_link'"
    assert names.text(text) == (
        "xxxxx@xxxxxxx in /home/xxxxx/ws, /home/xxx and alices root of 'base_link'"
    )
    data = b"\x00\x01labhost\x00\xff/Users/carol\x00"
    assert names.message(data) == b"\x00\x01xxxxxxx\x00\xff/Users/xxxxx\x00"


def test_names_of_topics_and_frames_stay() -> None:
    names = PrivateNames(["/turtle7/scan", "/home/scan/points"], ["turtle7"], "/base")
    assert names.remaining_names == ("turtle7",)
    assert names.text("/turtle7/scan /home/scan /base/a") == "/turtle7/scan /home/scan /xxxx/a"


def test_a_name_within_that_of_a_frame_stays_only_there() -> None:
    names = PrivateNames(["/scan", "turtle7_camera", "map"], ["turtle7", "carol"], "/root")
    assert names.remaining_names == ("turtle7_camera",)
    text = "carol: no turtle7_camera on turtle7, nor turtle7_camera2 of Turtle7"
    hidden = "xxxxx: no turtle7_camera on xxxxxxx, nor xxxxxxx_camera2 of xxxxxxx"
    assert names.text(text) == hidden
    assert names.message(b"\0" + text.encode()) == b"\0" + hidden.encode()


def test_members_of_a_report_unpack_to_their_declared_size_at_most(tmp_path: Path) -> None:
    """The sizes that a member declares hold, whatever its data would unpack to."""
    path = zipped(tmp_path / "bug.zip", {**WHOLE, "config.yaml": bytes(1 << 20)})
    data = bytearray(path.read_bytes())
    place = data.rfind(b"config.yaml") - 46 + 24  # of the size in the table of contents
    data[place : place + 4] = (10).to_bytes(4, "little")
    path.write_bytes(data)
    (out := tmp_path / "out").mkdir()
    with pytest.raises(ReportError):
        read_report(path, out)
    assert (out / "config.yaml").stat().st_size <= 10
