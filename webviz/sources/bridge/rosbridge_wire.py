"""The frames of rosbridge, version 2: JSON texts, and messages in CDR within CBOR."""

from __future__ import annotations

import functools
import importlib.util
import json
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import msgspec

from webviz.data.words import plain
from webviz.sources.bridge import json_frames
from webviz.sources.bridge.json_frames import JsonFrames
from webviz.sources.bridge.session import WireError

MISSING = "rosbridge needs the package cbor2. Install it with `pip install 'ros-webviz[rosbridge]'`"
MAX_DEPTH = 8
"""Largest depth of the containers of a CBOR frame; those of rosbridge have two."""
MAX_FRAGMENTED = 4
"""Texts that may arrive in fragments at the same time."""
PART_SIZE = 100
"""Characters that a fragment counts besides its own."""


class RosbridgeMessage(NamedTuple):
    """A message of a subscription, with the time at which the server sent it, in ns."""

    topic: str
    stamp_ns: int
    cdr: bytes


class _Struct(msgspec.Struct):
    pass


class RosbridgeResponse(_Struct):
    """The response to a call: its values, or a text if it has failed."""

    id: str
    values: Any = None
    result: bool = False


class RosbridgeStatus(_Struct):
    """A text of the server, whose levels are "error", "warning" and others."""

    level: str = ""
    msg: str = ""


class Fragment(_Struct):
    """A part of a text; `num` counts from 0."""

    id: str | int
    data: str
    num: int
    total: float
    """rosbridge divides without rounding: 2.4 parts are two of full size and a smaller one."""


class _Payload(_Struct):
    secs: int
    nsecs: int
    cdr: bytes = msgspec.field(name="bytes")


class _Publish(_Struct):
    topic: str
    msg: _Payload


class Topics(_Struct):
    """The response of /rosapi/topics and, with definitions, of /rosapi/topics_and_raw_types."""

    topics: Sequence[str] = ()
    types: Sequence[str] = ()
    typedefs_full_text: Sequence[str] = ()


class Names(_Struct):
    """The response of /rosapi/nodes, or of /rosapi/services_for_type."""

    nodes: Sequence[str] = ()
    services: Sequence[str] = ()


read_text = JsonFrames[RosbridgeResponse | RosbridgeStatus | Fragment](
    {"service_response": RosbridgeResponse, "status": RosbridgeStatus, "fragment": Fragment}
).read
"""Returns the message in a text frame; see `JsonFrames.read`."""


@functools.cache
def is_readable() -> bool:
    """Return whether messages can be read: the library for CBOR is optional."""
    return importlib.util.find_spec("cbor2") is not None


def read_binary(frame: bytes) -> RosbridgeMessage:
    """Return the message in a binary frame.

    Raises:
        WireError: it is not of the protocol.
    """
    import cbor2

    try:
        values = cbor2.loads(frame, max_depth=MAX_DEPTH)
        # Texts are not taken for bytes in base64.
        publication = msgspec.convert(values, _Publish, builtin_types=(bytes,))
    except (cbor2.CBORDecodeError, msgspec.ValidationError) as error:
        raise WireError("A binary frame is not a message in cbor-raw") from error
    return RosbridgeMessage(
        publication.topic,
        publication.msg.secs * 1_000_000_000 + publication.msg.nsecs,
        publication.msg.cdr,
    )


def converted(values: Any, kind: type[Any]) -> Any:
    """Return the values of a response as a type.

    Raises:
        WireError: they are not of it.
    """
    try:
        return msgspec.convert(values, kind)
    except msgspec.ValidationError as error:
        raise WireError(f"A response is not of the protocol: {plain(str(error), 120)}") from error


class Fragments:
    """Texts that arrive in parts, because they are above the server's max_message_size."""

    def __init__(self) -> None:
        self._parts: dict[str | int, list[str]] = {}
        self._size = 0

    def add(self, part: Fragment) -> str | None:
        """Return the text that a fragment completes, None if it is not the last.

        Raises:
            WireError: it does not follow the one before, or too much is outstanding.
        """
        if part.num == 0:
            self._parts[part.id] = []
        parts = self._parts.get(part.id)
        if parts is None or part.num != len(parts):
            self._parts.pop(part.id, None)
            raise WireError("A fragment does not follow the one before")
        parts.append(part.data)
        self._size += len(part.data) + PART_SIZE
        if len(self._parts) > MAX_FRAGMENTED or self._size > json_frames.MAX_TEXT:
            self._parts.clear()
            self._size = 0
            raise WireError("Fragments are above the limit")
        if part.num + 2 <= part.total:
            return None
        del self._parts[part.id]
        if not self._parts:
            self._size = 0
        return "".join(parts)


def subscribe(topic: str, type: str, throttle_ms: int = 0) -> str:
    """Subscribe to a topic, whose messages come in CDR, or change the time between two of them."""
    throttle = {"throttle_rate": throttle_ms} if throttle_ms else {}
    return _text("subscribe", id=topic, topic=topic, type=type, compression="cbor-raw", **throttle)


def unsubscribe(topic: str) -> str:
    """End a subscription."""
    return _text("unsubscribe", id=topic, topic=topic)


def advertise(topic: str, type: str, *, is_latched: bool, depth: int) -> str:
    """Announce what will be published."""
    return _text("advertise", id=topic, topic=topic, type=type, latch=is_latched, queue_size=depth)


def unadvertise(topic: str) -> str:
    """End what was advertised."""
    return _text("unadvertise", id=topic, topic=topic)


def publish(topic: str, values: Mapping[str, Any], *, is_latched: bool, depth: int) -> str:
    """Return a message of an advertised topic."""
    return _text("publish", topic=topic, msg=values, latch=is_latched, queue_size=depth)


def call(id: str, service: str, values: Mapping[str, Any]) -> str:
    """Return a call of a service."""
    return _text("call_service", id=id, service=service, args=values)


def _text(op: str, **fields: Any) -> str:
    # Python's JSON has NaN and infinity, which rosbridge, written in Python, reads.
    return json.dumps({"op": op, **fields})
