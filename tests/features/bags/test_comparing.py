"""A second run beside a bag that was opened in the page."""

from __future__ import annotations

from pathlib import Path

import pytest
from bags import strings

from tests.features.bags.conftest import LibraryViewer
from webviz.features.bags import NOT_LISTED, NOTHING_BESIDE
from webviz.sources.bag.comparison import ROOT


@pytest.fixture
def second(library: LibraryViewer) -> Path:
    path = library.folder / "second.mcap"
    strings(0.0, 0.5, 1.5).write_file(path)
    return path


def groups(library: LibraryViewer) -> list[str]:
    return [row.name for row in library.viewer.state.rows if row.name == "Ghost"]


def topics(library: LibraryViewer) -> list[str]:
    return [topic for topic in library.viewer.state.offers if topic.startswith(ROOT)]


def test_a_second_run_is_shown_and_removed_without_a_restart(
    library: LibraryViewer, second: Path
) -> None:
    library.guest.do("OpenRecording", path=str(library.folder / "run.mcap"))
    library.viewer.config = {
        "robots": ["robot1"],
        "displays": [{"type": "Text", "topic": "/chatter"}],
    }
    before = library.viewer.config
    assert library.guest.do("CompareRecording", path=str(second)) == ""
    assert library.names() == ("run.mcap", "second.mcap")
    assert topics(library)
    assert groups(library) == ["Ghost"]
    store = library.store("bags")
    assert (store["opened"], store["second"]) == ("run.mcap", "second.mcap")
    # Another one takes its place.
    assert library.guest.do("CompareRecording", path=str(second), align="stamp") == ""
    assert groups(library) == ["Ghost"]
    assert library.guest.do("EndComparison") == ""
    assert library.names() == ("run.mcap",)
    assert topics(library) == []
    assert library.viewer.config == before


def test_another_bag_or_live_topics_end_it(library: LibraryViewer, second: Path) -> None:
    library.guest.do("OpenRecording", path=str(library.folder / "run.mcap"))
    library.guest.do("CompareRecording", path=str(second))
    library.guest.do("OpenRecording", path=str(second))
    assert library.names() == ("second.mcap",)
    assert groups(library) == []
    library.guest.do("CompareRecording", path=str(library.folder / "run.mcap"))
    assert groups(library) == ["Ghost"]
    assert library.guest.do("ReturnToLive") == ""
    assert groups(library) == []


def test_invalid_comparisons_are_refused_in_one_sentence(
    library: LibraryViewer, second: Path
) -> None:
    assert library.guest.do("CompareRecording", path=str(second)) == NOTHING_BESIDE
    assert library.guest.do("EndComparison") == NOTHING_BESIDE
    library.guest.do("OpenRecording", path=str(library.folder / "run.mcap"))
    assert library.guest.do("EndComparison") == "No second run is shown."
    secret = str(library.outside / "secret.mcap")
    assert library.guest.do("CompareRecording", path=secret) == NOT_LISTED
    (library.folder / "broken.mcap").write_bytes(b"x" * 1000)
    answer = library.guest.do("CompareRecording", path=str(library.folder / "broken.mcap"))
    assert answer
    assert "\n" not in answer
    assert library.names() == ("run.mcap",)
    assert groups(library) == []
