"""Bug reports of live topics, and of their past."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from live_paths import path_viewer

import webviz
from webviz.commands import SaveReport, Seek
from webviz.files.report import BugReport, read_report
from webviz.shell.testing.source import SECOND, HandFedSource

COUNT = 10


@pytest.fixture
def source() -> HandFedSource:
    return HandFedSource()


@pytest.fixture
def viewer(source: HandFedSource) -> Iterator[webviz.Viewer]:
    """A viewer that has received some paths, one a second of ROS time."""
    with path_viewer(source, COUNT) as viewer:
        yield viewer


def save_report(viewer: webviz.Viewer, folder: Path) -> BugReport:
    folder.mkdir()
    assert "Saved bug.zip" in viewer.do(SaveReport(path=str(folder / "bug.zip")))
    return read_report(folder / "bug.zip", folder).report


def test_a_report_of_live_topics_ends_now(viewer: webviz.Viewer, tmp_path: Path) -> None:
    report = save_report(viewer, tmp_path / "live")
    assert report.source == "live"
    assert report.at_ns == report.last_ns
    assert report.last_ns - report.first_ns >= 5 * SECOND
    assert [each.status for each in report.statuses if each.display == "Path"]


def test_a_report_of_the_past_shows_that_moment(viewer: webviz.Viewer, tmp_path: Path) -> None:
    playback = viewer.state.playback
    assert playback is not None
    viewer.do(Seek(playback.first_s))
    report = save_report(viewer, tmp_path / "past")
    assert report.at_ns < report.last_ns


def test_without_memory_there_is_nothing_to_report(tmp_path: Path) -> None:
    with webviz.Viewer(port=0, source=HandFedSource()) as viewer:
        viewer.config = {"displays": []}
        with pytest.raises(webviz.Error, match="No messages are kept in memory"):
            viewer.do(SaveReport(path=str(tmp_path / "bug.zip")))
