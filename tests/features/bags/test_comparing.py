"""A second run beside a bag that was opened in the page."""

from __future__ import annotations

from pathlib import Path

import pytest
from bags import strings

from tests.features.bags.conftest import Desk
from webviz.features.bags import NOT_LISTED, NOTHING_BESIDE
from webviz.sources.bag.comparison import ROOT


@pytest.fixture
def second(desk: Desk) -> Path:
    path = desk.folder / "second.mcap"
    strings(0.0, 0.5, 1.5).write_file(path)
    return path


def groups(desk: Desk) -> list[str]:
    return [row.name for row in desk.viewer.state.rows if row.name == "Ghost"]


def topics(desk: Desk) -> list[str]:
    return [topic for topic in desk.viewer.state.offers if topic.startswith(ROOT)]


def test_a_second_run_is_shown_and_removed_without_a_restart(desk: Desk, second: Path) -> None:
    desk.guest.do("OpenRecording", path=str(desk.folder / "run.mcap"))
    desk.viewer.config = {"robots": ["robot1"], "displays": [{"type": "Text", "topic": "/chatter"}]}
    before = desk.viewer.config
    assert desk.guest.do("CompareRecording", path=str(second)) == ""
    assert desk.names() == ("run.mcap", "second.mcap")
    assert topics(desk)
    assert groups(desk) == ["Ghost"]
    store = desk.store("bags")
    assert (store["opened"], store["second"]) == ("run.mcap", "second.mcap")
    # Another one takes its place.
    assert desk.guest.do("CompareRecording", path=str(second), align="stamp") == ""
    assert groups(desk) == ["Ghost"]
    assert desk.guest.do("EndComparison") == ""
    assert desk.names() == ("run.mcap",)
    assert topics(desk) == []
    assert desk.viewer.config == before


def test_another_bag_or_live_topics_end_it(desk: Desk, second: Path) -> None:
    desk.guest.do("OpenRecording", path=str(desk.folder / "run.mcap"))
    desk.guest.do("CompareRecording", path=str(second))
    desk.guest.do("OpenRecording", path=str(second))
    assert desk.names() == ("second.mcap",)
    assert groups(desk) == []
    desk.guest.do("CompareRecording", path=str(desk.folder / "run.mcap"))
    assert groups(desk) == ["Ghost"]
    assert desk.guest.do("ReturnToLive") == ""
    assert groups(desk) == []


def test_invalid_comparisons_are_refused_in_one_sentence(desk: Desk, second: Path) -> None:
    assert desk.guest.do("CompareRecording", path=str(second)) == NOTHING_BESIDE
    assert desk.guest.do("EndComparison") == NOTHING_BESIDE
    desk.guest.do("OpenRecording", path=str(desk.folder / "run.mcap"))
    assert desk.guest.do("EndComparison") == "No second run is shown."
    secret = str(desk.outside / "secret.mcap")
    assert desk.guest.do("CompareRecording", path=secret) == NOT_LISTED
    (desk.folder / "broken.mcap").write_bytes(b"x" * 1000)
    answer = desk.guest.do("CompareRecording", path=str(desk.folder / "broken.mcap"))
    assert answer
    assert "\n" not in answer
    assert desk.names() == ("run.mcap",)
    assert groups(desk) == []
