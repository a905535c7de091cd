"""The process that reads attacked definitions by each door, and uses their types as displays do."""

from __future__ import annotations

import contextlib
import json
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import cbor2
from serving import serving
from websockets.exceptions import ConnectionClosed
from websockets.sync.server import ServerConnection
from websockets.sync.server import serve as served

from tests.attack import reader
from webviz.api.declared import Topic
from webviz.data.messages import (
    KNOWN,
    MessageError,
    MessageTypes,
    decode,
    definition,
    encode,
    interfaces,
    message_class,
    peek_header,
    register,
    to_tree,
    type_hash,
)
from webviz.data.messages.stamps import shifted
from webviz.panels.sending import fields_of, template
from webviz.sources import Subscription
from webviz.sources.bag.history import BagHistory
from webviz.sources.bridge.address import address
from webviz.sources.bridge.rosbridge_values import to_values
from webviz.sources.bridge.source import BridgeSource
from webviz.sources.inbox import Inbox
from webviz.sources.player import Player

STRING = "std_msgs/msg/String"
SDK = "foxglove.sdk.v1"
HELLO = b"\0\1\0\0\6\0\0\0hello\0"
ARRIVES_S = 40.0
"""Time in seconds until a message of a good topic beside a hostile one is there."""


def read(path: Path) -> None:
    """Read a file; raises what the viewer shows as a sentence.

    Raises:
        AssertionError: a good topic beside the hostile one is lost, or the connection to a bridge.
    """
    door = path.suffix[1:]
    if door in ("mcap", "db3", "bag"):
        _play(path)
        return
    record = json.loads(path.read_text())
    type_, text, message = record["type"], record["text"], bytes.fromhex(record["message"])
    package, _, name = type_.split("/")
    match door:
        case "msg":
            register(type_, text)
            _use(type_, message)
        case "srv":
            interfaces.learn(f"{package}/srv/{name}", text, text)
            _use(f"{package}/srv/{name}_Request", message)
        case "action":
            interfaces.action(f"{package}/action/{name}", f"{text}\n---\n{text}\n---\n{text}\n")
            _use(f"{package}/action/{name}_Goal", message)
        case _:
            with _bridge(door, type_, text, message) as url:
                _listen(url, type_)


def _play(path: Path) -> None:
    """Play a bag, which must open whatever it defines."""
    source = Player(BagHistory(path))
    try:
        offers = source.offers()
        types = {
            topic: offer.publishers[0].type for topic, offer in offers.items() if offer.publishers
        }
        source.want({topic: Subscription(type_, Topic(topic)) for topic, type_ in types.items()})
        source.play_step(source.history.end_ns)
        assert _drained(source.inbox, types) is not None, "the good topic is lost"
    finally:
        source.close()


def _listen(url: str, type_: str) -> None:
    """Read from a bridge until a message of the good topic is there."""
    source = BridgeSource(address(url))
    try:
        types = {"/evil": type_, "/words": STRING}
        source.want({topic: Subscription(each, Topic(topic)) for topic, each in types.items()})
        end_s = time.monotonic() + ARRIVES_S
        while _drained(source.inbox, types) is None:
            assert time.monotonic() < end_s, "the good topic of a bridge is lost"
            time.sleep(0.01)
    finally:
        source.close()


def _drained(inbox: Inbox, types: Mapping[str, str]) -> str | None:
    """Use what has arrived, and return the text of the good topic, None without one."""
    result = None
    for topic, raws in inbox.drain().items():
        for raw in raws:
            if topic == "/words":
                result = decode(STRING, raw.cdr).data
            else:
                _use(types[topic], raw.cdr, raw.types)
    return result


def _use(type_: str, cdr: bytes, types: MessageTypes = KNOWN) -> None:
    """Use a type and a message of it as displays, panels and recordings do."""
    for use in (
        lambda: message_class(type_, types)(),
        lambda: fields_of(template(type_)),
        lambda: encode(type_, None, types),
        lambda: definition(type_, types),
        lambda: type_hash(type_),
        lambda: peek_header(type_, cdr, types),
        lambda: to_tree(decode(type_, cdr, types)),
        lambda: to_values(type_, cdr),
        lambda: shifted(type_, cdr, 1, types),
    ):
        with contextlib.suppress(MessageError):
            use()


@contextlib.contextmanager
def _bridge(door: str, type_: str, text: str, message: bytes) -> Iterator[str]:
    """Serve a hostile and a good topic, in the protocol that a door names; its address."""
    talk = _foxglove if door == "foxglove" else _rosbridge
    connections = list[ServerConnection]()

    def answer(connection: ServerConnection) -> None:
        connections.append(connection)
        with contextlib.suppress(ConnectionClosed):
            talk(connection, type_, text, message)

    protocols: Any = [SDK] if door == "foxglove" else None
    server = served(answer, "127.0.0.1", 0, subprotocols=protocols, compression=None, max_size=None)
    with serving(server):
        yield f"ws://127.0.0.1:{server.socket.getsockname()[1]}"
        assert len(connections) == 1, "the bridge was connected to again"


def _foxglove(connection: ServerConnection, type_: str, text: str, message: bytes) -> None:
    data = {1: message, 2: HELLO}
    topics = {1: ("/evil", type_, text), 2: ("/words", STRING, "string data")}
    channels = [
        {"id": id, "topic": topic, "encoding": "cdr", "schemaName": name, "schema": own}
        for id, (topic, name, own) in topics.items()
    ]
    service = type_.replace("/msg/", "/srv/")
    both = {"requestSchema": text, "responseSchema": text}
    services = [{"id": 1, "name": "/evil", "type": service, **both}]
    connection.send(json.dumps({"op": "serverInfo", "name": "evil", "capabilities": ["services"]}))
    connection.send(json.dumps({"op": "advertiseServices", "services": services}))
    connection.send(json.dumps({"op": "advertise", "channels": channels}))
    for frame in connection:
        request = json.loads(frame)
        # The hostile message first, so that it is there when the good one is.
        for line in sorted(request.get("subscriptions", ()), key=lambda each: each["channelId"]):
            head = b"\1" + line["id"].to_bytes(4, "little") + (5).to_bytes(8, "little")
            connection.send(head + data[line["channelId"]])


def _rosbridge(connection: ServerConnection, type_: str, text: str, message: bytes) -> None:
    data = {"/evil": message, "/words": HELLO}
    lists: dict[str, Any] = {"topics": list(data), "types": [type_, STRING]}
    values = {
        "/rosapi/topics": lists,
        "/rosapi/topics_and_raw_types": {**lists, "typedefs_full_text": [text, "string data"]},
        "/rosapi/nodes": {"nodes": ["/robot"]},
        "/rosapi/services_for_type": {"services": []},
    }
    for frame in connection:
        request = json.loads(frame)
        if request["op"] == "call_service":
            answer = {"op": "service_response", "id": request["id"], "result": True}
            connection.send(json.dumps({**answer, "values": values[request["service"]]}))
        elif request["op"] == "subscribe":
            inner = {"secs": 5, "nsecs": 6, "bytes": data[request["topic"]]}
            connection.send(cbor2.dumps({"op": "publish", "topic": request["topic"], "msg": inner}))


if __name__ == "__main__":
    reader.serve(read)
