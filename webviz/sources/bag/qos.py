"""QoS profiles of bags, read in the notations of all versions of rosbag2, written in that of 9.

Recorders other than rosbag2 write only some policies. The messages of such bags are intact.
"""

from __future__ import annotations

import functools
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

from webviz.api.offer import Durability, Publisher, Reliability
from webviz.data.plain_yaml import YamlLimits, read_plain, write

LIMITS = YamlLimits(values=5000, characters=1 << 16, depth=8)
"""Limits of the text of one topic."""
MAX_PROFILES = 100
MAX_DEPTH = 1 << 31
"""Largest depth of a queue, which is a number of 32 bits in DDS."""


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
    try:
        profiles = read_plain(text, LIMITS)
        return tuple(map(_profile, profiles[:MAX_PROFILES] if isinstance(profiles, list) else ()))
    except (ValueError, OverflowError):
        return ()


def _profile(profile: Any) -> BagProfile:
    if not isinstance(profile, dict):
        raise ValueError
    is_best_effort = _word(profile, "reliability") in ("2", "best_effort")
    is_latched = _word(profile, "durability") in ("1", "transient_local")
    return BagProfile(
        "best_effort" if is_best_effort else "reliable",
        "transient_local" if is_latched else "volatile",
        min(max(0, int(_word(profile, "depth") or 0)), MAX_DEPTH),
    )


def _word(policies: dict[Any, Any], name: str) -> str:
    """Return a policy as text; lists and mappings count as missing."""
    word = policies.get(name)
    return str(word).lower() if isinstance(word, int | str) else ""


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
    return write(profiles)


def weakest(publishers: Sequence[Publisher]) -> tuple[Reliability, Durability]:
    """Return the QoS that all of them offer."""
    reliable = all(p.reliability == "reliable" for p in publishers)
    latched = all(p.durability == "transient_local" for p in publishers)
    return (
        "reliable" if reliable else "best_effort",
        "transient_local" if latched else "volatile",
    )
