"""Topics of displays that follow a protocol of their own."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import pytest

from webviz.engine.pipeline import wire
from webviz.engine.pipeline.wire import DisplayWire
from webviz.engine.sources import Raw

WORDS = "/words"


@pytest.fixture
def heard() -> DisplayWire:
    """A wire on which a display listens to a topic."""
    services = cast(Any, SimpleNamespace(resolve=lambda name: name))
    made = DisplayWire(services, cast(Any, None))
    listen(made)
    return made


def listen(made: DisplayWire) -> tuple[list[int], bool]:
    """Sizes of the messages since the last call, and whether others were missed before them."""
    found = made.listen(WORDS, "std_msgs/msg/String", 10)
    return [len(each) for each in found.messages], found.has_gap


def take(made: DisplayWire, *sizes: int) -> None:
    made.take({WORDS: [Raw(bytes(size), 0) for size in sizes]}, {})


@pytest.mark.parametrize(("limit", "number"), [("LIMIT", 3), ("MAX_BYTES", 100)])
def test_what_waits_for_a_display_is_bounded_and_the_gap_is_said(
    heard: DisplayWire, monkeypatch: pytest.MonkeyPatch, limit: str, number: int
) -> None:
    monkeypatch.setattr(wire, limit, number)
    take(heard, 30, 30, 30)
    assert listen(heard) == ([30, 30, 30], False)
    take(heard, 30, 30)
    take(heard, 30, 30)
    take(heard, 30)  # of no use after the gap
    assert listen(heard) == ([], True)
    take(heard, 30)
    assert listen(heard) == ([30], False)


def test_one_message_is_kept_however_large(
    heard: DisplayWire, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(wire, "MAX_BYTES", 100)
    take(heard, 1000)
    assert listen(heard) == ([1000], False)
