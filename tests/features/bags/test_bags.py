"""Bags that owners open in the page, and what they cannot open."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from waiting import until

from tests.features.bags.conftest import Desk
from webviz.commands import AddPanel, Pause, Seek
from webviz.features import black_box
from webviz.features.bags import BLACK_BOX, NOT_LISTED


def test_live_topics_make_room_for_a_bag_and_come_back_with_their_memory(desk: Desk) -> None:
    assert desk.bags() == ["run.mcap"]
    before = desk.viewer.state.memory
    assert desk.guest.do("OpenRecording", path=str(desk.folder / "run.mcap")) == ""
    assert desk.names() == ("run.mcap",)
    assert desk.guest.do("ReturnToLive") == ""
    after = desk.viewer.state.memory
    assert desk.names() == ()
    assert before
    assert after
    assert after.size >= before.size


def test_a_saved_bag_is_listed_and_opened(desk: Desk) -> None:
    assert desk.guest.do("SaveMemory").startswith("Saved the last")
    (output,) = desk.store("outputs").values()
    assert desk.bags() == sorted(["run.mcap", output["name"]])
    assert desk.guest.do("OpenRecording", path=output["path"]) == ""
    assert desk.names() == (output["name"],)


def test_a_report_is_unpacked_and_its_messages_are_played(desk: Desk) -> None:
    assert desk.guest.do("SaveReport").startswith("Saved webviz_report")
    (report,) = desk.store("outputs").values()
    assert desk.guest.do("OpenRecording", path=report["path"]) == ""
    assert len(desk.names()) == 1


@pytest.mark.parametrize(
    "path",
    [
        *("{outside}/secret.mcap", "{library}/../outside/secret.mcap", "run.mcap", "", "{library}"),
        *("/etc/passwd", "{library}/run.mcap\0", "{library}/./../outside/secret.mcap"),
    ],
)
def test_no_other_folder_is_readable(desk: Desk, path: str) -> None:
    expected = path.format(outside=desk.outside, library=desk.folder)
    assert desk.guest.do("OpenRecording", path=expected) == NOT_LISTED
    assert desk.names() == ()


def test_links_and_devices_are_neither_listed_nor_opened(desk: Desk) -> None:
    (desk.folder / "link.mcap").symlink_to(desk.outside / "secret.mcap")
    (desk.folder / "folder").symlink_to(desk.outside)
    os.mkfifo(desk.folder / "pipe.mcap")
    assert "run.mcap" in desk.bags()
    assert not {"link.mcap", "folder"} & {*desk.bags()}
    for name in ("link.mcap", "folder"):
        answer = desk.guest.do("OpenRecording", path=str(desk.folder / name))
        assert "is a link to another folder" in answer
    answer = desk.guest.do("OpenRecording", path=str(desk.folder / "pipe.mcap"))
    assert answer == "Not opened: pipe.mcap is not a bag. Choose another file."
    assert desk.names() == ()


@pytest.mark.parametrize("content", [b"", b"x" * 1000, b"PK\x05\x06" + b"\xff" * 18])
def test_a_file_that_is_not_a_bag_is_refused_in_one_sentence(desk: Desk, content: bytes) -> None:
    for name in ("broken.mcap", "broken.zip", "broken.db3"):
        (desk.folder / name).write_bytes(content)
        answer = desk.guest.do("OpenRecording", path=str(desk.folder / name))
        assert answer
        assert "\n" not in answer
    assert desk.names() == ()


def test_a_truncated_bag_is_played_as_far_as_it_goes(desk: Desk) -> None:
    whole = (desk.folder / "run.mcap").read_bytes()
    (desk.folder / "cut.mcap").write_bytes(whole[: len(whole) * 2 // 3])
    desk.guest.do("OpenRecording", path=str(desk.folder / "cut.mcap"))
    assert desk.guest.do("ReturnToLive") is not None


def test_a_new_panel_is_filled_up_to_the_position(desk: Desk) -> None:
    desk.guest.do("OpenRecording", path=str(desk.folder / "run.mcap"))
    desk.viewer.do(Pause())
    desk.viewer.do(Seek(1.2))
    desk.viewer.do(AddPanel("StateTimeline", {"paths": ["/words.data"]}))
    desk.guest.send("Watch", store="panel:StateTimeline")
    panel = desk.viewer.fact("panels")[-1].panel

    def states() -> list[str]:
        track = panel.tracks.get("/words.data")
        return [state for _, state in track.changes] if track else []

    until(lambda: states() == ["0", "1"], lambda: f"{states()}", seconds=10.0)


def test_the_folder_of_the_black_box_is_listed() -> None:
    assert BLACK_BOX == black_box.FOLDER
    assert Path(BLACK_BOX).name == BLACK_BOX
