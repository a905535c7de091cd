"""Live topics that are rewound: what is shown of the past, and what is refused meanwhile."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from bags import START_NS, Bag, ns, strings
from bench import Bench, Benches, benches
from drives import CONFIG, recorded

from tests.features.playback.conftest import LiveDrive
from webviz.api.declared import Topic
from webviz.api.lookback import Lookback
from webviz.api.nodes import Lines
from webviz.api.vehicle import Velocity
from webviz.commands import (
    Pause,
    Play,
    Refresh,
    ReturnToLive,
    SaveMemory,
    Seek,
    SetProperty,
    SetRate,
    StartRecording,
    StepMessage,
    StopRecording,
)
from webviz.data.messages import encode
from webviz.engine.driving import DrivingAnswer
from webviz.engine.parts.time import REWOUND, STOPPED
from webviz.engine.state import State
from webviz.features.playback import LIVE
from webviz.files.config.model import MemorySettings
from webviz.shell.testing import BagViewer
from webviz.shell.testing.remembering_graph import RememberingGraph
from webviz.shell.testing.source import HandFedSource
from webviz.sources import Advertisement, Offer, Publisher, Raw, Subscription
from webviz.sources.bag.history import BagHistory
from webviz.sources.bag.log import LOG, ROSOUT
from webviz.sources.past_state import PlaybackState
from webviz.sources.player import NEARLY_NS, Player
from webviz.sources.recording.entries_history import WallClock
from webviz.sources.recording.memory import MEMORY_OFF, MemoryHistory
from webviz.tools.teleop import Teleop
from webviz_displays.path import Path as PathDisplay

PATH = "nav_msgs/msg/Path"
LASTING = """\
fixed_frame: map
displays:
- {type: Odometry, keep: 7}
- {type: Map}
- {type: Path, buffer_length: 3}
"""
"""Displays that do not depend on how long something is ago."""
PUBLISHER = Publisher("/planner", PATH, "reliable", "volatile")


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_rewound_viewer_equals_one_of_the_saved_memory(
    drive: Callable[..., LiveDrive], seed: int
) -> None:
    live = drive(recorded(seed))
    live.do(SaveMemory(path="saved"))
    with contextlib.closing(BagViewer(Path("saved"), CONFIG)) as played:
        truth = {}
        for at_s in (0.58, 2.08, 3.78, 5.58):
            first_s = (played.source.history.start_ns - START_NS) / 1e9
            played.play_to(at_s - first_s)
            played.settle()
            truth[at_s] = played.visible_nodes()
    for at_s in (3.78, 0.58, 5.58, 2.08, 3.78):
        live.seek(at_s)
        assert live.playback.is_live is False
        for display, nodes in live.visible_nodes().items():
            assert nodes == truth[at_s][display], (display, at_s)


def test_a_rewound_span_is_saved_after_the_memory_dropped_it(
    drive: Callable[..., LiveDrive],
) -> None:
    """A crash that somebody rewound to is in the file, however long they look at it."""
    live = drive(recorded(1), f"memory: {{seconds: 20}}\n{CONFIG}")
    live.seek(2.08)
    drawing = live.visible_nodes()
    channel = next(each for each in live.files.channels if each.topic == "/odom")
    *_, message = live.files.messages([channel], live.files.start_ns)
    late_s = 28.0
    live.source.inbox.put("/odom", Raw(message.cdr, START_NS + ns(late_s), live.began_s + late_s))
    live.loop.turn()
    assert "all 28 s" in live.do(SaveMemory(path="saved"))
    with contextlib.closing(BagViewer(Path("saved"), CONFIG)) as played:
        played.play_to(2.08 - (played.source.history.start_ns - START_NS) / 1e9)
        played.settle()
        assert played.visible_nodes() == drawing
    live.do(ReturnToLive())
    assert "the last" in live.do(SaveMemory(path="live"))


@pytest.mark.parametrize("seconds", [60, 30])
def test_frames_whose_transforms_ended_long_before_are_known(
    drive: Callable[..., LiveDrive], seconds: int
) -> None:
    """The arm's last transforms are 39 s old, and forgotten in a memory of 30 s."""
    bag = Bag()
    for at_s in (0.5, 1.0):
        bag.transform(at_s, "base", "arm", x=at_s)
    for step in range(400):
        bag.transform(step * 0.1, "map", "base")
    config = f"fixed_frame: map\nmemory: {{seconds: {seconds}}}\ndisplays: [{{type: TF}}]\n"
    begun_s = time.monotonic()
    live = drive(bag, config, ago_s=40.0)

    for at_s in (39.0, 12.0, 35.0):
        live.seek(at_s)
        assert live.loop.buffer.link("arm"), at_s
        assert "Clocks" not in live.loop.state().statuses
    live.do(SaveMemory(path="saved"))
    passed_s = time.monotonic() - begun_s  # in which nothing came, and the memory went on
    with contextlib.closing(BagViewer(Path("saved"), config)) as played:
        length_s = (played.source.history.end_ns - played.source.history.start_ns) / 1e9
        most_s = min(39.9, seconds)
        assert most_s - passed_s - 2.0 <= length_s <= most_s + 2.0
        for at_s in (25.0, 1.0):
            played.do(Seek(at_s))
            assert played.loop.buffer.link("arm"), at_s
            assert "Clocks" not in played.loop.state().statuses


def test_back_at_now_everything_is_shown_that_came_meanwhile(
    drive: Callable[..., LiveDrive],
) -> None:
    live = drive(recorded(4), LASTING)
    live.do(Refresh())
    before = live.visible_nodes()
    live.seek(1.08)
    assert live.visible_nodes() != before
    live.do(ReturnToLive())
    assert live.playback.is_live
    assert live.visible_nodes() == before


def test_displays_that_never_catch_up_are_live_after_a_while(
    drive: Callable[..., LiveDrive], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz.sources.player.RETURNING_S", 0.05)
    live = drive(recorded(4), LASTING)
    before = live.visible_nodes()
    live.seek(1.08)
    with monkeypatch.context() as patch:
        patch.setattr("webviz.engine.pipeline.runner.Runner.is_late", lambda runner: True)
        live.do(ReturnToLive())
    assert live.playback.is_live
    assert live.visible_nodes() == before


def test_playing_from_the_past_becomes_live(drive: Callable[..., LiveDrive]) -> None:
    live = drive(recorded(5), LASTING)
    live.do(Refresh())
    before = live.visible_nodes()
    live.seek(4.08)
    assert live.loop.state().clock.is_paused
    live.do(SetRate(0))
    live.do(Play())
    while not live.playback.is_live:
        live.loop.turn()
    live.do(Refresh())
    assert live.visible_nodes() == before
    assert not live.loop.state().clock.is_paused


@pytest.fixture
def make() -> Iterator[Benches]:
    """A viewer of a path, of which messages arrived 5, 4, 3, 2 and 1 s ago."""
    with benches() as make_bench:

        def make(**options: Any) -> Bench:
            bench = make_bench(PathDisplay(), **options)
            now_s = time.monotonic()
            for ago in (5, 4, 3, 2, 1):
                publish(bench, ago, now_s=now_s)
            return bench

        yield make


@pytest.fixture
def bench(make: Benches) -> Bench:
    return make()


def publish(bench: Bench, ago_s: float, topic: str = "/path", now_s: float | None = None) -> None:
    pose = {"header": {"frame_id": "map"}, "pose": {"position": {"x": float(ago_s)}}}
    cdr = encode(PATH, {"header": {"frame_id": "map"}, "poses": [pose, pose]})
    now_s = now_s or time.monotonic()
    bench.source.topics.setdefault(topic, Offer((PUBLISHER,), type=PATH))
    bench.source.inbox.put(topic, Raw(cdr, bench.source.now - ns(ago_s), now_s - ago_s))
    bench.turn()


def rewind(bench: Bench, ago_s: float) -> PlaybackState:
    state = bench.do(Refresh()).playback
    assert state is not None
    return playback(bench.do(Seek((state.end_ns - state.start_ns) / 1e9 - ago_s)))


def playback(state: State) -> PlaybackState:
    assert state.playback is not None
    return state.playback


def places(bench: Bench) -> set[float]:
    """The x of what is drawn."""
    nodes = [node for _, _, node in bench.scene.visible() if isinstance(node, Lines)]
    return {float(x) for node in nodes for x in node.segments[..., 0].ravel()}


def test_new_messages_are_remembered_while_the_past_is_shown(bench: Bench) -> None:
    oldest_s = playback(bench.do(Refresh())).first_s
    assert rewind(bench, 3.5).is_live is False
    assert playback(bench.do(Refresh())).first_s == oldest_s
    assert places(bench) == {4.0}
    publish(bench, 0.5)
    assert places(bench) == {4.0}
    rewind(bench, 0.4)
    assert places(bench) == {0.5}
    assert playback(bench.do(ReturnToLive())).is_live
    publish(bench, 0)
    assert places(bench) == {0.0}


def test_steps_lead_into_the_past(bench: Bench) -> None:
    bench.do(StepMessage("/path", is_forward=False))
    assert places(bench) == {2.0}
    bench.do(StepMessage("/path", is_forward=False))
    assert places(bench) == {3.0}


def test_a_moment_that_is_shown_is_not_forgotten(make: Benches) -> None:
    bench = make(memory=MemorySettings(megabytes=0.002))
    first_s = rewind(bench, 1.5).first_s
    for _ in range(20):
        publish(bench, 0)
    state = playback(bench.do(Refresh()))
    assert (state.first_s, places(bench)) == (first_s, {2.0})
    assert playback(bench.do(ReturnToLive())).first_s > first_s


def test_nothing_is_remembered_without_a_memory(make: Benches) -> None:
    bench = make(memory=MemorySettings(seconds=0))
    assert bench.do(Refresh()).playback is None
    assert bench.refusal(Seek(0.0)) == MEMORY_OFF


def test_live_topics_are_not_played(bench: Bench) -> None:
    assert bench.refusal(Play()) == LIVE
    assert bench.do(Pause(True)).clock.is_paused
    assert rewind(bench, 1.5).is_playing is False
    assert not bench.do(ReturnToLive()).clock.is_paused


def test_a_topic_not_displayed_at_that_time_has_a_status(bench: Bench) -> None:
    rewind(bench, 1.5)
    bench.source.topics["/late"] = Offer((PUBLISHER,), type=PATH)
    bench.do(SetProperty(bench.states[-1].rows[0].id, "topic.name", "/late"))
    publish(bench, 0, "/late")
    assert bench.statuses()["Topic"] == (
        "WARN",
        "No message yet on /late: memory has none up to this moment; it holds displayed topics "
        "only, and drops the oldest messages first, large ones before others.",
    )


def test_time_that_went_back_is_shown_as_it_was(bench: Bench) -> None:
    """A simulator starts over 2.5 s ago."""
    bench.source.clock_count = 1
    bench.source.now = ns(3)
    publish(bench, 0.5)
    assert "Time went back" in bench.do(Refresh()).statuses["Time"].text
    rewind(bench, 3.5)
    assert bench.do(Refresh()).clock.ros_ns == ns(96)
    rewind(bench, 0.4)
    assert bench.do(Refresh()).clock.ros_ns == ns(2.5)


def test_nothing_is_sent_while_the_past_is_shown(make: Benches) -> None:
    graph = RememberingGraph()
    bench = make(graph=graph)
    restricted_graph, goal = bench.viewer.context.graph, Advertisement("/goal", PATH)
    restricted_graph.publish(goal, encode(PATH, {})).result()
    advertised = graph.advertised
    rewind(bench, 1.5)
    assert str(restricted_graph.publish(goal, encode(PATH, {})).exception()) == REWOUND
    assert restricted_graph.refusal("/any_service") == REWOUND
    assert graph.advertised == advertised, "publishers stay, so that none is missed afterwards"
    bench.do(ReturnToLive())
    restricted_graph.publish(goal, encode(PATH, {})).result()


def test_a_driven_vehicle_stops_first(make: Benches) -> None:
    graph = RememberingGraph()
    bench = make(graph=graph)
    controllers, advertisement = (
        bench.viewer.controllers,
        Advertisement("/cmd_vel", "geometry_msgs/msg/Twist"),
    )
    controllers.equip({"tool": (Teleop(acceleration=1000.0).vehicle, advertisement)})

    def drive() -> DrivingAnswer:
        return controllers.steer("tool", 1, Velocity(1.0, 0.0, 0.0), time.monotonic())

    drive()
    while not any(twist.linear.x for _, twist in graph.published):
        assert not drive().problem
        time.sleep(0.01)
    answer = bench.ask(Seek(-1.5))
    assert answer == STOPPED
    while graph.published[-1][1].linear.x:
        time.sleep(0.01)
    assert not controllers.halt(), "it stands still"


def remembering() -> tuple[HandFedSource, MemoryHistory, Player]:
    """A source whose topic /path is remembered for a minute, the memory, and its player."""
    source = HandFedSource()
    source.topics["/path"] = Offer((PUBLISHER,), type=PATH)
    memory = MemoryHistory(source)
    memory.recent.seconds, memory.recent.max_bytes = 60, 10**6
    source.inbox.read_along(lambda: memory.recent.put)
    player = Player(memory)
    player.want({"/path": Subscription(PATH, Topic("/path"))})
    return source, memory, player


def test_a_seek_looks_back_as_far_as_displays_need_now() -> None:
    source = HandFedSource()
    source.topics["/path"] = Offer((PUBLISHER,), type=PATH)
    player = Player(MemoryHistory(source))
    recent = player.memory.recent  # pyright: ignore[reportOptionalMemberAccess]
    recent.seconds, recent.max_bytes = 60, 10**6
    source.inbox.read_along(lambda: recent.put)
    short = Subscription(PATH, Topic("/path"))
    player.want({"/path": short})
    for ago_s in (5, 4, 3):
        source.inbox.put("/path", Raw(b"", 1, time.monotonic() - ago_s))
    player.want({"/path": replace(short, lookbacks=(Lookback(count=3),))})
    at_ns = player.history.end_ns - ns(2)
    player.jump(at_ns)
    player.play_until(at_ns)
    assert len(source.inbox.drain()["/path"]) == 3


@pytest.mark.parametrize(("ago_s", "is_live"), [(0.3, True), (0.31, False)])
def test_playback_that_reaches_now_is_live(ago_s: float, is_live: bool) -> None:
    source, memory, player = remembering()
    for back_s in (50, 40):
        source.inbox.put("/path", Raw(b"", 1, time.monotonic() - back_s))
    now_ns = memory.end_ns
    player.jump(now_ns - ns(20))
    player.play_until(now_ns - ns(20))
    player.play()
    player.advance()
    assert not player.is_live
    now_ns = memory.end_ns
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(type(memory), "end_ns", now_ns)
        player.play_until(now_ns - ns(ago_s))
        player.advance()
        assert player.is_live is is_live


def test_playback_stops_short_of_messages_not_in_memory_yet() -> None:
    source, memory, player = remembering()
    source.inbox.put("/path", Raw(b"", 1, time.monotonic() - 50))
    player.jump(memory.end_ns - ns(20))
    now_ns = memory.end_ns
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(type(memory), "end_ns", now_ns)
        player.play_until(now_ns)
        assert player.reached_ns == now_ns - NEARLY_NS


def test_a_recording_that_replaces_topics_on_the_way_back_to_now_waits_for_displays(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A return to now waits a while only; a recording waits however long it takes."""
    now_s = time.monotonic()
    monkeypatch.setattr("time.monotonic", lambda: now_s)
    source, memory, player = remembering()
    source.inbox.put("/path", Raw(b"", 1, now_s - 5))
    player.seek(memory.end_ns - ns(3))
    player.advance()
    player.return_to_live()
    assert player.is_seeking
    bag = BagHistory(strings(0, 100).write(tmp_path / "run"))
    player.show(bag)
    now_s += 10
    player.play()
    now_s += 0.1
    player.advance(is_busy=True)
    assert player.position_ns == bag.start_ns
    now_s += 0.1
    player.advance()
    assert player.position_ns == pytest.approx(bag.start_ns + ns(0.1), abs=2)
    player.close()


def test_ages_go_on_when_a_recording_replaces_topics_and_when_it_is_closed(
    tmp_path: Path,
) -> None:
    player = Player(MemoryHistory(HandFedSource()))
    begun_s, clock_s = time.monotonic(), player.clock()
    player.show(BagHistory(strings(0, 100).write(tmp_path / "run")))
    player.jump(player.history.start_ns + ns(30))
    player.play_until(player.history.start_ns + ns(30))
    passed_s = time.monotonic() - begun_s
    assert clock_s + 30 <= player.clock() <= clock_s + 30 + passed_s + 0.001
    player.return_to_live()
    passed_s = time.monotonic() - begun_s
    assert clock_s + 30 <= player.clock() <= clock_s + 30 + passed_s + 0.001
    player.close()


def test_a_moment_is_forgotten_once_a_recording_replaces_it(tmp_path: Path) -> None:
    source, memory, player = remembering()
    begun_ns = memory.end_ns
    source.inbox.put("/path", Raw(b"", 1, time.monotonic() - 50))
    player.jump(begun_ns - ns(20))
    source.inbox.put("/path", Raw(b"", 1, time.monotonic() + 59))  # forgets the other
    assert memory.start_ns < begun_ns - ns(40)
    player.show(BagHistory(strings(0, 100).write(tmp_path / "run")))
    assert memory.start_ns > begun_ns
    player.close()


def test_a_new_subscription_does_not_repeat_messages_read_by_a_seek() -> None:
    source = HandFedSource()
    latched = Publisher("/planner", PATH, "reliable", "transient_local")
    source.topics["/path"] = Offer((latched,), type=PATH)
    player = Player(MemoryHistory(source))
    recent = player.memory.recent  # pyright: ignore[reportOptionalMemberAccess]
    recent.seconds, recent.max_bytes = 60, 10**6
    source.inbox.read_along(lambda: recent.put)
    subscription = Subscription(PATH, Topic("/path"), lookbacks=(Lookback(count=1),))
    player.want({"/path": subscription})
    source.inbox.put("/path", Raw(b"", 1, time.monotonic() - 5))
    at_ns = player.history.end_ns - ns(2)
    player.jump(at_ns)
    player.play_until(at_ns)
    assert len(source.inbox.drain()["/path"]) == 1
    player.want({"/path": replace(subscription, resubscriptions=1)})
    assert source.inbox.drain() == {}
    player.want({"/path": replace(subscription, resubscriptions=2)})
    assert len(source.inbox.drain()["/path"]) == 1


def test_messages_received_since_the_last_read_are_read_once() -> None:
    source = HandFedSource()
    source.topics["/path"] = Offer((PUBLISHER,), type=PATH)
    memory = MemoryHistory(source)
    player, recent = Player(memory), memory.recent
    recent.seconds, recent.max_bytes = 60, 10**6
    source.inbox.read_along(lambda: recent.put)
    player.want({"/path": Subscription(PATH, Topic("/path"))})
    now_s = time.monotonic()
    source.inbox.put("/path", Raw(b"1", 1, now_s - 5))
    player.jump(memory.end_ns - ns(4))
    player.play_until(memory.end_ns - ns(4))
    assert not memory.refresh()
    source.inbox.put("/path", Raw(b"2", 1, now_s - 3))
    player.play_until(memory.end_ns - ns(2))
    assert [raw.cdr for raw in source.inbox.drain()["/path"]] == [b"1", b"2"]
    assert [raw.cdr for _, raw in memory.entries()] == [b"1", b"2"]


def test_a_recording_goes_on_while_the_past_is_shown(
    make: Benches, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    bench = make()
    bench.do(StartRecording("run"))
    rewind(bench, 2.5)
    publish(bench, 0)
    bench.do(ReturnToLive())
    publish(bench, 0)
    assert bench.ask(StopRecording()) == "Recorded 2 messages to run."


def test_the_timeline_counts_messages_in_memory_and_on_display(make: Benches) -> None:
    begun_s = time.monotonic()
    bench = make()

    def counted() -> tuple[float, list[int]]:
        state = bench.do(Refresh())
        assert state.playback is not None
        assert state.playback.counted is not None
        first_s, last_s = state.playback.counted
        assert len(state.recorded["/path"]) == round(last_s - first_s)
        return last_s - state.playback.first_s, list(state.recorded["/path"])

    length_s, counts = counted()
    assert 4.0 <= length_s <= 5.0 + time.monotonic() - begun_s
    assert counts[:5] == [1, 1, 1, 1, 1]
    assert not any(counts[5:])  # seconds that passed since
    rewind(bench, 3.5)
    bench.source.inbox.put("/path", Raw(b"", 0, time.monotonic() + 100.0))  # forgets the others
    assert counted()[1][: len(counts)] == counts


def test_the_timeline_marks_log_messages(make: Benches) -> None:
    bench = make()
    publisher = Publisher("/driver", LOG, "reliable", "transient_local")
    bench.source.topics[ROSOUT] = Offer((publisher,), type=LOG)
    bench.turn()
    now_s = time.monotonic()
    texts = (3.0, 20, "fine"), (2.0, 40, "lost track\nof it"), (1.0, 30, "late")
    for ago_s, level, text in texts:
        cdr = encode(LOG, {"level": level, "name": "amcl", "msg": text})
        bench.source.inbox.put(ROSOUT, Raw(cdr, bench.source.now, now_s - ago_s))

    def logged() -> list[tuple[int, str, str]]:
        state = bench.do(Refresh())
        return [
            (round(now_s - WallClock().arrived_s(event.at_ns)), event.level.name, event.text)
            for event in state.logged
        ]

    assert logged() == [(2, "ERROR", "lost track"), (1, "WARN", "late")]
    rewind(bench, 3.0)
    assert logged() == [(2, "ERROR", "lost track"), (1, "WARN", "late")]
