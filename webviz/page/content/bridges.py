"""The links to bridges, over which live topics come."""

from __future__ import annotations

from collections.abc import Sequence

from webviz.engine.state import State
from webviz.page.content.forms import brief
from webviz.page.content.store import PageStore


class BridgesStore(PageStore, frozen=True):
    """The links to bridges.

    Args:
        all: address or robot of each, and why it is not live; "" if it is.
    """

    all: Sequence[tuple[str, str]]


def bridges(state: State, _: str) -> BridgesStore | None:
    """Return the bridges, None without a bridge."""
    if not state.bridges:
        return None
    return BridgesStore(
        [
            (brief(bridge.title), "" if bridge.is_up else brief(bridge.problem))
            for bridge in state.bridges
        ]
    )
