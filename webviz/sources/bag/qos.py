"""QoS profiles of bags, read in the notations of all versions of rosbag2, written in that of 9.

Recorders other than rosbag2 write only some policies. The messages of such bags are intact.
"""

from __future__ import annotations

import functools
import io
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

from ruamel.yaml import YAML

from webviz.api.offer import Durability, Publisher, Reliability

MAX_TEXT = 1 << 20
MAX_PROFILES = 100


class BagProfile(NamedTuple):
    """QoS offered by one publisher; `depth` is 0 if it is unknown."""

    reliability: Reliability
    durability: Durability
    depth: int


# Most topics of a bag have one of a few texts, each of which takes more than a millisecond.
@functools.lru_cache(maxsize=32)
def profiles_of(text: str) -> tuple[BagProfile, ...]:
    """Return the profiles of a topic.

    Args:
        text: as recorded, in YAML: policies are numbers of rmw before version 9, then words.

    Returns:
        The profiles, reliable and volatile where nothing else is recorded; none if they are
        unreadable.
    """
    if not text or len(text) > MAX_TEXT:
        return ()
    try:
        return tuple(map(_profile, YAML(typ="safe").load(text)[:MAX_PROFILES]))
    except Exception:  # of YAML, or of wrong types
        return ()


def _profile(given: dict[str, Any]) -> BagProfile:
    is_best_effort = str(given.get("reliability")).lower() in ("2", "best_effort")
    is_latched = str(given.get("durability")).lower() in ("1", "transient_local")
    return BagProfile(
        "best_effort" if is_best_effort else "reliable",
        "transient_local" if is_latched else "volatile",
        max(0, int(given.get("depth", 0))),
    )


def text_of(publishers: Iterable[Publisher]) -> str:
    """Return the profiles that publishers offer, as YAML for a bag.

    What is not known is as rosbag2's.
    """
    forever = {"sec": 9223372036, "nsec": 854775807}
    profiles = [
        {
            "history": "unknown",
            "depth": 0,
            "reliability": publisher.reliability,
            "durability": publisher.durability,
            "deadline": dict(forever),
            "lifespan": dict(forever),
            "liveliness": "automatic",
            "liveliness_lease_duration": dict(forever),
            "avoid_ros_namespace_conventions": False,
        }
        for publisher in publishers
    ]
    text = io.StringIO()
    YAML(typ="safe").dump(profiles, text)
    return text.getvalue()


def weakest(publishers: Sequence[Publisher]) -> tuple[Reliability, Durability]:
    """Return the QoS that all of them offer."""
    reliable = all(p.reliability == "reliable" for p in publishers)
    latched = all(p.durability == "transient_local" for p in publishers)
    return (
        "reliable" if reliable else "best_effort",
        "transient_local" if latched else "volatile",
    )
