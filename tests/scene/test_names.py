"""Any frame id becomes one segment of a node name."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from webviz.scene.names import node_path, segment

# Lone surrogates included: a frame id may be any bytes, decoded with surrogateescape.
ANY_TEXT = st.text(st.characters(codec=None), max_size=8)


@given(ANY_TEXT, ANY_TEXT)
def test_different_texts_have_different_segments(a: str, b: str) -> None:
    assert (segment(a) == segment(b)) == (a == b)


@given(ANY_TEXT)
def test_a_segment_is_plain_text_without_a_slash_and_never_empty(text: str) -> None:
    assert segment(text).isascii()
    assert segment(text).isprintable()
    assert "/" not in segment(text)
    assert segment(text)


@given(ANY_TEXT, ANY_TEXT, ANY_TEXT, ANY_TEXT)
def test_different_nodes_have_different_names(g: str, k: str, g2: str, k2: str) -> None:
    assert (node_path(g, k) == node_path(g2, k2)) == ((g, k) == (g2, k2))
    assert node_path(g, k) != node_path(g2)


@pytest.mark.parametrize("name", ["base_link", "robot1-base.link", "left wheel"])
def test_usual_frame_ids_stay_readable(name: str) -> None:
    assert segment(name) == name
