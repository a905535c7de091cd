"""Large messages are folded and drawn in a thread, while the frame loop goes on."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from typing import Annotated, Any

import numpy as np
import pytest
from bench import Bench, Benches
from dots import T
from waiting import until

from webviz import Context, Display, Input, Sample, Topic
from webviz.api.nodes import Points
from webviz.commands import SetFixedFrame, SetProperty
from webviz.data.messages import MessageTypes, decode, encode
from webviz.engine.pipeline import folding
from webviz.engine.pipeline.folding import MAX_BYTES
from webviz.shell.testing.messages import header

GRID = "nav_msgs/msg/OccupancyGrid"
gates: list[threading.Event] = []
"""One for each message in the order they are worked on; work waits until its gate is open."""


def wait_at_gate() -> None:
    gate = threading.Event()
    gates.append(gate)
    assert gate.wait(60)


class SceneDiff(Display):
    """A dot at the width of the map it is drawn of."""

    is_threaded = True
    topic: Annotated[Topic, Input(GRID)] = Topic("/map")
    height: float = 0.0

    def draw(self, sample: Sample, ctx: Context) -> None:
        if len(sample.message.data) >= Display.slow_bytes:
            wait_at_gate()
        if sample.message.info.width == 13:
            raise ValueError("thirteen")
        ctx.points("dot", [[sample.message.info.width, 0, self.height]], (1, 1, 1), 0.1)


class Folding(Display):
    """A dot at the sum of all widths."""

    is_threaded = True
    topic: Annotated[Topic, Input(GRID)] = Topic("/map")

    def fold(self, name: str, sample: Sample, state: tuple[int, ...] | None) -> tuple[int, ...]:
        if len(sample.message.data) >= Display.slow_bytes:
            wait_at_gate()
        return (*(state or ()), sample.message.info.width)

    def draw(self, sample: Sample, ctx: Context) -> None:
        ctx.points("dots", [[width, 0, 0] for width in sample.message], (1, 1, 1), 0.1)


@pytest.fixture(autouse=True)
def all_gates_are_open_at_the_end(bench: Bench) -> Iterator[None]:
    gates.clear()
    yield
    for gate in gates:
        gate.set()


def send(at: Bench, number: int, size: int = Display.slow_bytes, frame: str = "map") -> None:
    """Publish a map that says which it is by its width."""
    values = {"header": header(frame, T), "info": {"width": number}, "data": np.zeros(size, "i1")}
    at.source.put("/map", GRID, encode(GRID, values))
    at.turn()


def dots(at: Bench) -> list[list[float]]:
    return [
        (row + pose.position).tolist()
        for _, pose, node in at.scene.visible()
        if isinstance(node, Points)
        for row in node.xyz
    ]


def open_gate(at: Bench, number: int) -> None:
    """Let the work on a message end, once it has begun."""
    until(lambda: len(gates) > number, turn=at.turn)
    gates[number].set()


def test_the_loop_goes_on_while_a_large_message_is_drawn_and_then_shows_it(bench: Benches) -> None:
    at = bench(SceneDiff())
    send(at, 1)
    until(lambda: gates, turn=at.turn)
    assert dots(at) == []
    assert at.statuses()["Loading"] == ("IDLE", "Loading a message of 8 MB.")
    assert "Display" not in at.statuses()
    assert at.viewer.is_busy()
    open_gate(at, 0)
    until(lambda: dots(at) == [[1, 0, 0]], turn=at.turn)
    assert "Loading" not in at.statuses()
    assert not at.viewer.is_busy()


def test_the_previous_drawing_stays_and_only_the_newest_message_waits(
    bench: Benches,
) -> None:
    at = bench(SceneDiff())
    send(at, 1)
    open_gate(at, 0)
    until(lambda: dots(at) == [[1, 0, 0]], turn=at.turn)
    for number in (2, 3, 4):
        send(at, number)
    until(lambda: len(gates) == 2, turn=at.turn)
    assert dots(at) == [[1, 0, 0]]
    assert at.statuses()["Loading"][0] == "OK"
    open_gate(at, 1)
    until(lambda: len(gates) == 3, turn=at.turn)
    assert dots(at) == [[2, 0, 0]]  # begun before the others came, and so not in vain
    open_gate(at, 2)
    until(lambda: dots(at) == [[4, 0, 0]], turn=at.turn)
    assert len(gates) == 3


def test_a_property_changed_meanwhile_redraws_a_large_message(bench: Benches) -> None:
    at = bench(SceneDiff())
    send(at, 1)
    until(lambda: gates, turn=at.turn)
    at.viewer.enqueue(SetProperty("display1", "height", 5.0))
    at.turn()
    open_gate(at, 0)
    open_gate(at, 1)
    until(lambda: dots(at) == [[1, 0, 5]], turn=at.turn)


def test_nothing_is_shown_of_work_that_a_change_has_made_wrong(bench: Benches) -> None:
    """Another fixed frame, or a display that was switched off."""
    at = bench(SceneDiff())
    at.transform("odom", "map", T, 10.0, static=True)
    send(at, 1)
    until(lambda: gates, turn=at.turn)
    at.viewer.enqueue(SetFixedFrame("odom"))
    at.turn()
    open_gate(at, 0)
    until(lambda: len(gates) == 2, turn=at.turn)
    assert dots(at) == []
    open_gate(at, 1)
    until(lambda: dots(at) == [[11, 0, 0]], turn=at.turn)
    send(at, 2)
    until(lambda: len(gates) == 3, turn=at.turn)
    at.viewer.enqueue(SetProperty("display1", "enabled", False))
    open_gate(at, 2)
    until(lambda: not at.viewer.is_busy(), turn=at.turn)
    assert dots(at) == []


def test_an_exception_of_a_thread_is_a_fault_of_its_display_and_not_retried(
    bench: Benches,
) -> None:
    at = bench(SceneDiff(), strict=False)
    send(at, 13)
    open_gate(at, 0)
    until(lambda: "thirteen" in str(at.statuses()), turn=at.turn)
    for _ in range(3):
        at.turn()
    assert len(gates) == 1
    send(at, 1, size=1)
    assert dots(at) == [[1, 0, 0]]


def test_messages_wait_for_a_large_one_that_is_folded_in_a_thread(bench: Benches) -> None:
    at = bench(Folding())
    send(at, 1)
    send(at, 2, size=1)
    until(lambda: gates, turn=at.turn)
    assert at.statuses()["Loading"] == ("IDLE", "Loading a message of 8 MB.")
    assert dots(at) == []
    at.scene.watched = False  # all are folded, watched or not
    open_gate(at, 0)
    until(lambda: not at.viewer.is_busy(), turn=at.turn)
    at.scene.watched = True
    send(at, 3, size=1)
    assert [x for x, _, _ in dots(at)] == [1, 2, 3]


def test_messages_that_wait_too_long_are_dropped_counted_and_reported(bench: Benches) -> None:
    at = bench(Folding())
    for number in range(1, 5):
        send(at, number, size=Display.slow_bytes if number == 1 else MAX_BYTES // 2 - 1000)
    assert "1 message dropped" in at.statuses()["Message"][1]
    for number in range(3):
        open_gate(at, number)
    until(lambda: not at.viewer.is_busy(), turn=at.turn)
    assert [x for x, _, _ in dots(at)] == [1, 3, 4]


class Unthreaded(Display):
    """A dot at the sum of all widths, and the threads that added them."""

    topic: Annotated[Topic, Input(GRID)] = Topic("/map")

    def fold(self, name: str, sample: Sample, state: tuple[int, ...] | None) -> tuple[int, ...]:
        assert threading.current_thread() is threading.main_thread()
        return (*(state or ()), sample.message.info.width)

    def draw(self, sample: Sample, ctx: Context) -> None:
        ctx.points("dots", [[width, 0, 0] for width in sample.message], (1, 1, 1), 0.1)


def test_large_messages_are_decoded_in_a_thread_also_if_they_are_folded_by_the_loop(
    bench: Benches, monkeypatch: pytest.MonkeyPatch
) -> None:
    def decode_at_gate(type_name: str, cdr: bytes, types: MessageTypes) -> Any:
        if len(cdr) >= Display.slow_bytes:
            wait_at_gate()
        return decode(type_name, cdr, types)

    monkeypatch.setattr(folding, "decode", decode_at_gate)
    at = bench(Unthreaded())
    send(at, 1)
    send(at, 2, size=1)
    until(lambda: gates, turn=at.turn)
    assert (dots(at), at.viewer.is_busy()) == ([], True)
    open_gate(at, 0)
    until(lambda: [x for x, _, _ in dots(at)] == [1, 2], turn=at.turn)
    assert not at.viewer.is_busy()


def test_a_large_message_that_a_thread_cannot_decode_is_reported(bench: Benches) -> None:
    at = bench(Unthreaded())
    at.source.put("/map", GRID, bytes(4) + Display.slow_bytes * b"\xff")
    until(lambda: "Message" in at.statuses(), turn=at.turn)
    assert at.statuses()["Message"][0] == "ERROR"
    send(at, 2, size=1)
    assert [x for x, _, _ in dots(at)] == [2]


class Steps(Display):
    """A dot more in each turn, up to three."""

    topic: Annotated[Topic, Input(GRID)] = Topic("/map")

    def new_state(self) -> list[int]:
        return []

    def depends(self, ctx: Context) -> object:
        ctx.state.append(len(ctx.state))
        ctx.is_unfinished = len(ctx.state) < 3
        return None


def test_a_drawing_in_parts_keeps_the_loop_awake_until_it_is_complete(bench: Benches) -> None:
    at = bench(Steps())
    arrived = at.source.inbox.arrived
    for is_unfinished in (True, False):
        arrived.clear()
        at.turn()
        assert (at.viewer.is_busy(), arrived.is_set()) == (is_unfinished, is_unfinished)
