"""Topics that have a matching publisher and no message."""

from __future__ import annotations

from webviz.api.observation import DisplaySeen, InputSeen, Observation
from webviz.api.offer import Offer


def is_nameless(offer: Offer) -> bool:
    """Return whether no publisher belongs to a node, though that would be known."""
    return all(not each.node and each.is_qos_known for each in offer.publishers)


def is_silent(
    observation: Observation, display: DisplaySeen, each: InputSeen, offer: Offer
) -> bool:
    """Return whether a topic is published and matches, but nothing has arrived."""
    publishers = [p for p in offer.publishers if p.type in each.types]
    if each.received or offer.problem or not publishers or observation.is_recorded:
        return False
    if offer.begins:  # the past, in which it says nothing of a publisher that memory has no message
        return False
    status = display.problem(each.status)
    return offer.requested is not None and status is not None and status.remedy is None
