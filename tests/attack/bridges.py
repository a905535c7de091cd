"""Bridges that lie: frames of both protocols, whatever was asked for."""

from __future__ import annotations

import base64
import json
import struct
import time
from pathlib import Path
from random import Random
from typing import Any

import cbor2
from serving import serving
from websockets.exceptions import ConnectionClosed
from websockets.sync.server import ServerConnection, serve

from tests.attack.attack import Case, changed_part, mutated
from webviz.api.declared import Topic
from webviz.data.messages import definition, encode
from webviz.sources import Subscription
from webviz.sources.bridge.address import address
from webviz.sources.bridge.source import BridgeSource

FOXGLOVE = "foxglove.sdk.v1"
STRING = "std_msgs/msg/String"
WATCHED_S = 0.5
"""Time in seconds for which a bridge is read."""
HONEST_S = 15.0
"""Time in seconds within which a message of an honest topic must arrive from a bridge that also
lies."""
NAMES = ("/words", "/tf", "words", "", "/", "/a//b", "/\u202e", "/\x1b[2J", "/x" * 300, "/<b>")
TYPES = (STRING, "tf2_msgs/msg/TFMessage", "evil_msgs/msg/Nothing", "", "a/b/c/d", "x" * 5000)
SCHEMAS = ("", "string data", "uint8[2000000000] a", "int32 A=" + "9" * 5000, "(" * 3000, "\x00")


def _channel(random: Random, number: int) -> dict[str, Any]:
    return {
        "id": number,
        "topic": random.choice(NAMES),
        "encoding": random.choice(("cdr", "ros1", "json", "")),
        "schemaName": random.choice(TYPES),
        "schemaEncoding": random.choice(("ros2msg", "ros2idl", "ros1msg", "jsonschema")),
        "schema": random.choice((*SCHEMAS, definition(STRING))),
    }


def _foxglove(random: Random) -> str | bytes:
    cdr = encode(STRING, {"data": "x"})
    match random.randrange(8):
        case 0:
            text = {"op": "serverInfo", "name": "x", "capabilities": ["services", "time"]}
        case 1 | 2:
            channels = [_channel(random, i) for i in range(random.choice((1, 3, 300)))]
            text = {"op": "advertise", "channels": channels}
        case 3:
            service = {"id": 1, "name": "/a", "type": "a_srvs/srv/A", "requestSchema": "", "x": 1}
            schemas = {"requestSchema": random.choice(SCHEMAS), "responseSchema": "uint8 x"}
            text = {"op": "advertiseServices", "services": [{**service, **schemas}]}
        case 4:
            text = {"op": "status", "level": 2, "message": random.choice(NAMES), "id": "a"}
        case 5:
            text = {"op": "parameterValues", "parameters": [{"name": "/a.b", "value": 1}], "id": ""}
        case 6:
            return struct.pack("<BIQ", 1, random.choice((0, 1, 2**32 - 1)), 5) + cdr
        case _:
            return random.choice((b"", b"\x01", b"\x03" * 9, b"\x02" + b"\xff" * 8))
    return json.dumps(changed_part(random, text) if random.random() < 0.4 else text)


def _rosbridge(random: Random) -> str | bytes:
    values = {
        "topics": list(NAMES),
        "types": [random.choice(TYPES) for _ in NAMES],
        "typedefs_full_text": list(SCHEMAS),
        "nodes": list(NAMES),
    }
    match random.randrange(5):
        case 0:
            answer = {"op": "service_response", "id": "1", "result": True, "values": values}
        case 1:
            answer = {"op": "publish", "topic": random.choice(NAMES), "msg": {"data": "x"}}
        case 2:
            answer = {"op": "fragment", "id": "1", "data": "x", "num": 0, "total": 2**40}
        case 3:
            raw = {"secs": 1, "nsecs": -1, "bytes": b"x"}
            answer = {"op": "publish", "topic": "/words", "msg": raw}
            return cbor2.dumps(answer)
        case _:
            answer = {"op": "status", "level": "error", "msg": random.choice(NAMES)}
    return json.dumps(changed_part(random, answer) if random.random() < 0.4 else answer)


def draw(random: Random) -> Case:
    """Reads from bridges that lie in a process of its own."""
    name, make = random.choice((("a.foxglove", _foxglove), ("a.rosbridge", _rosbridge)))
    frames: list[list[Any]] = []
    for _ in range(random.randrange(1, 12)):
        frame = make(random)
        if random.random() < 0.2:
            changed = mutated(random, frame if isinstance(frame, bytes) else frame.encode())
            frame = changed if isinstance(frame, bytes) else changed.decode(errors="replace")
        is_binary = isinstance(frame, bytes)
        text = base64.b64encode(frame).decode() if isinstance(frame, bytes) else frame
        frames.append([is_binary, text])
    return Case(name, json.dumps(frames).encode())


def read_bridge(path: Path) -> None:
    """Read from a bridge that sends the frames of a file, and from then on behaves."""
    frames = [
        base64.b64decode(text) if is_binary else text
        for is_binary, text in json.loads(path.read_bytes())
    ]
    is_foxglove = path.suffix == ".foxglove"

    def lie(connection: ServerConnection) -> None:
        try:
            for frame in frames:
                connection.send(frame)
            if is_foxglove:
                _behave(connection)
            for _ in connection:
                pass
        except ConnectionClosed:
            return

    protocols: Any = [FOXGLOVE] if is_foxglove else None
    with serving(serve(lie, "127.0.0.1", 0, compression=None, subprotocols=protocols)) as server:
        source = BridgeSource(address(f"ws://127.0.0.1:{server.socket.getsockname()[1]}"))
        try:
            _watch(source, HONEST_S if is_foxglove else WATCHED_S, is_foxglove)
        finally:
            source.close()


def _behave(connection: ServerConnection) -> None:
    """Offer one more topic as a bridge should, and send its message."""
    schema = {"schemaName": STRING, "schemaEncoding": "ros2msg", "schema": definition(STRING)}
    honest = {"id": 4_000_000, "topic": "/honest", "encoding": "cdr", **schema}
    connection.send(json.dumps({"op": "advertise", "channels": [honest]}))
    for text in connection:
        request = json.loads(text) if isinstance(text, str) else {}
        for each in request.get("subscriptions", ()) if request.get("op") == "subscribe" else ():
            if each["channelId"] == honest["id"]:
                head = struct.pack("<BIQ", 1, each["id"], 5)
                connection.send(head + encode(STRING, {"data": "honest"}))


def _watch(source: BridgeSource, patience_s: float, must_arrive: bool) -> None:
    """Subscribe to all that a bridge offers, as long as it takes."""
    end = time.monotonic() + patience_s
    arrived: set[str] = set()
    while time.monotonic() < end and "/honest" not in arrived:
        offers = source.offers()
        subscription = {
            topic: Subscription(offer.publishers[0].type, Topic(topic))
            for topic, offer in offers.items()
            if offer.publishers
        }
        source.want(subscription)
        arrived |= {topic for topic, raws in source.inbox.drain().items() if raws}
        _ = [str(remark) for bridge in source.bridges for remark in bridge.remarks]
        time.sleep(0.01)
    assert not must_arrive or "/honest" in arrived, "an honest topic of the bridge never arrives"
