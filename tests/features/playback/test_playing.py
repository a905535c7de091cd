"""Playing, pausing, seeking and stepping, as programs and pages ask for it."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import pytest
from bags import START_NS, Bag, ns, strings
from page_stores import page_store

from webviz.commands import (
    Pause,
    Play,
    RemoveBookmark,
    SaveBookmark,
    SaveMemory,
    Seek,
    SelectSpan,
    SetLoop,
    SetRate,
    StartRecording,
    StepMessage,
    Undo,
)
from webviz.engine.commands import Command
from webviz.engine.requests import Refused
from webviz.files.config import dump
from webviz.files.opening import parse
from webviz.sources.bag.history import BagHistory
from webviz.sources.player import Player

CONFIG = """\
fixed_frame: map
displays:
- {type: Path, topic: /path, buffer_length: 3}
"""


@pytest.fixture
def bag() -> Bag:
    recorded = strings(0, 1, 2, 3, 4)
    recorded.add("/path", "nav_msgs/msg/Path")
    for tenths in range(0, 41, 5):
        at_s = tenths / 10
        pose = {"header": {"frame_id": "map"}, "pose": {"position": {"x": at_s}}}
        recorded.put(at_s, "/path", {"header": {"frame_id": "map"}, "poses": [pose, pose]})
    return recorded


def test_a_bag_is_paused_at_its_start(theater: Callable, bag: Bag) -> None:
    playback = theater(bag).playback
    assert (playback.start_ns, playback.end_ns) == (START_NS, START_NS + ns(4))
    assert (playback.position_s, playback.rate, playback.is_playing) == (0.0, 1.0, False)
    assert playback.names == ("bag0.mcap",)


def test_playing_moves_the_position_and_stops_at_the_end(theater: Callable, bag: Bag) -> None:
    viewer = theater(bag, CONFIG)
    viewer.do(SetRate(0))
    assert viewer.do(Play()).playback.is_playing
    viewer.turn_until(lambda: not viewer.playback.is_playing)
    assert viewer.playback.position_s == 4.0
    assert viewer.loop.state().clock.is_paused
    assert len([*viewer.scene.visible()]) == 3


def test_at_the_end_playing_starts_over(theater: Callable, bag: Bag) -> None:
    viewer = theater(bag, CONFIG)
    viewer.do(Seek(4.0))
    before = [*viewer.scene.visible()]
    viewer.do(SetRate(0.01))
    playback = viewer.do(Play()).playback
    assert playback.is_playing
    assert playback.position_s < 0.5
    assert len([*viewer.scene.visible()]) == 1 < len(before)


def test_pause_holds_the_position(theater: Callable, bag: Bag) -> None:
    viewer = theater(bag, CONFIG)
    viewer.do(Play())
    viewer.do(Pause())
    before = viewer.playback
    assert not before.is_playing
    viewer.turn()
    assert viewer.playback.position_s == before.position_s
    assert viewer.do(Pause(False)).playback.is_playing


def test_a_rate_is_seconds_of_the_recording_per_second(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    player = Player(BagHistory(strings(0, 100).write(tmp_path / "run")))
    now_s = 50.0
    monkeypatch.setattr("time.monotonic", lambda: now_s)
    player.rate = 20.0
    player.play()
    now_s += 0.1
    player.advance()
    assert player.position_ns == pytest.approx(START_NS + ns(2), abs=2)
    now_s += 0.1
    player.advance(is_busy=True)
    assert player.position_ns == pytest.approx(START_NS + ns(2), abs=2)
    now_s += 30.0  # the machine slept: nothing is skipped
    player.advance()
    assert player.position_ns == pytest.approx(START_NS + ns(2 + 0.25 * 20), abs=2)
    player.close()


def test_a_loop_plays_the_selected_span(theater: Callable, bag: Bag) -> None:
    viewer = theater(bag, CONFIG)
    viewer.do(SetLoop())
    playback = viewer.do(SelectSpan(1.0, 2.0)).playback
    assert (playback.loop, playback.selected) == (True, (1.0, 2.0))
    viewer.do(SetRate(0))
    viewer.do(Play())
    # Asking for the state takes turns, which may pass over the end each time it is reached.
    viewer.turn_until(lambda: viewer.source.reached_ns == START_NS + ns(2.0))
    viewer.turn_until(lambda: viewer.source.reached_ns < START_NS + ns(2.0))
    assert viewer.playback.position_s >= 1.0
    assert viewer.playback.is_playing
    assert viewer.do(SelectSpan()).playback.selected is None


@pytest.mark.parametrize("outside_s", [0.5, 3.0])
def test_outside_of_the_selected_span_playing_begins_at_its_start(
    theater: Callable, bag: Bag, outside_s: float
) -> None:
    viewer = theater(bag, CONFIG)
    viewer.do(SelectSpan(1.0, 2.0))
    viewer.do(Seek(outside_s))
    viewer.do(SetRate(0.01))
    playback = viewer.do(Play()).playback
    assert playback.is_playing
    assert playback.position_s == pytest.approx(1.0, abs=0.1)


def test_a_loop_over_a_moment_ends(theater: Callable) -> None:
    viewer = theater(strings(1.0), CONFIG)
    viewer.do(SetLoop())
    viewer.do(Play())
    viewer.turn_until(lambda: not viewer.playback.is_playing)
    assert viewer.source.reached_ns == viewer.source.history.end_ns


def test_a_loop_over_a_moment_pauses_at_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    player = Player(BagHistory(strings(1.0).write(tmp_path / "run")))
    now_s = 50.0
    monkeypatch.setattr("time.monotonic", lambda: now_s)
    player.loop = True
    player.play()
    for _ in range(10):
        now_s += 0.1
        player.advance()
    assert (player.is_playing, player.is_seeking) == (False, False)
    assert player.position_ns == player.history.end_ns
    player.close()


@pytest.mark.parametrize("topic", ["/words", "words"])
def test_steps_go_from_message_to_message(theater: Callable, bag: Bag, topic: str) -> None:
    viewer = theater(bag, CONFIG)
    places = []
    for is_forward in (True, True, False, True, True):
        places.append(viewer.do(StepMessage(topic, is_forward)).playback.position_s)
    assert places == [0.0, 1.0, 0.0, 1.0, 2.0]


def test_a_step_without_a_topic_goes_to_the_next_displayed_message(
    theater: Callable, bag: Bag
) -> None:
    viewer = theater(bag, CONFIG)
    viewer.do(Seek(2.0))
    assert viewer.do(StepMessage()).playback.position_s == 2.5
    assert viewer.do(StepMessage(is_forward=False)).playback.position_s == 2.0


REFUSED = [
    (SetRate(-1), "The rate -1 is out of range. Give 0.01 to 1000, or 0 for as fast as possible."),
    (SelectSpan(3.0, 1.0), "The selected span is empty. Choose an end later than its start."),
    (Seek(math.nan), "NaN is not a valid time. Give seconds from the start of the recording."),
    (
        StepMessage("/words", False),
        "There is no previous message on /words. Step in the other direction.",
    ),
]


@pytest.mark.parametrize(("command", "reason"), REFUSED, ids=lambda each: str(each)[:20])
def test_invalid_commands_are_refused_with_the_reason(
    theater: Callable, bag: Bag, command: Command, reason: str
) -> None:
    viewer = theater(bag)
    with pytest.raises(Refused) as excinfo:
        viewer.do(command)
    assert str(excinfo.value) == reason


def test_a_time_outside_of_the_recording_is_brought_into_it(theater: Callable, bag: Bag) -> None:
    viewer = theater(bag)
    assert viewer.do(Seek(1e9)).playback.position_s == 4.0
    assert viewer.do(Seek(-math.inf)).playback.position_s == 0.0


def test_the_clock_of_ages_never_goes_back(theater: Callable, bag: Bag) -> None:
    viewer = theater(bag, CONFIG)
    clock = viewer.loop.context.clock
    times = [clock()]
    for at_s in (3.0, 1.0, 2.0, 0.0, 4.0):
        viewer.do(Seek(at_s))
        times.append(clock())
    assert times == sorted(times)


def test_bookmarks_name_moments_and_can_be_undone(theater: Callable, bag: Bag) -> None:
    viewer = theater(bag)
    viewer.do(Seek(2.0))
    viewer.do(SaveBookmark("here"))
    viewer.do(SaveBookmark("later", 3.5))
    bookmarks = page_store("bookmarks", viewer.loop.state())
    assert bookmarks == {"all": [["here", 2.0], ["later", 3.5]]}
    viewer.do(RemoveBookmark("here"))
    assert page_store("bookmarks", viewer.loop.state()) == {"all": [["later", 3.5]]}
    viewer.do(Undo())
    assert page_store("bookmarks", viewer.loop.state()) == bookmarks


def test_bookmarks_are_saved_in_the_config(theater: Callable, bag: Bag) -> None:
    viewer = theater(bag)
    viewer.do(SaveBookmark("door opens", 1.5))
    reread = parse(dump(viewer.loop.config()), "the config")
    assert reread.settings.bookmarks == {"door opens": (START_NS + ns(1.5)) / 1e9}


def test_bookmarks_are_read_from_a_config_and_those_of_other_recordings_kept(
    theater: Callable, bag: Bag
) -> None:
    config = f"bookmarks: {{a: {(START_NS + ns(1.5)) / 1e9}, b: 12}}\ndisplays: []\n"
    viewer = theater(bag, config)
    state = viewer.loop.state()
    assert page_store("bookmarks", state) == {"all": [["a", 1.5]]}
    assert set(state.settings.bookmarks) == {"a", "b"}


@pytest.mark.parametrize(
    ("command", "reason"),
    [
        (SaveBookmark(""), "The name is empty."),
        (SaveBookmark("a", math.nan), "NaN is not a valid time."),
        (RemoveBookmark("a"), "Unknown bookmark `a`"),
    ],
)
def test_bookmarks_that_cannot_be(
    theater: Callable, bag: Bag, command: Command, reason: str
) -> None:
    with pytest.raises(Refused, match=reason):
        theater(bag).do(command)


@pytest.mark.parametrize("command", [StartRecording(), SaveMemory()])
def test_a_bag_is_not_recorded_again(theater: Callable, bag: Bag, command: Command) -> None:
    viewer = theater(bag)
    with pytest.raises(Refused, match=r"A bag is a recording already\."):
        viewer.do(command)
    assert viewer.loop.state().memory is None
