"""Publishers of a topic and the QoS that they offer."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

Reliability = Literal["reliable", "best_effort"]
Durability = Literal["volatile", "transient_local"]


@dataclass(frozen=True)
class Endpoint:
    """A publisher or a subscription of a topic.

    Args:
        node: full node name, "" for a DDS program without a ROS node.
        type: message type.
        reliability, durability: offered or requested QoS.
        deadline_s: longest time between two messages that is promised or asked for, inf for any.
        is_qos_known: whether that is certain; a bridge does not tell it.
        endpoint: its identity, which changes when its node is started again; b"" if unknown.
    """

    node: str
    type: str
    reliability: Reliability
    durability: Durability
    endpoint: bytes = b""
    deadline_s: float = math.inf
    is_qos_known: bool = True

    @property
    def label(self) -> str:
        """Its node, for sentences."""
        return self.node or ("a DDS program" if self.is_qos_known else "the bridge")


@dataclass(frozen=True)
class Publisher(Endpoint):
    """A publisher of a topic."""


@dataclass(frozen=True)
class Offer:
    """Publishers and QoS of one topic.

    Args:
        publishers: all of them.
        requested: reliability and durability of our subscription, None without one.
        problem: why no message can arrive, "" if it can.
        type: of our subscription, "" without one; a topic can be read as one type only.
        subscribers: their number, webviz included; None if unknown.
        is_recorded: whether it is of a bag, whose messages match any QoS.
        readers: the subscriptions, with the QoS that they request, webviz's among them; empty if
            unknown.
        begins: when the first message of a bag comes, such as "the bag's first is at 0.8 s"; "" for
            live topics.
    """

    publishers: tuple[Publisher, ...]
    requested: tuple[Reliability, Durability] | None = None
    problem: str = ""
    type: str = ""
    subscribers: int | None = None
    is_recorded: bool = False
    begins: str = ""
    readers: tuple[Endpoint, ...] = ()

    @property
    def is_latched(self) -> bool:
        """True if every publisher repeats its last messages to those who come later."""
        durabilities = {publisher.durability for publisher in self.publishers}
        return durabilities == {"transient_local"}
