"""History of a display: bounded in bytes, and reported when less than asked for."""

from __future__ import annotations

from typing import Annotated

import pytest
from bench import Bench, Benches
from dots import SECOND, T

from webviz import Context, Display, Input, Keep, Prop, Sample, Topic
from webviz.api.nodes import Points
from webviz.commands import RemoveDisplay, SetProperty
from webviz.engine.pipeline import history


class Note(Display):
    """A dot for every text, as far along as the text is long."""

    topic: Annotated[Topic, Input("std_msgs/msg/String")] = Topic("/note")
    count: Annotated[int, Prop(ge=0)] = 1
    seconds: Annotated[float, Prop(ge=0)] = 0.0

    def history(self) -> Keep:
        return Keep(self.count, self.seconds)

    def draw(self, sample: Sample, ctx: Context) -> None:
        ctx.points("dot", [[len(sample.message.data), 0, 0]], (255, 0, 0), 0.1)


@pytest.fixture(autouse=True)
def limit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(history, "MAX_BYTES", 2_000_000)


def lengths(bench: Bench) -> list[int]:
    return [round(float(node.xyz[0][0])) for node in bench.nodes(Points)]


def note(bench: Bench, length: int, second: float, topic: str = "/note") -> None:
    bench.source.now = T + round(second * SECOND)
    bench.publish(topic, "std_msgs/msg/String", {"data": "x" * length})
    bench.turn()


def test_the_oldest_go_when_messages_take_too_many_bytes(bench: Benches) -> None:
    b = bench(Note(name="Note", count=0, seconds=10.0))
    for second in range(6):
        note(b, 600_000 + second, second)
    assert sorted(lengths(b)) == [600_003, 600_004, 600_005]
    assert b.statuses()["History"] == ("WARN", "Keeps 2.0 of 10 s: limit of 2 MB for all displays.")


def test_the_newest_stays_however_large_it_is(bench: Benches) -> None:
    b = bench(Note(name="Note", count=5))
    note(b, 1000, 0)
    note(b, 3_000_000, 1)
    assert lengths(b) == [3_000_000]
    assert b.statuses()["History"] == (
        "WARN",
        "Keeps 1 of 5 messages: limit of 2 MB for all displays.",
    )
    note(b, 1001, 2)
    assert lengths(b) == [1001]


def test_displays_share_the_limit_and_the_largest_history_drops_its_oldest(bench: Benches) -> None:
    more = Note(name="More", count=0, seconds=10.0, topic=Topic("/more"))
    newest = Note(name="Newest", topic=Topic("/newest"))
    b = bench(Note(name="Note", count=0, seconds=10.0), more, newest)
    for second in range(3):
        note(b, 600_000 + second, second)
    note(b, 1_900_000, 3, "/newest")  # which counts for nothing
    note(b, 300_000, 4, "/more")
    note(b, 300_001, 5, "/more")
    assert sorted(lengths(b)) == [300_000, 300_001, 600_001, 600_002, 1_900_000]
    assert b.statuses()["History"] == ("WARN", "Keeps 4.0 of 10 s: limit of 2 MB for all displays.")
    assert "History" not in b.statuses(1)
    b.viewer.enqueue(SetProperty(b.states[-1].rows[0].id, "enabled", False))
    b.viewer.enqueue(RemoveDisplay(b.states[-1].rows[0].id))
    b.turn()
    for second in range(4):
        note(b, 300_010 + second, 6 + second, "/more")
    assert sorted(lengths(b))[:-1] == [300_000, 300_001, *range(300_010, 300_014)]


def test_a_complete_history_has_no_status(bench: Benches) -> None:
    b = bench(Note(name="Note", count=0, seconds=10.0))
    for second in range(6):
        note(b, 600_000, second)
    b.viewer.enqueue(SetProperty(b.states[-1].rows[0].id, "seconds", 1.5))
    note(b, 1000, 6)
    assert sorted(lengths(b)) == [1000, 600_000]
    assert "History" not in b.statuses()


def test_longer_than_any_clock_is_for_ever(bench: Benches) -> None:
    b = bench(Note(name="Note", count=0, seconds=1e308))
    note(b, 1, 0)
    note(b, 2, 1000)
    assert sorted(lengths(b)) == [1, 2]


class TwoNotes(Note):
    """Another dot for every text of another topic."""

    other: Annotated[Topic, Input("std_msgs/msg/String")] = Topic("/other")


def test_inputs_share_the_number_of_samples(
    bench: Benches, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(history, "MAX_SAMPLES", 5)
    b = bench(TwoNotes(name="TwoNotes", count=0, seconds=100.0))
    for second in range(4):
        note(b, 10 + second, second)
        note(b, 20 + second, second, "/other")
    assert sorted(lengths(b)) == [12, 13, 22, 23]


def test_a_display_of_single_messages_has_no_history_status(bench: Benches) -> None:
    b = bench(Note(name="Note"))
    for second in range(6):
        note(b, 900_000, second)
    assert "History" not in b.statuses()
