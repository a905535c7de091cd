"""Content of bug reports: the picture of a page, and the tree of transforms."""

from __future__ import annotations

import base64
import io
import os
import re
import socket
import time
import zipfile
from collections.abc import Iterator
from pathlib import Path

import PIL.Image
import pytest
from bench import Benches
from live_paths import path_viewer

import webviz
from webviz.commands import ListReport, Refresh, SaveReport
from webviz.data.messages import encode
from webviz.engine.commands import Sender
from webviz.features import reports
from webviz.features.reports.writing import MAX_PICTURE, MAX_PIXELS, read_picture
from webviz.files.report import read_report
from webviz.shell.testing import header
from webviz.shell.testing.source import SECOND, HandFedSource

TF = "tf2_msgs/msg/TFMessage"
PATH = "nav_msgs/msg/Path"


def picture(size: tuple[int, int] = (2, 1), kind: str = "PNG", behind: int = 0) -> str:
    """Return an image as a page sends it, with so many bytes behind its end."""
    PIL.Image.new("1", size).convert("1" if kind == "PNG" else "L").save(
        data := io.BytesIO(), format=kind
    )
    return base64.b64encode(data.getvalue() + bytes(behind)).decode()


@pytest.mark.parametrize(("kind", "ending"), [("PNG", ".png"), ("JPEG", ".jpg")])
def test_a_picture_is_a_member_with_the_ending_of_its_format(kind: str, ending: str) -> None:
    result = read_picture(picture_text := picture(kind=kind))
    assert result is not None
    assert result[0].endswith(ending)
    assert result[1] == base64.b64decode(picture_text)


def test_an_empty_picture_is_left_out() -> None:
    assert read_picture("") is None


@pytest.mark.parametrize("picture_text", ["%", "AAAA", picture(kind="GIF"), picture()[:40]])
def test_a_picture_that_is_not_png_or_jpeg_is_refused(picture_text: str) -> None:
    with pytest.raises(webviz.Error, match="not a PNG or JPEG"):
        read_picture(picture_text)


def test_a_picture_may_have_16_megabytes() -> None:
    size = len(base64.b64decode(picture()))
    assert read_picture(picture(behind=MAX_PICTURE - size)) is not None
    with pytest.raises(webviz.Error, match="too large"):
        read_picture(picture(behind=MAX_PICTURE - size + 1))


def test_a_picture_may_have_50_million_pixels() -> None:
    assert read_picture(picture((MAX_PIXELS // 5000, 5000))) is not None
    with pytest.raises(webviz.Error, match="too large"):
        read_picture(picture((MAX_PIXELS // 5000 + 1, 5000)))


@pytest.mark.parametrize("is_placed", [False, True])
def test_the_tree_of_transforms_is_a_member(tmp_path: Path, is_placed: bool) -> None:
    source = HandFedSource()
    with webviz.Viewer(port=0, source=source) as viewer:
        viewer.config = {"displays": [{"type": "Path", "topic": "/plan"}, {"type": "TF"}]}
        for _ in range(2):
            viewer.do(Refresh())
            source.now += SECOND
            source.put("/plan", PATH, encode(PATH, {"header": header("map", source.now)}))
            if is_placed:
                link = {"header": header("map", source.now), "child_frame_id": "base_link"}
                source.put("/tf", TF, encode(TF, {"transforms": [link]}))
        viewer.do(SaveReport(path=str(tmp_path / "bug.zip")))
    with zipfile.ZipFile(tmp_path / "bug.zip") as members:
        tree = members.read("frames.txt").decode()
    assert ("No transforms." in tree) is not is_placed
    assert ("base_link" in tree) is is_placed


@pytest.fixture
def live() -> Iterator[webviz.Viewer]:
    """A viewer of live topics that has received a path."""
    with path_viewer(HandFedSource()) as viewer:
        yield viewer


def test_names_are_left_out_unless_requested(live: webviz.Viewer) -> None:
    for command, sentence in (
        (ListReport(), "are left out"),
        (ListReport(with_names=False), "are left out"),
        (ListReport(with_names=True), "are included"),
    ):
        assert f"Names of hosts, users and home folders {sentence}" in live.do(command)


def test_the_name_of_the_machine_is_in_no_text_of_a_report(
    live: webviz.Viewer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(socket, "gethostname", lambda: "alices-laptop.lab")
    live.config = {
        "displays": [{"type": "Path", "topic": "/plan", "name": "Seen by alices-laptop"}]
    }
    live.do(SaveReport(path=str(tmp_path / "bug.zip")))
    with zipfile.ZipFile(tmp_path / "bug.zip") as members:
        texts = {name: members.read(name) for name in members.namelist()}
    assert b"Seen by xxxxxxxxxxxxx" in texts["config.yaml"]
    assert not any(b"alices" in text for text in texts.values())


@pytest.mark.parametrize("with_names", [False, True])
def test_a_report_records_its_size_and_whether_it_has_names(
    live: webviz.Viewer, tmp_path: Path, with_names: bool
) -> None:
    path = tmp_path / "bug.zip"
    image = base64.b64decode(picture()) + os.urandom(1_234_567)
    picture_text = base64.b64encode(image).decode()
    answer = live.do(SaveReport(picture_text, path=str(path), with_names=with_names))
    assert float(answer.removeprefix("Saved bug.zip, ").removesuffix(" MB.")) == pytest.approx(
        path.stat().st_size / 1e6, rel=0.01
    )
    assert read_report(path, tmp_path).report.has_names is with_names


def test_a_small_report_has_not_zero_megabytes(live: webviz.Viewer, tmp_path: Path) -> None:
    answer = live.do(SaveReport(path=str(tmp_path / "bug.zip")))
    size = (tmp_path / "bug.zip").stat().st_size
    assert answer == f"Saved bug.zip, {max(1, round(size / 1000)) / 1000:.3g} MB."
    assert "0 MB" not in answer


def test_without_a_path_it_is_in_the_working_folder(
    live: webviz.Viewer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    answer = live.do(SaveReport())
    (path,) = tmp_path.iterdir()
    assert re.fullmatch(r"webviz_report_.*\.zip", path.name)
    assert path.name in answer


def test_a_report_waits_for_some_rounds_of_the_doctor_but_not_for_long(
    live: webviz.Viewer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reports, "ROUNDS_S", 1.0)
    monkeypatch.setattr(reports, "ROUNDS", 10**6)
    begun_s = time.monotonic()
    live.do(SaveReport(path=str(tmp_path / "late.zip")))
    assert 1.0 <= time.monotonic() - begun_s < 5.0
    monkeypatch.setattr(reports, "ROUNDS_S", 60.0)
    monkeypatch.setattr(reports, "ROUNDS", 3)
    live.do(SaveReport(path=str(tmp_path / "bug.zip")))
    monkeypatch.setattr(reports, "ROUNDS", 1)  # there were more before
    live.do(SaveReport(path=str(tmp_path / "again.zip")))
    assert time.monotonic() - begun_s < 50.0


def test_pages_choose_no_file(bench: Benches, tmp_path: Path) -> None:
    b = bench()
    answer = b.viewer.enqueue(SaveReport(path=str(tmp_path / "bug.zip")), Sender(1))
    b.until_done(answer)
    assert str(answer.exception(0)) == "Pages cannot choose the file of a report."
