"""The tree of frames as a line of text."""

import numpy as np
import pytest

from webviz_displays.tf import LISTED, outline


@pytest.mark.parametrize(
    ("names", "parents", "text"),
    [
        ("abcd", [-1, 0, 1, 1], "a (b (c, d))"),
        ("ba", [-1, -1], "a, b"),
        ("abc", [2, 0, 1], "a (b (c (a, again)))"),
        ("xabcy", [2, 3, 1, 2, -1], "y, a (b (c (a, again), x))"),
        ("a", [0], "a (a, again)"),
    ],
)
def test_each_frame_is_named(names: str, parents: list[int], text: str) -> None:
    assert outline(list(names), np.array(parents)) == text


def test_the_rest_is_counted() -> None:
    names = [f"f{place:02}" for place in range(LISTED + 3)]
    chain = np.arange(LISTED + 3) - 1
    assert outline(names, chain).endswith(" and 3 more")
    chain[0] = LISTED + 2  # a loop
    assert outline(names, chain).startswith("f00 (f01 (")
    assert outline(names, chain).endswith(" and 3 more")
