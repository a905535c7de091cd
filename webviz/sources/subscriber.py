"""Subscriptions of displays, panels and tools."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import replace

from webviz.sources.source import Subscription

_COUNT = itertools.count(1)


class Subscriber:
    """One reader of topics, which gets their latched messages even if others read them already.

    A topic has one subscription for all readers, and publishers send latched messages only to new
    subscriptions. So a topic that is new to a reader is subscribed anew.
    """

    def __init__(self) -> None:
        self._asked: dict[tuple[str, str], int] = {}

    def subscribe(self, wanted: Mapping[str, Subscription]) -> dict[str, Subscription]:
        """Read exactly these topics, by full name.

        Returns:
            The same subscriptions with `asked`, which is higher for topics and types that were not
            in the previous call.
        """
        known, self._asked = self._asked, {}
        found = {}
        for name, subscription in wanted.items():
            key = name, subscription.type
            self._asked[key] = asked = known.get(key) or next(_COUNT)
            found[name] = replace(subscription, asked=asked)
        return found

    def ask(self) -> None:
        """Request all latched messages again."""
        self._asked.clear()
