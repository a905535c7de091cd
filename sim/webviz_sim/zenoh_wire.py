"""Topics of a node on Zenoh as rmw_zenoh_cpp has them, for a robot without ROS.

Keys of messages are `DOMAIN/TOPIC/TYPE/HASH`; a liveliness token tells of each endpoint, with `%`
for slashes. Read in ros2/rmw_zenoh, ZettaScaleLabs/hiroz and Pico-ROS.
"""

import itertools
import json
import struct
import time
from collections.abc import Callable
from typing import Any

import xxhash
import zenoh
import zenoh.ext

from webviz.data.messages import type_hash

DEPTH = 10
_ATTACHMENT = struct.Struct("<qqB16s")
"""Number of a message, its time in nanoseconds, and 16 bytes of identity behind their number."""


def open_session(mode: str, endpoint: str) -> zenoh.Session:
    """Open a session without scouting.

    Args:
        mode: "router" to listen on the endpoint, "client" to connect to it.
        endpoint: Such as "tcp/127.0.0.1:7447".
    """
    config = zenoh.Config()
    values = {
        "mode": mode,
        "listen/endpoints" if mode == "router" else "connect/endpoints": [endpoint],
        "scouting/multicast/enabled": False,
        "timestamping/enabled": True,  # for caches of latched messages
    }
    for key, value in values.items():
        config.insert_json5(key, json.dumps(value))
    return zenoh.open(config)


class ZenohTopicPublisher:
    """A publisher of serialised messages.

    Args:
        declared: By the engine.
        gid: Its identity, 16 bytes.
    """

    def __init__(self, declared: Any, gid: bytes) -> None:
        self._declared = declared
        self._gid = gid
        self._sequence = 0

    def publish(self, cdr: bytes) -> None:
        """Publish a message with its encapsulation header."""
        self._sequence += 1
        attachment = _ATTACHMENT.pack(self._sequence, time.time_ns(), len(self._gid), self._gid)
        self._declared.put(cdr, attachment=attachment)


class ZenohNode:
    """A node with publishers and subscriptions.

    Args:
        session: That is open.
        domain: Number of the ROS domain.
        namespace: Such as "/robot1"; "" for none.
        name: Of the node.
    """

    def __init__(self, session: zenoh.Session, domain: int, namespace: str, name: str) -> None:
        self._session = session
        self._domain = domain
        self._namespace = namespace
        self._name = name
        self._ids = itertools.count()
        self._declarations: list[Any] = []
        self._declare("NN", "")

    def publisher(
        self, type: str, topic: str, depth: int = DEPTH, durability: str = "volatile"
    ) -> ZenohTopicPublisher:
        """See `webviz_sim.publishers.SimPublishers.publisher`."""
        is_latched = durability == "transient_local"
        declared = zenoh.ext.declare_advanced_publisher(
            self._session,
            self._key(topic, type),
            cache=zenoh.ext.CacheConfig(depth) if is_latched else None,
            publisher_detection=is_latched,
        )
        self._declarations.append(declared)
        reliability, latched = "" if depth else "2", "1" if is_latched else ""
        qos = f"{reliability}:{latched}:,{depth or 5}:,:,:,,"
        token = self._declare("MP", self._endpoint(topic, type, qos))
        gid = xxhash.xxh3_128_intdigest(token.encode()).to_bytes(16, "little")
        return ZenohTopicPublisher(declared, gid)

    def subscribe(self, type: str, topic: str, arrive: Callable[[zenoh.ZBytes], None]) -> None:
        """Have `arrive` called with each serialised message, in a thread of the engine."""

        def take(sample: zenoh.Sample) -> None:
            arrive(sample.payload)

        handler: Any = zenoh.handlers.Callback(take, indirect=False)
        self._declarations.append(self._session.declare_subscriber(self._key(topic, type), handler))
        self._declare("MS", self._endpoint(topic, type, f"::,{DEPTH}:,:,:,,"))

    def _full(self, topic: str) -> str:
        return topic if topic.startswith("/") else f"{self._namespace}/{topic}"

    def _key(self, topic: str, type: str) -> str:
        return f"{self._domain}{self._full(topic)}/{_dds(type)}/{type_hash(type)}"

    def _endpoint(self, topic: str, type: str, qos: str) -> str:
        return f"/{_mangled(self._full(topic))}/{_dds(type)}/{type_hash(type)}/{qos}"

    def _declare(self, kind: str, endpoint: str) -> str:
        """Declare the token of the node, or of an endpoint; return it."""
        token = (
            f"@ros2_lv/{self._domain}/{self._session.zid()}/0/{next(self._ids)}/{kind}/%"
            f"/{_mangled(self._namespace or '/')}/{self._name}{endpoint}"
        )
        self._declarations.append(self._session.liveliness().declare_token(token))
        return token


def _dds(type: str) -> str:
    package, kind, name = type.split("/")
    return f"{package}::{kind}::dds_::{name}_"


def _mangled(name: str) -> str:
    return name.replace("/", "%")
