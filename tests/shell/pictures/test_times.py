"""Times of a bag as people write them."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from webviz.shell.pictures.times import TimeError, every, position_ns, read_at

START_NS = 1_700_000_000_123_456_789


@dataclass
class Span:
    start_ns: int = START_NS
    end_ns: int = START_NS + 46_202_568_732


@pytest.mark.parametrize(
    ("text", "seconds"),
    [
        ("0", 0),
        ("12.5", 12.5),
        ("start", 0),
        ("end", 46.202568732),
        ("46.202568", 46.202568),
        ("1700000010.123456789", 10),
    ],
)
def test_a_time_is_a_place_in_the_bag(text: str, seconds: float) -> None:
    position = position_ns(read_at(text), Span(), "run.mcap")
    assert position - START_NS == pytest.approx(seconds * 1e9, abs=500)


@pytest.mark.parametrize("at", [-0.5, 46.3, 99, 1.6e9, 1.8e9])
def test_a_time_outside_of_the_bag_is_refused_with_the_range(at: float) -> None:
    with pytest.raises(TimeError) as excinfo:
        position_ns(at, Span(), "run.mcap")
    assert "is outside of run.mcap. Give 0 to 46.202 s" in str(excinfo.value)
    assert "1700000000.123 to 1700000046.326" in str(excinfo.value)


@pytest.mark.parametrize("text", ["", "soon", "nan", "inf", "1,5", "End"])
def test_invalid_texts_of_times_are_refused(text: str) -> None:
    with pytest.raises(TimeError, match="is not a valid time"):
        read_at(text)


@pytest.mark.parametrize("at", [float("nan"), float("inf")])
def test_numbers_outside_of_times_are_refused(at: float) -> None:
    with pytest.raises(TimeError, match="is not a valid time"):
        position_ns(at, Span(), "run.mcap")


def test_times_at_equal_distances_end_where_they_should() -> None:
    assert every("start", 1, 0.25, Span(), "run") == [0, 0.25, 0.5, 0.75, 1]
    assert every(45, "end", 1, Span(), "run") == pytest.approx([45, 46])
    assert every(3, 3, 1, Span(), "run") == [3]


def test_times_that_go_backwards_are_refused() -> None:
    with pytest.raises(TimeError, match="Swap them"):
        every(5, 3, 1, Span(), "run")


def test_too_many_pictures_are_refused() -> None:
    with pytest.raises(TimeError, match="That makes 46203 pictures; the limit is 2000"):
        every("start", "end", 0.001, Span(), "run")
