"""A survey of a network's other ROS domains, for one whose own domain is empty."""

from __future__ import annotations

import time
from collections import Counter
from typing import Any

from webviz.data.words import counted
from webviz.sources.zenoh.engine import directly
from webviz.sources.zenoh.tokens import ADMIN, MAX_DOMAIN

PATIENCE_S = 2.0
"""Time for the tokens of the own domain to arrive."""
AGAIN_S = 10.0
TIMEOUT_S = 5.0
NODES = f"{ADMIN}/*/*/*/*/NN/**"


class DomainSurvey:
    """Counts the nodes of other domains while the own one is empty.

    Args:
        domain: the own one.
    """

    def __init__(self, domain: int) -> None:
        self._domain = domain
        self._next_s = time.monotonic() + PATIENCE_S
        self._counts: Counter[int] = Counter()
        self.remark = ""
        """A sentence on the other domains; "" if the own one has nodes, or none has any."""

    def turn(self, session: Any, is_empty: bool) -> None:
        """Look around if it is due; from one thread.

        Args:
            session: that is open.
            is_empty: whether the own domain has no node.
        """
        now_s = time.monotonic()
        if not is_empty:
            self.remark = ""
            self._next_s = now_s + PATIENCE_S
        elif now_s >= self._next_s:
            self._next_s = now_s + AGAIN_S
            self._counts = counts = Counter[int]()

            def take(reply: Any) -> None:
                if reply.ok is not None:
                    text = str(reply.ok.key_expr)[:100].split("/")[1]
                    if text.isascii() and text.isdigit() and len(text) <= 3:
                        counts[int(text)] += 1

            session.liveliness().get(NODES, directly(take, self._tell), timeout=TIMEOUT_S)

    def _tell(self) -> None:
        others = [
            (count, domain)
            for domain, count in self._counts.items()
            if domain != self._domain and domain <= MAX_DOMAIN
        ]
        if not others:
            self.remark = ""
            return
        count, domain = max(others)
        nodes = counted(count, "node")
        self.remark = (
            f"ROS_DOMAIN_ID {self._domain} has no nodes on this network, but {domain} has {nodes}. "
            f"Start webviz with ROS_DOMAIN_ID={domain}."
        )
