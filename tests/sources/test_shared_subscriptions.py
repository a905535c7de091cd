"""One subscription for all readers of a topic."""

from __future__ import annotations

from typing import Literal

import pytest

from webviz.api.declared import Topic
from webviz.sources import Subscription
from webviz.sources.source import merged

TYPE, OTHER = "std_msgs/msg/String", "std_msgs/msg/Bool"


def shared(*subscriptions: Subscription) -> Subscription:
    """The subscription of readers, in this order."""
    return merged({"/a": subscription} for subscription in subscriptions)["/a"]


Reliability = Literal["auto", "reliable", "best_effort"]
Durability = Literal["auto", "volatile", "transient_local"]


@pytest.mark.parametrize(
    ("first", "second", "expected"),
    [
        ("auto", "auto", "auto"),
        ("reliable", "reliable", "reliable"),
        ("best_effort", "best_effort", "best_effort"),
        ("auto", "best_effort", "best_effort"),
        ("auto", "reliable", "auto"),
        ("reliable", "best_effort", "auto"),
    ],
)
def test_readers_share_a_reliability_that_serves_all(
    first: Reliability, second: Reliability, expected: Reliability
) -> None:
    subscriptions = [Subscription(TYPE, Topic("/a", reliability=each)) for each in (first, second)]
    for order in (subscriptions, subscriptions[::-1]):
        assert shared(*order).topic.reliability == expected


@pytest.mark.parametrize(
    ("first", "second", "expected"),
    [
        (("auto", True), ("auto", True), ("auto", True)),
        (("volatile", False), ("volatile", False), ("volatile", False)),
        (("auto", True), ("auto", False), ("auto", False)),
        (("volatile", False), ("transient_local", False), ("auto", False)),
        (("volatile", True), ("auto", True), ("auto", False)),
    ],
)
def test_readers_that_disagree_on_durability_follow_the_publishers(
    first: tuple[Durability, bool],
    second: tuple[Durability, bool],
    expected: tuple[Durability, bool],
) -> None:
    subscriptions = [
        Subscription(TYPE, Topic("/a", durability=durability), latched=latched)
        for durability, latched in (first, second)
    ]
    for order in (subscriptions, subscriptions[::-1]):
        result = shared(*order)
        assert (result.topic.durability, result.latched) == expected


@pytest.mark.parametrize(("type_", "other"), [(TYPE, OTHER), (OTHER, TYPE)])
def test_the_first_reader_sets_the_type_and_the_last_request_counts(type_: str, other: str) -> None:
    strict = Topic("/a", reliability="reliable")
    subscriptions = (
        Subscription(type_, strict, resubscriptions=1),
        Subscription(
            other, Topic("/a", reliability="best_effort"), latched=True, resubscriptions=3
        ),
    )
    assert shared(*subscriptions) == Subscription(type_, strict, resubscriptions=3)
    assert (
        shared(*subscriptions, Subscription(type_, strict, resubscriptions=2)).resubscriptions == 3
    )
