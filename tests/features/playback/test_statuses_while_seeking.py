"""Statuses on the way to a position, where messages are still read."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from bags import START_NS, ns
from drives import recorded

from tests.features.playback.conftest import LiveDrive
from webviz.api.status import LOADING, Status
from webviz.engine.loop import FrameLoop
from webviz.engine.parts.displays import DisplaysPart
from webviz.engine.parts.time import TimePart
from webviz.engine.pipeline.runner import WORKING


def statuses(loop: FrameLoop) -> dict[str, Mapping[str, Status]]:
    """Return the statuses of the viewer (""), and of each display by its id."""
    state = loop.state()
    return {"": state.statuses, **{row.id: row.statuses for row in state.rows}}


def test_statuses_stay_until_the_position_is_reached(drive: Callable[..., LiveDrive]) -> None:
    live = drive(recorded(1))
    playback, displays = live.loop.get(TimePart), live.loop.get(DisplaysPart)
    player = playback.context.player
    for at_s in (3.78, 0.58, 5.58):
        before = statuses(live.loop)
        player.seek(START_NS + ns(at_s))
        playback.advance(is_busy=False)
        assert player.is_seeking
        assert statuses(live.loop) == before, "nothing has arrived that would say otherwise"
        added: list[str] = []
        displays.add_display("Path", {"topic": "/nowhere"}, made=added.append)
        assert statuses(live.loop)[added[0]] == {LOADING: WORKING}
        live.seek(at_s)
        assert "/nowhere" in str(statuses(live.loop)[added[0]])
