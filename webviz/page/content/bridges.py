"""The links to bridges, over which live topics come."""

from __future__ import annotations

from collections.abc import Sequence

from webviz.engine.state import State
from webviz.engine.store import PageStore
from webviz.page.content.forms import brief


class BridgesStore(PageStore, frozen=True):
    """The links to bridges.

    Args:
        all: address or robot of each, why it is not live, "" if it is, and what is wrong with its
            link, such as topics that are thinned; "" if nothing is.
    """

    all: Sequence[tuple[str, str, str]]


def bridges(state: State, _: str) -> BridgesStore | None:
    """Return the bridges, None without a bridge."""
    if not state.bridges:
        return None
    return BridgesStore(
        [
            (
                brief(bridge.title),
                "" if bridge.is_up else brief(bridge.problem),
                brief(next(iter(bridge.remarks), "")),
            )
            for bridge in state.bridges
        ]
    )
