"""QoS profiles of bags, in the notations of several recorders."""

from __future__ import annotations

from typing import Any

import pytest

from webviz.sources import Publisher
from webviz.sources.bag.qos import LIMITS, MAX_PROFILES, profiles_of, text_of

RELIABLE = ("reliable", "volatile")
LATCHED = ("reliable", "transient_local")
SENSOR = ("best_effort", "volatile")


@pytest.mark.parametrize(
    ("text", "profiles"),
    [
        ("- {reliability: 1, durability: 1, depth: 7}", [(*LATCHED, 7)]),
        ("- {reliability: 2, durability: 2, depth: 5}", [(*SENSOR, 5)]),
        ("- {reliability: reliable, durability: transient_local}", [(*LATCHED, 0)]),
        ("- {reliability: BEST_EFFORT, durability: volatile}", [(*SENSOR, 0)]),
        ("- {reliability: system_default, durability: 0, depth: -1}", [(*RELIABLE, 0)]),
        ("[{depth: 1}, {reliability: 2, depth: '3'}]", [(*RELIABLE, 1), (*SENSOR, 3)]),
        ("[]", []),
        ("", []),
        ("- 7", []),
        ("- {depth: many}", []),
        ("[{", []),
        ("- {depth: 1}".ljust(LIMITS.characters), [(*RELIABLE, 1)]),
        ("- {depth: 1}".ljust(LIMITS.characters + 1), []),
    ],
)
def test_profiles_are_read_as_recorders_write_them(text: str, profiles: list[Any]) -> None:
    assert [*profiles_of(text)] == profiles


def test_profiles_are_bounded() -> None:
    assert len(profiles_of("- {depth: 1}\n" * (MAX_PROFILES + 1))) == MAX_PROFILES


def test_profiles_that_are_written_are_read_again() -> None:
    publishers = [Publisher("/a", "", *LATCHED), Publisher("/b", "", *SENSOR)]
    assert profiles_of(text_of(publishers)) == ((*LATCHED, 0), (*SENSOR, 0))
