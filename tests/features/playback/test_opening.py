"""Recordings that are shown in the place of live topics for a while."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from pathlib import Path

import pytest
from bags import START_NS
from bench import benches
from drives import CONFIG, recorded

from tests.features.playback.conftest import LiveDrive
from webviz.api.errors import Error
from webviz.commands import OpenRecording, Pause, Refresh, ReturnToLive, SaveMemory, Seek
from webviz.data.messages import encode
from webviz.engine.commands import Command, Sender
from webviz.engine.parts.time import REWOUND
from webviz.features.bags import NO_LIVE
from webviz.features.black_box.saved import FOLDER
from webviz.files.config.model import MemorySettings
from webviz.shell.testing import BagViewer
from webviz.shell.testing.remembering_graph import RememberingGraph
from webviz.sources import Advertisement, Raw

STEADY = """\
fixed_frame: map
displays:
- {type: Odometry, keep: 7}
- {type: Map}
- {type: LaserScan, decay_time: 0.3}
- {type: Path, buffer_length: 3}
"""


def refusal(drive: LiveDrive, command: Command, sender: Sender) -> str:
    answer = drive.loop.enqueue(command, sender)
    for _ in range(1000):
        drive.loop.turn()
        if answer.done():
            return str(answer.exception())
        drive.source.inbox.arrived.wait(0.005)
    raise AssertionError("not done")


def test_an_opened_recording_is_played_like_a_bag_and_live_topics_come_back(
    drive: Callable[..., LiveDrive],
) -> None:
    live = drive(recorded(4), STEADY)
    live.do(Refresh())
    before = live.visible_nodes()
    live.do(SaveMemory(path="saved"))
    with contextlib.closing(BagViewer(Path("saved"), STEADY)) as played:
        start_s = (played.source.history.start_ns - START_NS) / 1e9
        truth = {}
        for at_s in (0.58, 2.08, 3.78):
            played.play_to(at_s - start_s)
            played.settle()
            truth[at_s] = played.visible_nodes()

    live.do(OpenRecording("saved"))
    live.do(Pause(True))
    assert live.playback.is_live is None
    assert live.playback.is_opened
    assert live.playback.names == ("saved",)
    for at_s in (3.78, 0.58, 2.08):
        live.do(Seek(at_s - start_s))
        assert live.visible_nodes() == truth[at_s], at_s

    live.do(ReturnToLive())
    assert live.playback.is_live
    assert not live.playback.is_opened
    assert live.playback.names == ()
    assert live.visible_nodes() == before


def test_topics_stay_subscribed_to_and_remembered_while_a_recording_is_shown(
    drive: Callable[..., LiveDrive],
) -> None:
    live = drive(recorded(4), STEADY)
    live.do(SaveMemory(path="saved"))
    expected = live.source.subscriptions
    live.do(OpenRecording("saved"))
    live.do(Seek(1.0))
    live.do(Seek(0.5))
    assert live.source.subscriptions == expected, (
        "nothing is asked for again, so that nothing is missed"
    )

    def remembered() -> int:
        memory = live.loop.state().memory
        assert memory is not None
        return memory.size

    before = remembered()
    *_, last = live.files.messages([c for c in live.files.channels if c.topic == "/odom"], 0)
    live.source.inbox.put("/odom", Raw(last.cdr, live.source.now_ns()))
    assert not live.source.inbox.drain(), "it is not queued, since the bag is shown"
    assert remembered() > before
    live.do(SaveMemory(path="other"))
    live.do(OpenRecording("other"))
    assert live.playback.names == ("other",)
    live.do(ReturnToLive())
    assert live.playback.is_live


def test_nothing_is_sent_while_a_recording_is_shown(tmp_path: Path) -> None:
    path = recorded(4).write(tmp_path / "run")
    graph = RememberingGraph()
    with benches() as make:
        bench = make(graph=graph, memory=MemorySettings(seconds=0))
        restricted_graph, goal = (
            bench.viewer.context.graph,
            Advertisement("/goal", "std_msgs/msg/Bool"),
        )
        cdr = encode("std_msgs/msg/Bool", {"data": True})
        bench.do(OpenRecording(str(path)))
        assert str(restricted_graph.publish(goal, cdr).exception()) == REWOUND
        bench.do(ReturnToLive())
        restricted_graph.publish(goal, cdr).result()
        assert bench.viewer.context.player.inbox is bench.source.inbox, "live without any memory"


def test_a_page_opens_no_other_recordings_than_those_of_the_black_box(
    drive: Callable[..., LiveDrive],
) -> None:
    live = drive(recorded(4))
    live.do(SaveMemory(path="saved"))
    Path(FOLDER).mkdir()
    live.do(SaveMemory(path=f"{FOLDER}/one"))
    page = Sender(1)
    for path in ("saved", f"{FOLDER}/../saved", FOLDER, "/"):
        assert refusal(live, OpenRecording(path), page) == (
            "Not opened: pages open bags of the library and those that this viewer wrote. Start "
            "webviz with --library to name its folder."
        )
    assert refusal(live, OpenRecording(str(Path(FOLDER).absolute() / "one")), page) == "None"
    assert live.playback.names == ("one",)


def test_a_failed_opening_changes_nothing(drive: Callable[..., LiveDrive]) -> None:
    live = drive(recorded(4))
    with pytest.raises(Error, match=r"does not exist|not found|No such"):
        live.do(OpenRecording("missing"))
    assert live.playback.is_live


def test_a_bag_is_not_replaced(theater: Callable[..., BagViewer]) -> None:
    with pytest.raises(Error) as excinfo:
        theater(recorded(4), CONFIG).do(OpenRecording("other"))
    assert str(excinfo.value) == NO_LIVE
