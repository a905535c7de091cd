"""Definitions of a bridge, by which nothing is read but its own messages."""

from __future__ import annotations

import json
import struct
import time
from collections.abc import Callable, Mapping
from contextlib import closing
from itertools import count
from typing import Any

import pytest
from bridges import BridgeReader
from filled_messages import filled
from rosbags.typesys import Stores, get_typestore
from waiting import until
from websockets.sync.server import ServerConnection

from webviz.api.declared import Topic
from webviz.api.robots import NamespacedRobot
from webviz.data.messages import decode, register, type_exists
from webviz.data.messages.typestore import fields
from webviz.sources import Subscription
from webviz.sources.bridge import pacing
from webviz.sources.fleet.source import FleetSource
from webviz.sources.recording.memory import MemoryHistory

CDR = b"\0\1\0\0"
PART = f"{'=' * 80}\nMSG: {{}}\n"
Liar = Callable[..., BridgeReader]
ServedTopic = tuple[str, str, bytes]
"""Type, definition and message of a topic."""


def served(topics: Mapping[str, ServedTopic]) -> Callable[[ServerConnection], None]:
    """Offer topics, and send the message of each that is subscribed to."""

    def script(connection: ServerConnection) -> None:
        channels = [
            {"id": id, "topic": topic, "schemaName": type_, "encoding": "cdr", "schema": text}
            for id, (topic, (type_, text, _)) in enumerate(topics.items())
        ]
        messages = [message for _, _, message in topics.values()]
        connection.send(json.dumps({"op": "advertise", "channels": channels}))
        for frame in connection:
            for each in json.loads(frame).get("subscriptions", ()):
                head = struct.pack("<BIQ", 1, each["id"], 5)
                connection.send(head + CDR + messages[each["channelId"]])

    return script


def read(reader: BridgeReader, topic: str, type_: str, resubscriptions: int = 0) -> Any:
    reader.want(resubscriptions, **{topic: type_})
    return reader.decoded(f"/{topic}", type_)


@pytest.mark.parametrize("is_live_first", [True, False])
def test_bridges_and_live_topics_may_define_a_type_otherwise(
    liar: Liar, is_live_first: bool
) -> None:
    name = f"liars_msgs/msg/Basket{is_live_first:d}"
    part = PART.format(f"liars_msgs/Apple{is_live_first:d}")
    text = f"Apple{is_live_first:d} apple\n{part}{{}} weight\n"
    live = text.format("uint8")
    if is_live_first:
        register(name, live)
    whole = liar(served({"/basket": (name, text.format("int32"), struct.pack("<i", -7))}))
    half = liar(served({"/basket": (name, text.format("float32"), struct.pack("<f", 0.5))}))
    assert read(whole, "basket", name).apple.weight == -7
    assert read(half, "basket", name).apple.weight == 0.5
    if not is_live_first:
        assert not type_exists(name)
        register(name, live)
    assert decode(name, CDR + b"\x09").apple.weight == 9
    assert read(whole, "basket", name, resubscriptions=1).apple.weight == -7


def test_topics_of_a_bridge_may_define_a_type_otherwise(
    liar: Liar, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also one with large messages, over a connection of its own; one that is invalid is alone."""
    name = "liars_msgs/msg/Pear"
    monkeypatch.setattr(pacing, "LARGE_TYPES", frozenset((name,)))
    topics = {
        "/whole": (name, "int32 weight\n", struct.pack("<i", -7)),
        "/half": (name, "float32 weight\n", struct.pack("<f", 0.5)),
        "/bad": (name, "what weight\n", b""),
    }
    reader = liar(served(topics))
    reader.want(whole=name, half=name, bad=name)
    reader.until(lambda: reader.take("/whole") and reader.take("/half"))
    for topic, weight in {"/whole": -7, "/half": 0.5}.items():
        raw = reader.arrived[topic][0]
        assert decode(name, raw.cdr, raw.types).weight == weight
    reader.until(lambda: "definition is missing" in reader.source.offers()["/bad"].problem)
    assert reader.source.offers()["/whole"].problem == ""
    assert reader.source.offers()["/half"].problem == ""


@pytest.mark.parametrize(
    ("name", "change"),
    [("geometry_msgs/msg/Polygon", "uint8 number"), ("liars_msgs/msg/Known", "uint8 number")],
)
def test_services_of_a_bridge_change_no_known_type(liar: Liar, name: str, change: str) -> None:
    register("liars_msgs/msg/Known", "float64 number")
    before = fields(name)
    short = name.replace("/msg/", "/")
    services = [
        {
            "id": 1,
            "name": "/lie",
            "type": f"liars_msgs/srv/Lie{name.rpartition('/')[2]}",
            "requestSchema": f"{short} a\n{PART.format(short)}{change}\n",
            "responseSchema": "",
        },
        {
            "id": 2,
            "name": "/truth",
            "type": f"liars_msgs/srv/Truth{name.rpartition('/')[2]}",
            "requestSchema": "liars_msgs/Part[] parts\n"
            f"{PART.format('liars_msgs/Part')}float64 mass\n",
            "responseSchema": "bool success\n",
        },
    ]
    advertised = json.dumps({"op": "advertiseServices", "services": services})
    liar(lambda connection: connection.send(advertised)).until(
        lambda: type_exists(f"{services[1]['type']}_Response")
    )
    assert fields(name) == before
    assert not type_exists(f"{services[0]['type']}_Request")


def test_messages_of_a_bridge_are_recorded_with_their_definition(liar: Liar) -> None:
    name = "liars_msgs/msg/Plum"
    text = f"Stone stone\n{PART.format('liars_msgs/Stone')}int32 weight\n"
    register(name, f"Stone stone\n{PART.format('liars_msgs/Stone')}uint8 weight\n")
    reader = liar(served({"/plum": (name, text, struct.pack("<i", -7))}))
    memory = MemoryHistory(reader.source)
    memory.recent.seconds, memory.recent.max_bytes = 60, 10**6
    read(reader, "plum", name)
    (raw,) = reader.arrived["/plum"]
    reader.until(lambda: memory.recorded_channels.find("/plum"))
    channel = memory.recorded_channels.find("/plum", raw.types)
    assert channel is not None
    assert channel.definition == text
    memory.recent.put("/plum", raw)
    memory.hold()
    (recorded,) = memory.messages(memory.channels_of("/plum"), 0)
    assert decode(name, recorded.cdr, recorded.types).stone.weight == -7


def test_stamps_in_types_of_a_robot_are_corrected(liar: Liar) -> None:
    name, ahead_s = "liars_msgs/msg/Ripe", 3.0

    def script(connection: ServerConnection) -> None:
        text = "uint8 kind\nbuiltin_interfaces/Time at\n"
        channel = {"id": 1, "topic": "/ripe", "schemaName": name, "encoding": "cdr", "schema": text}
        connection.send(json.dumps({"op": "advertise", "channels": [channel]}))
        (subscription,) = json.loads(connection.recv())["subscriptions"]
        while True:
            stamp_ns = time.time_ns() + round(ahead_s * 1e9)
            head = struct.pack("<BIQ", 1, subscription["id"], stamp_ns)
            message = struct.pack("<BxxxiI", 1, *divmod(stamp_ns, 10**9))
            connection.send(head + CDR + message)
            time.sleep(0.02)

    url = liar(script).bridge.name
    fleet = FleetSource([NamespacedRobot("r1", connection=url)], None)

    def late_s() -> float | None:
        raws = fleet.inbox.drain().get("/r1/ripe")
        if not raws or not fleet.bridges[0].clock_s:
            return None
        message = decode(name, raws[-1].cdr, raws[-1].types)
        return time.time() - message.at.ns / 1e9

    with closing(fleet):
        fleet.want({"/r1/ripe": Subscription(name, Topic("/r1/ripe"))})
        until(lambda: (s := late_s()) is not None and abs(s) < 1.0, lambda: fleet.bridges)


def test_messages_of_an_older_distribution_have_defaults_for_missing_fields(liar: Liar) -> None:
    """Galactic's Marker has no textures, which its class here has."""
    store, name = get_typestore(Stores.ROS2_GALACTIC), "visualization_msgs/msg/Marker"
    text, _ = store.generate_msgdef(name, ros_version=2)
    own_message = filled(store, name, count(1))
    cdr = bytes(store.serialize_cdr(own_message, name))
    marker = read(liar(served({"/marker": (name, text, cdr[4:])})), "marker", name)
    assert (marker.id, marker.text, marker.scale.x) == (
        own_message.id,
        own_message.text,
        own_message.scale.x,
    )
    assert (marker.texture_resource, marker.mesh_file.filename) == ("", "")
