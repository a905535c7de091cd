"""New panels begin with what is remembered, of live topics, of their past and of bags."""

from __future__ import annotations

import time
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import pytest
from waiting import until

from tests.support.guest import Guest
from tests.support.memory_viewer import MemoryViewer
from webviz.commands import AddPanel, Pause, RemovePanel, ReturnToLive, Seek, SetPanelProperty
from webviz.engine.parts import panels
from webviz.panels.plot import Plot

X, Y = "/plan.poses[1].pose.position.x", "/plan.poses[1].pose.position.y"


@pytest.fixture(scope="module")
def memory() -> Iterator[MemoryViewer]:
    memory = MemoryViewer()
    yield memory
    memory.close()


@pytest.fixture(autouse=True)
def live(memory: MemoryViewer) -> Iterator[Guest]:
    """A page, without panels before and after."""
    page = memory.enter()
    until(lambda: memory.memory.recent.size()[0] > 4.0)
    yield page
    page.close()
    memory.guests.remove(page)
    for tab in memory.viewer.fact("panels"):
        memory.viewer.do(RemovePanel(tab.id))
    memory.viewer.do(ReturnToLive())


def panel(memory: MemoryViewer) -> Any:
    return memory.viewer.fact("panels")[-1].panel


def add(memory: MemoryViewer, page: Guest, kind: str, **values: Any) -> Any:
    memory.viewer.do(AddPanel(kind, values))
    page.send("Watch", store=f"panel:{kind}")
    return panel(memory)


def span_s(plot: Any, name: str) -> float:
    series = plot.series.get(name)
    times = [point[0] for point in series.history.points()] if series else []
    return times[-1] - times[0] if times else 0.0


def test_a_plot_of_a_live_topic_begins_with_the_memory(memory: MemoryViewer, live: Guest) -> None:
    plot = add(memory, live, "Plot", curves=[X])
    until(lambda: span_s(plot, X) > 3.0, seconds=2.0)


def test_a_curve_of_a_topic_that_is_plotted_begins_with_it_too(
    memory: MemoryViewer, live: Guest
) -> None:
    plot = add(memory, live, "Plot", curves=[X])
    until(lambda: span_s(plot, X) > 3.0)
    before = span_s(plot, X)
    memory.viewer.do(SetPanelProperty("Plot", "curves", [X, Y]))
    until(lambda: span_s(plot, Y) > 3.0, seconds=2.0)
    assert span_s(plot, X) >= before
    times = [point[0] for point in plot.series[X].history.points()]
    assert times == sorted(set(times))


def test_a_plot_added_while_rewound_is_filled_with_earlier_messages(
    memory: MemoryViewer, live: Guest
) -> None:
    playback = memory.viewer.fact("playback")
    at_s = (playback.end_ns - playback.start_ns) / 1e9 - 0.5
    memory.viewer.do(Seek(at_s))
    memory.viewer.do(Pause())
    plot = add(memory, live, "Plot", curves=[X])
    until(lambda: span_s(plot, X) > 3.0, seconds=2.0)
    newest_s = plot.series[X].history.newest[0]
    assert newest_s <= playback.start_ns / 1e9 + at_s + 0.01


def test_a_plot_that_comes_back_to_the_front_fills_its_gap(
    memory: MemoryViewer, live: Guest
) -> None:
    plot = add(memory, live, "Plot", curves=[X])
    until(lambda: span_s(plot, X) > 3.0)
    live.send("Unwatch", store="panel:Plot")
    hidden_s = time.time()
    time.sleep(2.0)
    live.send("Watch", store="panel:Plot")

    def steps_s() -> list[float]:
        times = [point[0] for point in plot.series[X].history.points()]
        since = [each for each in times if each > hidden_s - 1.0]
        return [b - a for a, b in pairwise(since)] if since and since[-1] > hidden_s + 2.0 else []

    until(lambda: steps_s() and max(steps_s()) < 0.8, lambda: f"{steps_s()}", seconds=5.0)


def test_states_begin_with_the_memory(memory: MemoryViewer, live: Guest) -> None:
    states = add(memory, live, "StateTimeline", paths=[X])
    until(lambda: states.tracks.get(X) and len(states.tracks[X].changes) > 40, seconds=2.0)


def test_a_table_begins_with_the_newest_message(memory: MemoryViewer, live: Guest) -> None:
    memory.pause()
    table = add(memory, live, "MessageTable", path="/plan.poses")
    try:
        until(lambda: table.values, seconds=2.0)
    finally:
        memory.resume()


def test_the_messages_that_fill_a_new_panel_are_bounded(
    memory: MemoryViewer, live: Guest, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(panels, "MAX_MESSAGES", 7)
    begins = memory.viewer.fact("panels")
    assert begins == ()
    stamps: list[int] = []
    take = Plot.take

    def count(
        self: Plot, topic: str, message: Any, received_ns: int, *, is_past: bool = False
    ) -> None:
        if is_past:
            stamps.append(received_ns)
        take(self, topic, message, received_ns, is_past=is_past)

    monkeypatch.setattr(Plot, "take", count)
    plot = add(memory, live, "Plot", curves=[X])
    until(lambda: X in plot.series and plot.series[X].history.newest)
    assert len(stamps) == 7
    assert stamps == sorted(stamps)
