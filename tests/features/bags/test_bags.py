"""Bags that owners open in the page, and what they cannot open."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from waiting import until

from tests.features.bags.conftest import LibraryViewer
from webviz.commands import AddPanel, Pause, Seek
from webviz.features import black_box
from webviz.features.bags import BLACK_BOX, NOT_LISTED


def test_live_topics_make_room_for_a_bag_and_come_back_with_their_memory(
    library: LibraryViewer,
) -> None:
    assert library.bags() == ["run.mcap"]
    before = library.viewer.state.memory
    assert library.guest.do("OpenRecording", path=str(library.folder / "run.mcap")) == ""
    assert library.names() == ("run.mcap",)
    assert library.guest.do("ReturnToLive") == ""
    after = library.viewer.state.memory
    assert library.names() == ()
    assert before
    assert after
    assert after.size >= before.size


def test_a_saved_bag_is_listed_and_opened(library: LibraryViewer) -> None:
    assert library.guest.do("SaveMemory").startswith("Saved the last")
    (output,) = library.store("outputs").values()
    assert library.bags() == sorted(["run.mcap", output["name"]])
    assert library.guest.do("OpenRecording", path=output["path"]) == ""
    assert library.names() == (output["name"],)


def test_a_report_is_unpacked_and_its_messages_are_played(library: LibraryViewer) -> None:
    assert library.guest.do("SaveReport").startswith("Saved webviz_report")
    (report,) = library.store("outputs").values()
    assert library.guest.do("OpenRecording", path=report["path"]) == ""
    assert len(library.names()) == 1


@pytest.mark.parametrize(
    "path",
    [
        *("{outside}/secret.mcap", "{library}/../outside/secret.mcap", "run.mcap", "", "{library}"),
        *("/etc/passwd", "{library}/run.mcap\0", "{library}/./../outside/secret.mcap"),
    ],
)
def test_no_other_folder_is_readable(library: LibraryViewer, path: str) -> None:
    expected = path.format(outside=library.outside, library=library.folder)
    assert library.guest.do("OpenRecording", path=expected) == NOT_LISTED
    assert library.names() == ()


def test_links_and_devices_are_neither_listed_nor_opened(library: LibraryViewer) -> None:
    (library.folder / "link.mcap").symlink_to(library.outside / "secret.mcap")
    (library.folder / "folder").symlink_to(library.outside)
    os.mkfifo(library.folder / "pipe.mcap")
    assert "run.mcap" in library.bags()
    assert not {"link.mcap", "folder"} & {*library.bags()}
    for name in ("link.mcap", "folder"):
        answer = library.guest.do("OpenRecording", path=str(library.folder / name))
        assert "is a link to another folder" in answer
    answer = library.guest.do("OpenRecording", path=str(library.folder / "pipe.mcap"))
    assert answer == "Not opened: pipe.mcap is not a bag. Choose another file."
    assert library.names() == ()


@pytest.mark.parametrize("content", [b"", b"x" * 1000, b"PK\x05\x06" + b"\xff" * 18])
def test_a_file_that_is_not_a_bag_is_refused_in_one_sentence(
    library: LibraryViewer, content: bytes
) -> None:
    for name in ("broken.mcap", "broken.zip", "broken.db3"):
        (library.folder / name).write_bytes(content)
        answer = library.guest.do("OpenRecording", path=str(library.folder / name))
        assert answer
        assert "\n" not in answer
    assert library.names() == ()


def test_a_truncated_bag_is_played_as_far_as_it_goes(library: LibraryViewer) -> None:
    whole = (library.folder / "run.mcap").read_bytes()
    (library.folder / "cut.mcap").write_bytes(whole[: len(whole) * 2 // 3])
    library.guest.do("OpenRecording", path=str(library.folder / "cut.mcap"))
    assert library.guest.do("ReturnToLive") is not None


def test_a_new_panel_is_filled_up_to_the_position(library: LibraryViewer) -> None:
    library.guest.do("OpenRecording", path=str(library.folder / "run.mcap"))
    library.viewer.do(Pause())
    library.viewer.do(Seek(1.2))
    library.viewer.do(AddPanel("StateTimeline", {"paths": ["/words.data"]}))
    library.guest.send("Watch", store="panel:StateTimeline")
    panel = library.viewer.fact("panels")[-1].panel

    def states() -> list[str]:
        track = panel.tracks.get("/words.data")
        return [state for _, state in track.changes] if track else []

    until(lambda: states() == ["0", "1"], lambda: f"{states()}", seconds=10.0)


def test_the_folder_of_the_black_box_is_listed() -> None:
    assert BLACK_BOX == black_box.FOLDER
    assert Path(BLACK_BOX).name == BLACK_BOX
