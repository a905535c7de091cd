"""QoS in liveliness tokens, as numbers between colons.

rmw_zenoh_cpp uses the numbers of rmw and leaves out what is its default: reliable, volatile, the
last 42 messages: read in ros2/rmw_zenoh (`qos_to_keyexpr`), ZettaScaleLabs/hiroz
(`QosProfile::encode`) and Pico-ROS. zenoh-bridge-ros2dds uses the numbers of DDS behind a field
that is `K` for keyed types, and leaves out what a DDS endpoint does not state; since Iron a fifth
field has the user data of the endpoint: read in eclipse-zenoh/zenoh-plugin-ros2dds
(`qos_to_key_expr`) and hiroz (`Ros2DdsFormatter`), whose tests have the numbers.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from webviz.api.offer import Durability, Reliability

DEFAULT_DEPTH = 42
MAX_DIGITS = 20
"""Largest number of a token: an unsigned one of 64 bits."""
MAX_DEADLINE_S = 1e9
"""Longer ones are those that ROS writes for none."""
_RELIABILITY: dict[str, Reliability] = {
    "": "reliable",
    "0": "reliable",
    "1": "reliable",
    "2": "best_effort",
}
_DURABILITY: dict[str, Durability] = {
    "": "volatile",
    "0": "volatile",
    "1": "transient_local",
    "2": "volatile",
}
_DDS_RELIABILITY: dict[str, Reliability] = {"": "reliable", "0": "best_effort", "1": "reliable"}
_DDS_DURABILITY: dict[str, Durability] = {
    "": "volatile",
    "0": "volatile",
    "1": "transient_local",
    "2": "transient_local",
    "3": "transient_local",
}


class TokenQos(NamedTuple):
    """QoS of an endpoint, as its token states it."""

    reliability: Reliability = "reliable"
    durability: Durability = "volatile"
    depth: int = DEFAULT_DEPTH
    deadline_s: float = math.inf


def read_qos(text: str) -> TokenQos:
    """Return the QoS in a token of rmw_zenoh_cpp.

    Raises:
        ValueError: it is malformed.
    """
    parts = text.split(":", 6)
    if len(parts) < 6:
        raise ValueError("a QoS of fewer than six fields")
    reliability, durability, history, deadline = parts[:4]
    kind, _, depth = history.partition(",")
    if kind not in ("", "0", "1", "2"):
        raise ValueError("an unknown history")
    seconds, _, nanoseconds = deadline.partition(",")
    deadline_s = _number(seconds, math.inf) + _number(nanoseconds, 0) / 1e9
    try:
        return TokenQos(
            _RELIABILITY[reliability],
            _DURABILITY[durability],
            int(_number(depth, DEFAULT_DEPTH)),
            deadline_s if deadline_s <= MAX_DEADLINE_S else math.inf,
        )
    except KeyError as error:
        raise ValueError("an unknown policy") from error


def read_dds_qos(text: str) -> TokenQos:
    """Return the QoS in a token of zenoh-bridge-ros2dds.

    Raises:
        ValueError: it is malformed.
    """
    parts = text.split(":", 4)
    if len(parts) < 4:
        raise ValueError("a QoS of fewer than four fields")
    _, reliability, durability, history = parts[:4]
    depth = history.partition(",")[2]
    try:
        return TokenQos(
            _DDS_RELIABILITY[reliability], _DDS_DURABILITY[durability], int(_number(depth, 1))
        )
    except KeyError as error:
        raise ValueError("an unknown policy") from error


def write_qos(reliability: Reliability, durability: Durability, depth: int) -> str:
    """Return a QoS for a token of rmw_zenoh_cpp."""
    reliable = "" if reliability == "reliable" else "2"
    durable = "" if durability == "volatile" else "1"
    depth_text = "" if depth == DEFAULT_DEPTH else str(depth)
    return f"{reliable}:{durable}:,{depth_text}:,:,:,,"


def _number(text: str, default: float) -> float:
    if not text:
        return default
    if not (text.isascii() and text.isdigit() and len(text) <= MAX_DIGITS):
        raise ValueError("a number with other characters than digits")
    return int(text)
