"""Liveliness tokens: one per node, publisher, subscription, service server and client.

rmw_zenoh_cpp:

    @ros2_lv/DOMAIN/SESSION/NODE ID/ID/KIND/ENCLAVE/NAMESPACE/NODE[/TOPIC/TYPE/HASH/QOS]

with `%` for slashes within a component. Messages have the key `DOMAIN/TOPIC/TYPE/HASH`, slashes of
the topic kept, and requests of a service the same with its name; Humble writes
`TypeHashNotSupported` for the hash.

zenoh-bridge-ros2dds:

    @/SESSION/@ros2_lv[/KIND/KEY/TYPE[/QOS]]

with `§` for slashes; the short one is of the bridge itself. The key of messages, and of requests,
is the name of the topic without its first slash, below the namespace of the bridge if it has one.
It has tokens for actions, too, but none for nodes.

The former is read in ros2/rmw_zenoh (`docs/design.md`, `liveliness_utils.cpp`), hiroz of
ZettaScaleLabs (`format/rmw_zenoh.rs`), natnet_zenoh (`liveliness.rs`), Pico-ROS and pamoja-ros2.
The latter in eclipse-zenoh/zenoh-plugin-ros2dds (`liveliness_mgt.rs`, `route_action_srv.rs`) and
hiroz (`format/ros2dds.rs`), which agree in the six kinds, `§`, and a QoS of topics alone; that keys
are names below a namespace, those of the parts of actions included, also in open-rmf/free_fleet
(`nav2_robot_adapter.py`), which drives robots behind that bridge.
"""

from __future__ import annotations

import re
from typing import Literal, NamedTuple

from webviz.sources.names import MAX_NAME, is_full_name
from webviz.sources.zenoh.qos import TokenQos, read_dds_qos, read_qos

ADMIN = "@ros2_lv"
MAX_TOKEN = 2048
"""Characters; names and types have 255 at most."""
MAX_HASH = 80
MAX_DOMAIN = 232
NO_HASH = "TypeHashNotSupported"
_SLASH, _DDS_SLASH = "%", "§"
Kind = Literal["node", "publisher", "subscription", "server", "client", "action", "bridge"]
_KINDS: dict[str, Kind] = {
    "NN": "node",
    "MP": "publisher",
    "MS": "subscription",
    "SS": "server",
    "SC": "client",
}
_DDS_KINDS: dict[str, Kind] = {
    "MP": "publisher",
    "MS": "subscription",
    "SS": "server",
    "SC": "client",
    "AS": "action",
}
_LETTERS = {kind: letters for letters, kind in _KINDS.items()}
MAX_TYPE = 255
"""Characters of the name of a type."""
_DDS_TYPE = re.compile(r"([A-Za-z]\w*)::(msg|srv|action)::dds_::([A-Za-z]\w*)_", re.ASCII)
_ROS_TYPE = re.compile(r"[A-Za-z]\w*/(msg|srv|action)/[A-Za-z]\w*", re.ASCII)
_NODE = re.compile(r"[A-Za-z_]\w*", re.ASCII)
_NAMESPACE = re.compile(r"(/[A-Za-z_]\w*)*/?", re.ASCII)


def dds_type(type: str) -> str:
    """Return the DDS name of a ROS type, such as "std_msgs/msg/String"."""
    package, kind, name = type.split("/")
    return f"{package}::{kind}::dds_::{name}_"


def ros_type(dds: str) -> str:
    """Return the ROS name of a DDS type, "" if it is not one of ROS."""
    match = _DDS_TYPE.fullmatch(dds) if len(dds) <= MAX_TYPE else None
    return "/".join(match.groups()) if match else ""


def is_ros_type(type: str) -> bool:
    """Return whether ROS allows a name of a type."""
    return len(type) <= MAX_TYPE and _ROS_TYPE.fullmatch(type) is not None


def node_name(namespace: str, name: str) -> str:
    """Return the full name of a node, "" if ROS does not allow it."""
    is_valid = (
        len(namespace) + len(name) < MAX_NAME
        and _NODE.fullmatch(name) is not None
        and _NAMESPACE.fullmatch(namespace) is not None
    )
    return f"{namespace.rstrip('/')}/{name}" if is_valid else ""


class LivelinessError(ValueError):
    """A token is not of ROS."""


class GraphEntity(NamedTuple):
    """A node or an endpoint, as its token states it.

    Attributes:
        kind: of the entity.
        node: full name of its node, "" behind zenoh-bridge-ros2dds.
        name: full name of the topic, service or action; "" of a node.
        type: ROS's name of its type; "" of a node.
        key: of its messages or requests; "" of a node.
        qos: of a publisher or subscription.
        session: identity of its Zenoh session.
        is_bridged: whether it is behind zenoh-bridge-ros2dds.
        hash: of its type, "" if it has none.
    """

    kind: Kind
    node: str
    name: str = ""
    type: str = ""
    key: str = ""
    qos: TokenQos = TokenQos()
    session: str = ""
    is_bridged: bool = False
    hash: str = ""


def graph_pattern(domain: int) -> str:
    """Return the pattern of all tokens of rmw_zenoh_cpp in a domain."""
    return f"{ADMIN}/{domain}/**"


BRIDGED_PATTERN = f"@/*/{ADMIN}/**"
"""Pattern of all tokens of zenoh-bridge-ros2dds."""


def read_token(token: str) -> GraphEntity | None:
    """Return the entity of a token; None if it is of a kind that the graph does not need.

    Raises:
        LivelinessError: it is not a token of ROS; one phrase.
    """
    if len(token) > MAX_TOKEN:
        raise LivelinessError(f"a token of more than {MAX_TOKEN} characters")
    try:
        return _bridged(token) if token.startswith("@/") else _native(token)
    except LivelinessError:
        raise
    except ValueError as error:
        raise LivelinessError(str(error)) from error


def data_key(domain: int, name: str, type: str, hash: str) -> str:
    """Return the key of the messages of a topic, or of the requests of a service.

    Args:
        domain: number of the ROS domain.
        name: full name.
        type: ROS's name of the type.
        hash: of the type, or "*" for any.
    """
    return f"{domain}/{name.strip('/')}/{dds_type(type)}/{hash}"


def write_token(
    domain: int,
    session: str,
    ids: tuple[int, int],
    node: str,
    entity: GraphEntity,
    qos: str = "",
) -> str:
    """Return a token of rmw_zenoh_cpp.

    Args:
        domain: number of the ROS domain.
        session: identity of the Zenoh session.
        ids: numbers of the node and of the entity within the session.
        node: full name of the node.
        entity: with kind, and of an endpoint name, type and hash.
        qos: see `webviz.sources.zenoh.qos.write_qos`.
    """
    namespace, _, name = node.rpartition("/")
    parts = [
        ADMIN,
        str(domain),
        session,
        *map(str, ids),
        _LETTERS[entity.kind],
        _SLASH,
        (namespace or "/").replace("/", _SLASH),
        name,
    ]
    if entity.kind != "node":
        parts += [entity.name.replace("/", _SLASH), dds_type(entity.type), entity.hash, qos]
    return "/".join(parts)


def topics_of(action: GraphEntity) -> tuple[GraphEntity, GraphEntity]:
    """Return the publishers of feedback and status of an action behind zenoh-bridge-ros2dds.

    It has one token for all of an action.
    """
    feedback = f"{action.type}_FeedbackMessage", "feedback"
    status = "action_msgs/msg/GoalStatusArray", "status"
    entities = [
        action._replace(
            kind="publisher",
            name=f"{action.name}/_action/{part}",
            type=type,
            key=f"{action.key}/_action/{part}",
        )
        for type, part in (feedback, status)
    ]
    return entities[0], entities[1]


def _native(token: str) -> GraphEntity | None:
    parts = token.split("/", 14)
    if len(parts) not in (9, 13) or parts[0] != ADMIN or not all(parts):
        raise LivelinessError("a token without the components of rmw_zenoh_cpp")
    domain, session, _, _, letters, _, namespace, name = parts[1:9]
    kind = _KINDS.get(letters)
    if kind is None:
        return None
    if not (domain.isascii() and domain.isdigit() and len(domain) <= 3):
        raise LivelinessError("a token with an invalid domain")
    node = node_name(namespace.replace(_SLASH, "/"), name)
    if not node:
        raise LivelinessError("a node with an invalid name")
    if kind == "node":
        return GraphEntity(kind, node, session=session)
    if len(parts) != 13:
        raise LivelinessError("an endpoint without a topic")
    topic, dds, hash, qos = parts[9:]
    topic = topic.replace(_SLASH, "/")
    type = ros_type(dds)
    if not is_full_name(topic):
        raise LivelinessError("an endpoint with an invalid name")
    if not type:
        raise LivelinessError("an endpoint with an invalid type")
    if len(hash) > MAX_HASH or not hash.isascii() or not hash.replace("_", "a").isalnum():
        raise LivelinessError("an endpoint with an invalid type hash")
    key = data_key(int(domain), topic, type, hash)
    return GraphEntity(kind, node, topic, type, key, read_qos(qos), session, False, hash)


def _bridged(token: str) -> GraphEntity | None:
    parts = token.split("/", 7)
    if len(parts) == 3 and parts[2] == ADMIN:
        return GraphEntity("bridge", "", session=parts[1], is_bridged=True)
    if len(parts) < 6 or parts[0] != "@" or parts[2] != ADMIN or not all(parts):
        raise LivelinessError("a token without the components of zenoh-bridge-ros2dds")
    session, letters, key, type = parts[1], parts[3], parts[4], parts[5]
    kind = _DDS_KINDS.get(letters)
    if kind is None:
        return None
    key, type = key.replace(_DDS_SLASH, "/"), type.replace(_DDS_SLASH, "/")
    if not is_full_name(f"/{key}"):
        raise LivelinessError("an endpoint with an invalid name")
    if not is_ros_type(type):
        raise LivelinessError("an endpoint with an invalid type")
    if kind in ("publisher", "subscription") and len(parts) != 7:
        raise LivelinessError("an endpoint without QoS")
    qos = read_dds_qos(parts[6]) if len(parts) == 7 else TokenQos()
    return GraphEntity(kind, "", f"/{key}", type, key, qos, session, True)
