"""Messages meet by stamp: against every combination tried in turn."""

from __future__ import annotations

import itertools

import pytest
from hypothesis import given
from hypothesis import strategies as st

from webviz.engine.pipeline.synchronizer import Gap, Synchronizer

QUEUE = 4


class EveryCombination:
    """The same rules, by trying each combination of messages."""

    def __init__(self, inputs: str, slop_ns: int) -> None:
        self.queues: dict[str, list[tuple[int, int]]] = {name: [] for name in inputs}
        self.slop_ns = slop_ns

    def add(self, name: str, stamp: int, number: int) -> dict[str, int] | None:
        queue = [item for item in self.queues[name] if item[0] != stamp]
        self.queues[name] = [*queue, (stamp, number)]
        combinations = itertools.product(
            *([(stamp, number)] if each == name else q for each, q in self.queues.items())
        )
        fitting = [
            (sum(abs(s - stamp) for s, _ in items), [s for s, _ in items], items)
            for items in combinations
            if max(items)[0] - min(items)[0] <= self.slop_ns
        ]
        if not fitting:
            self.queues[name] = self.queues[name][-QUEUE:]
            return None
        chosen = dict(zip(self.queues, min(fitting)[2], strict=True))
        for each, (s, _) in chosen.items():
            self.queues[each] = [item for item in self.queues[each] if item[0] > s]
        return {each: n for each, (_, n) in chosen.items()}


@given(
    inputs=st.sampled_from(["ab", "abc", "abcd"]),
    slop_ns=st.sampled_from([0, 1, 3, 10]),
    messages=st.lists(st.tuples(st.integers(0, 3), st.integers(0, 12)), max_size=60),
)
def test_sets_are_those_that_trying_every_combination_finds(
    inputs: str, slop_ns: int, messages: list[tuple[int, int]]
) -> None:
    ours: Synchronizer[int] = Synchronizer(inputs, slop_ns, QUEUE)
    reference = EveryCombination(inputs, slop_ns)
    used = 0
    for number, (place, stamp) in enumerate(messages):
        name = inputs[place % len(inputs)]
        result = ours.add(name, stamp, number)
        assert result == reference.add(name, stamp, number)
        used += len(result or {})
        waiting = {each: len(queue) for each, queue in reference.queues.items()}
        assert max(waiting.values()) <= QUEUE
        assert ours.dropped == number + 1 - used - sum(waiting.values())


@pytest.mark.parametrize(
    ("messages", "gap"),
    [
        ("", None),
        ("a5", Gap("a", 5, "b", None)),
        ("a5 b3", Gap("a", 5, "b", -2)),
        ("a5 b5 a6 b9", Gap("b", 9, "a", -3)),
        ("a5 b5 a6", Gap("a", 6, "b", -1)),
        ("a5 b5", None),
    ],
)
def test_a_gap_names_the_input_that_is_waited_for(messages: str, gap: Gap | None) -> None:
    synchronizer: Synchronizer[str] = Synchronizer("ab")
    for message in messages.split():
        synchronizer.add(message[0], int(message[1]), message)
    assert synchronizer.gap() == gap


def test_stamps_that_start_over_are_matched_while_later_ones_still_wait() -> None:
    synchronizer: Synchronizer[str] = Synchronizer("ab", queue_size=QUEUE)
    for stamp in range(100, 100 + QUEUE):
        synchronizer.add("a", stamp, "before")
    assert synchronizer.add("a", 1, "after") is None
    assert synchronizer.add("b", 1, "after") == {"a": "after", "b": "after"}
