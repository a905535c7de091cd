"""QoS profiles of bags: rosbags rejects a whole bag if a profile lacks a key.

Recorders other than rosbag2 write only some policies. The messages of such bags are intact.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rosbags.interfaces import Qos
from rosbags.rosbag2 import metadata, reader, storage_mcap, storage_sqlite3
from ruamel.yaml import YAML

_strict = metadata.parse_qos
_TIMES = ("deadline", "lifespan", "liveliness_lease_duration")


def parse_qos(given: Any) -> list[Qos]:
    """The profiles of a topic.

    Args:
        given: as recorded: YAML, or parsed YAML.

    Returns:
        The profiles, with "unknown", 0 and False for missing keys; none if they are unreadable.
    """
    try:
        profiles = YAML(typ="safe").load(given) if isinstance(given, str) else given
        return _strict([_completed(profile) for profile in profiles or ()])
    except Exception:  # of YAML, or of rosbags for wrong types
        return []


def _completed(profile: Mapping[str, Any]) -> Any:
    times = {name: {"sec": 0, "nsec": 0, **profile.get(name, {})} for name in _TIMES}
    return {"depth": 0, "avoid_ros_namespace_conventions": False, **profile, **times}


def be_lenient() -> None:
    """Make rosbags use `parse_qos`; it has no option for that."""
    for module in (reader, storage_mcap, storage_sqlite3):
        vars(module)["parse_qos"] = parse_qos
