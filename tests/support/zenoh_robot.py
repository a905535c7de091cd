"""Robots on Zenoh for tests: a second implementation of the wire, written from its specification.

It shares no code with `webviz/sources/zenoh/`; keys of data come from pamoja-ros2, and attachments
from the engine's own serialiser.
"""

from __future__ import annotations

import itertools
import json
import socket
import time
from collections.abc import Callable, Mapping
from typing import Any

import pamoja.ros2 as pamoja
import xxhash
import zenoh
import zenoh.ext

from webviz.data.messages import decode, encode, interfaces, type_hash

DEFINITIONS = {"std_srvs/srv/SetBool": "bool data\n---\nbool success\nstring message"}
"""Definitions of services that webviz does not know by itself."""


def robot_token(
    domain: int,
    session: str,
    kind: str,
    namespace: str,
    node: str,
    topic: str,
    type: str,
    hash: str,
    qos: str,
    ids: tuple[int, int] = (0, 1),
) -> str:
    """Return the liveliness token of an endpoint."""
    mangled = pamoja.percent_mangle
    dds = pamoja.dds_type_name(type)
    return (
        f"@ros2_lv/{domain}/{session}/{ids[0]}/{ids[1]}/{kind}/%/{mangled(namespace or '/')}/{node}"
        f"/{mangled(topic)}/{dds}/{hash}/{qos}"
    )


def robot_attachment(sequence: int, stamp_ns: int, gid: bytes) -> bytes:
    """Return the attachment of a message, of a request or of a response."""
    fields = zenoh.ext.Int64(sequence), zenoh.ext.Int64(stamp_ns), gid
    return zenoh.ext.z_serialize(fields).to_bytes()


def free_port() -> int:
    """Return a port of this machine that nothing listens on."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        return server.getsockname()[1]


def config(mode: str, connect: str = "", listen: str = "", **values: Any) -> zenoh.Config:
    """Return a config of a session without scouting.

    Args:
        mode: such as "router".
        connect, listen: endpoints.
        values: further ones, with `__` for slashes.
    """
    zenoh_config = zenoh.Config()
    zenoh_config.insert_json5("mode", json.dumps(mode))
    zenoh_config.insert_json5("scouting/multicast/enabled", "false")
    zenoh_config.insert_json5("timestamping/enabled", "true")  # as rmw_zenoh_cpp, for caches
    zenoh_config.insert_json5("connect/endpoints", json.dumps([connect] if connect else []))
    if listen:
        zenoh_config.insert_json5("listen/endpoints", json.dumps([listen]))
    for key, value in values.items():
        zenoh_config.insert_json5(key.replace("__", "/"), json.dumps(value))
    return zenoh_config


class ZenohRouter:
    """A router on a port of this machine.

    Args:
        port: 0 for a free one.
        values: of its config, with `__` for slashes.
    """

    def __init__(self, port: int = 0, **values: Any) -> None:
        self.port = port or free_port()
        self.endpoint = f"tcp/127.0.0.1:{self.port}"
        self.session = zenoh.open(config("router", listen=self.endpoint, **values))

    def close(self) -> None:
        """End it."""
        self.session.close()


class ZenohRobot:
    """A robot as rmw_zenoh_cpp has it: a session with one node.

    Args:
        endpoint: of its router.
        node: name of the node, with its namespace.
        domain: number of the ROS domain.
    """

    def __init__(self, endpoint: str, node: str = "/robot", domain: int = 0, **values: Any) -> None:
        self.session = zenoh.open(config("client", endpoint, **values))
        self.zid = str(self.session.zid())
        self.domain = domain
        self.namespace, _, self.name = node.rpartition("/")
        self._ids = itertools.count(1)
        self._sequence = itertools.count(1)
        self._entities: list[Any] = []
        mangled = pamoja.percent_mangle(self.namespace or "/")
        self.declare(f"@ros2_lv/{domain}/{self.zid}/0/0/NN/%/{mangled}/{self.name}")

    def declare(self, token: str) -> Any:
        """Declare a token, whatever it says."""
        declared = self.session.liveliness().declare_token(token)
        self._entities.append(declared)
        return declared

    def token(self, kind: str, topic: str, type: str, hash: str = "", qos: str = "") -> str:
        """Declare an endpoint; return its token."""
        token = robot_token(
            self.domain,
            self.zid,
            kind,
            self.namespace,
            self.name,
            topic,
            type,
            hash or type_hash(type),
            qos or "::,10:,:,:,,",
            (0, next(self._ids)),
        )
        self.declare(token)
        return token

    def publisher(
        self,
        topic: str,
        type: str,
        is_latched: bool = False,
        hash: str = "",
        is_blocking: bool = False,
    ) -> Callable[..., None]:
        """Return a function that publishes a message from values by field, or from bytes."""
        hash = hash or type_hash(type)
        key = pamoja.entity_key(self.domain, topic, type, hash)
        assert key is not None
        cache = zenoh.ext.CacheConfig(10) if is_latched else None
        declared = zenoh.ext.declare_advanced_publisher(
            self.session,
            key,
            cache=cache,
            publisher_detection=is_latched,
            congestion_control=zenoh.CongestionControl.BLOCK
            if is_blocking
            else zenoh.CongestionControl.DROP,
        )
        self._entities.append(declared)
        token = self.token("MP", topic, type, hash, f":{1 if is_latched else ''}:,10:,:,:,,")
        gid = xxhash.xxh3_128_intdigest(token.encode()).to_bytes(16, "little")

        def publish(values: Mapping[str, Any] | bytes) -> None:
            cdr = values if isinstance(values, bytes) else encode(type, values)
            attachment = robot_attachment(next(self._sequence), time.time_ns(), gid)
            declared.put(cdr, attachment=attachment)

        return publish

    def subscription(self, topic: str, type: str) -> list[tuple[Any, bytes]]:
        """Return the messages of a topic with their attachments, as they arrive."""
        key = pamoja.entity_key(self.domain, topic, type, type_hash(type))
        assert key is not None
        results: list[tuple[Any, bytes]] = []

        def take(sample: zenoh.Sample) -> None:
            assert sample.attachment is not None, "rmw_zenoh_cpp drops messages without one"
            results.append((decode(type, sample.payload.to_bytes()), sample.attachment.to_bytes()))

        self._entities.append(self.session.declare_subscriber(key, take))
        self.token("MS", topic, type)
        return results

    def service(
        self, name: str, type: str, answer: Callable[[Any], Mapping[str, Any]], hash: str = ""
    ) -> None:
        """Serve a service by a function from its request to the fields of its response."""
        if "/srv/" in type:
            interfaces.service(type, DEFINITIONS.get(type, ""))
        hash = hash or f"RIHS01_{'5e' * 32}"
        key = pamoja.entity_key(self.domain, name, type, hash)
        assert key is not None

        def reply(query: zenoh.Query) -> None:
            assert query.payload is not None
            assert query.attachment is not None
            assert len(query.attachment.to_bytes()) == 33
            request = decode(f"{type}_Request", query.payload.to_bytes())
            response = encode(f"{type}_Response", answer(request))
            query.reply(key, response, attachment=query.attachment)

        self._entities.append(self.session.declare_queryable(key, reply, complete=True))
        self.token("SS", name, type, hash)

    def action(
        self,
        name: str,
        type: str,
        run: Callable[[Any, Callable[..., None]], Mapping[str, Any]],
        cancel: Callable[[], None] | None = None,
    ) -> dict[str, int]:
        """Serve an action; return how often its parts were called.

        Args:
            name: full name.
            type: such as "nav2_msgs/action/Spin", which is known.
            run: takes the goal and a function that publishes fields of feedback; returns the fields
                of the result. Goals with a negative yaw are rejected.
            cancel: called when a goal is cancelled; its status is then "canceled".
        """
        parts = interfaces.action(type)
        calls = {"send_goal": 0, "cancel_goal": 0, "get_result": 0}
        goals: dict[bytes, Any] = {}
        cancelled = set[bytes]()
        publish = self.publisher(f"{name}/_action/feedback", parts.feedback)

        def send_goal(request: Any) -> Mapping[str, Any]:
            calls["send_goal"] += 1
            goals[bytes(request.goal_id.uuid)] = request.goal
            return {"accepted": request.goal.target_yaw >= 0}

        def get_result(request: Any) -> Mapping[str, Any]:
            calls["get_result"] += 1
            id = bytes(request.goal_id.uuid)

            def feedback(**fields: Any) -> None:
                publish({"goal_id": {"uuid": list(id)}, "feedback": fields})

            result = run(goals[id], feedback)
            is_cancelled = cancel is not None and id in cancelled
            return {"status": 5 if is_cancelled else 4, "result": result}

        def cancel_goal(request: Any) -> Mapping[str, Any]:
            calls["cancel_goal"] += 1
            cancelled.add(bytes(request.goal_info.goal_id.uuid))
            if cancel is not None:
                cancel()
            return {"return_code": 0, "goals_canceling": [request.goal_info]}

        self.service(f"{name}/_action/send_goal", parts.send_goal, send_goal)
        self.service(f"{name}/_action/get_result", parts.get_result, get_result)
        self.service(f"{name}/_action/cancel_goal", "action_msgs/srv/CancelGoal", cancel_goal)
        return calls

    def close(self) -> None:
        """End it."""
        self.session.close()


class BridgedRobot:
    """A robot on DDS behind zenoh-bridge-ros2dds, as its side of Zenoh is.

    Args:
        endpoint: of its router.
        namespace: of the bridge, such as "robot1"; "" for none.
    """

    def __init__(self, endpoint: str, namespace: str = "") -> None:
        self.session = zenoh.open(config("client", endpoint))
        self.zid = str(self.session.zid())
        self._prefix = f"{namespace}/" if namespace else ""
        own = self.session.liveliness().declare_token(f"@/{self.zid}/@ros2_lv")
        self._entities: list[Any] = [own]

    def token(self, kind: str, name: str, type: str, qos: str = "") -> str:
        """Declare a route; return its key."""
        key = f"{self._prefix}{name.removeprefix('/')}"
        token = f"@/{self.zid}/@ros2_lv/{kind}/{key.replace('/', '§')}/{type.replace('/', '§')}"
        token += f"/{qos}" if qos else ""
        self._entities.append(self.session.liveliness().declare_token(token))
        return key

    def publisher(
        self, topic: str, type: str, is_latched: bool = False
    ) -> Callable[[Mapping[str, Any]], None]:
        """Return a function that publishes a message, without an attachment."""
        key = self.token("MP", topic, type, f":1:{1 if is_latched else 0}:0,10")
        cache = zenoh.ext.CacheConfig(10) if is_latched else None
        declared = zenoh.ext.declare_advanced_publisher(
            self.session, key, cache=cache, publisher_detection=is_latched
        )
        self._entities.append(declared)
        return lambda values: declared.put(encode(type, values))

    def subscription(self, topic: str, type: str) -> list[Any]:
        """Return the messages of a topic, as they arrive."""
        key = self.token("MS", topic, type, ":1:0:0,10")
        results: list[Any] = []
        self._entities.append(
            self.session.declare_subscriber(
                key, lambda sample: results.append(decode(type, sample.payload.to_bytes()))
            )
        )
        return results

    def service(self, name: str, type: str, answer: Callable[[Any], Mapping[str, Any]]) -> None:
        """Serve a service by a function from its request to the fields of its response."""
        if "/srv/" in type:
            interfaces.service(type, DEFINITIONS.get(type, ""))
        is_part = "/_action/" in name
        key = f"{self._prefix}{name[1:]}" if is_part else self.token("SS", name, type)

        def reply(query: zenoh.Query) -> None:
            assert query.payload is not None
            request = decode(f"{type}_Request", query.payload.to_bytes())
            query.reply(key, encode(f"{type}_Response", answer(request)))

        self._entities.append(self.session.declare_queryable(key, reply))

    def close(self) -> None:
        """End it."""
        self.session.close()
