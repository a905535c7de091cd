"""Servers that break the Foxglove protocol, refuse, or send more than a viewer can hold."""

from __future__ import annotations

import http
import json
import socket
import ssl
import struct
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import trustme
from bridges import SCAN, STRING, BridgeReader, reading
from hostile_definitions import REFUSED, renamed
from websockets.http11 import Request, Response
from websockets.sync.server import ServerConnection

from webviz.api.observation import NO_OFFER
from webviz.data.messages import definition, encode, type_exists
from webviz.sources.bridge import definitions as bridge_definitions
from webviz.sources.bridge import foxglove, foxglove_channels, json_frames, source

CLOUD = "sensor_msgs/msg/PointCloud2"
NUMBER = "std_msgs/msg/Float64"
Liar = Callable[..., BridgeReader]


def channel(id: int, topic: str, type: str = STRING, **fields: Any) -> dict[str, Any]:
    text = definition(type) if type_exists(type) else ""
    defaults = {"encoding": "cdr", "schemaEncoding": "ros2msg", "schema": text}
    return {"id": id, "topic": topic, "schemaName": type, **defaults, **fields}


def advertise(*channels: dict[str, Any]) -> str:
    return json.dumps({"op": "advertise", "channels": channels})


def next_subscription(connection: ServerConnection) -> int:
    """The id of the next subscription."""
    while True:
        text = json.loads(connection.recv())
        if text["op"] == "subscribe":
            return text["subscriptions"][0]["id"]


def message(subscription: int, text: str) -> bytes:
    return struct.pack("<BIQ", 1, subscription, 5) + encode(STRING, {"data": text})


MALFORMED = {
    "no message": b"\x01\x00",
    "no time": b"\x02\x00\x00",
    "no response": b"\x03" + b"\x00" * 5,
    "a response with a long encoding": struct.pack("<BIII", 3, 1, 1, 0xFFFFFFFF),
    "an asset with a long error": struct.pack("<BIBI", 4, 1, 1, 1000) + b"short",
    "nothing": b"",
    "no JSON": "{",
    "an array": "[]",
    "no op": "{}",
    "a number as op": '{"op": 5}',
    "deep nesting": '{"op": "advertise", "channels": ' + "[" * 100_000,
    "channels of another type": '{"op": "advertise", "channels": 5}',
    "an id that is a text": advertise(channel(1, "/x") | {"id": "one"}),
}


def test_malformed_frames_are_counted_and_the_rest_is_read(liar: Liar) -> None:
    def script(connection: ServerConnection) -> None:
        for frame in MALFORMED.values():
            connection.send(frame)
        connection.send(b"\xc8future opcode")
        connection.send('{"op": "playbackState", "status": 3}')
        connection.send(struct.pack("<BIQ", 1, 77, 5) + b"of no subscription")
        connection.send(struct.pack("<BIII", 3, 1, 1, 3) + b"cdr of no call")
        connection.send(advertise(channel(1, "/words")))
        connection.send(message(next_subscription(connection), "still here"))

    reader = liar(script)
    reader.want(words=STRING)
    assert reader.decoded("/words", STRING).data == "still here"
    ignored = f"{len(MALFORMED)} frames of the bridge ignored."
    reader.until(lambda: any(remark.startswith(ignored) for remark in reader.bridge.remarks))


def test_only_the_channel_of_the_subscribed_type_is_read(liar: Liar) -> None:
    subscriptions: list[int] = []

    def script(connection: ServerConnection) -> None:
        others = "nav_msgs/msg/Path", "tf2_msgs/msg/TFMessage"  # one before it, one behind
        channels = [channel(number, "/words", type_) for number, type_ in enumerate(others, 1)]
        connection.send(advertise(*channels, channel(3, "/words", NUMBER)))
        text = json.loads(connection.recv())
        while text["op"] != "subscribe":
            text = json.loads(connection.recv())
        subscriptions.extend(each["channelId"] for each in text["subscriptions"])
        head = struct.pack("<BIQ", 1, text["subscriptions"][0]["id"], 5)
        connection.send(head + encode(NUMBER, {"data": 2.5}))

    reader = liar(script)
    reader.want(words=NUMBER)
    assert reader.decoded("/words", NUMBER).data == 2.5
    assert subscriptions == [3]


def test_channels_over_the_limit_are_dropped_and_reported(liar: Liar) -> None:
    def script(connection: ServerConnection) -> None:
        channels = [channel(i, f"/topic{i}") for i in range(100_000)]
        connection.send(advertise(channel(100_001, "/words"), *channels))
        connection.send(message(next_subscription(connection), "first"))

    reader = liar(script)
    reader.want(words=STRING)
    assert reader.decoded("/words", STRING).data == "first"
    reader.until(lambda: len(reader.source.offers()) == foxglove_channels.MAX_TOPICS)
    reader.until(lambda: any("90001 topics are left out" in r for r in reader.bridge.remarks))


def test_definitions_of_all_channels_are_bounded(
    liar: Liar, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(foxglove_channels, "MAX_SCHEMAS", 10_000)
    texts = [f"string data # {'x' * 3000} {i}" for i in range(5)]
    reader = liar(
        lambda connection: connection.send(
            advertise(*(channel(i, f"/t{i}", schema=text) for i, text in enumerate(texts)))
        )
    )
    reader.until(lambda: len(reader.source.offers()) == 3)


def nested(text: str, depth: int, names: str = "A") -> str:
    """A definition of messages in messages, of which each level has the names of the next."""
    parts = [text.format(0)]
    for level in range(depth):
        inner = text.format(level + 1) if level + 1 < depth else "uint8 x"
        parts += [f"MSG: bad_msgs/{name}{level}\n{inner}" for name in names]
    return f"\n{'=' * 80}\n".join(parts)


@pytest.mark.parametrize(
    ("schema", "problem"),
    [
        ("string data\n===\nwhat", "not valid .msg text"),
        ("=" * 80 + "\nIDL: bad_msgs/msg/Bad\nmodule {", "not valid IDL"),
        ("bad_msgs/Bad[] again", "cannot contain itself"),
        ("other_msgs/Missing x", "whose definition is missing"),
        ("", "does not send the definition"),
        ("# " + "x" * (1 << 20), "longer than 1 MB"),
        ("(" * 50_000, "not valid .msg text"),
        (nested("A{0} a\nA{0} b", 60), "more than 20000 fields"),
        (nested("A{0} a\nB{0} b", 60, "AB"), "more than 20000 fields"),
        (nested("A{0} a", 5000), "nested deeper than 64 levels"),
        (
            f"std_msgs/Header header\n{'=' * 80}\nMSG: std_msgs/Header\nuint8 x",
            "differs from ROS 2's",
        ),
    ],
)
def test_hostile_definitions_are_problems_of_their_topic(
    liar: Liar, schema: str, problem: str
) -> None:
    bad = "bad_msgs/msg/Bad"
    reader = liar(lambda c: c.send(advertise(channel(1, "/bad", bad, schema=schema))))
    reader.want(bad=bad)

    def is_told() -> bool:
        """Return whether the problem is; a link may end while a definition is read."""
        offer = reader.source.offers().get("/bad")
        return offer is not None and problem in offer.problem

    reader.until(is_told)


def test_everything_but_hostile_definitions_is_subscribed_to(liar: Liar) -> None:
    evil = {f"evil{number}": each for number, each in enumerate(REFUSED.values())}
    channels = [
        channel(number, f"/{name}", f"{name}_msgs/msg/Evil", schema=renamed(text, f"{name}_msgs"))
        for number, (name, (text, _)) in enumerate(evil.items(), 2)
    ]
    connections = list[ServerConnection]()

    def script(connection: ServerConnection) -> None:
        connections.append(connection)
        connection.send(advertise(*channels, channel(1, "/words")))
        connection.send(message(next_subscription(connection), "still here"))

    reader = liar(script)
    topics: dict[str, Any] = {name: f"{name}_msgs/msg/Evil" for name in evil}
    reader.want(**topics, words=STRING)
    assert reader.decoded("/words", STRING).data == "still here"
    for name, (_, problem) in evil.items():
        reader.until(
            lambda name=name, sentence=problem: (
                sentence in reader.source.offers().get(f"/{name}", NO_OFFER).problem
            )
        )
    assert len(connections) == 1


def test_services_with_hostile_definitions_do_not_end_the_connection(liar: Liar) -> None:
    services = [
        {
            "id": number,
            "name": f"/evil{number}",
            "type": f"evil{number}_msgs/srv/Evil",
            "requestSchema": renamed(text, f"evil{number}_msgs"),
            "responseSchema": "",
        }
        for number, (text, _) in enumerate(REFUSED.values(), 1)
    ]
    connections = list[ServerConnection]()

    def script(connection: ServerConnection) -> None:
        connections.append(connection)
        connection.send(json.dumps({"op": "advertiseServices", "services": services}))
        connection.send(advertise(channel(1, "/words")))
        connection.send(message(next_subscription(connection), "still here"))

    reader = liar(script)
    reader.want(words=STRING)
    assert reader.decoded("/words", STRING).data == "still here"
    assert len(connections) == 1
    assert not any(type_exists(f"{each['type']}_Request") for each in services)


def test_definitions_of_services_are_bounded_together(
    liar: Liar, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bridge_definitions, "MAX_SERVICE_TEXT", 1000)
    services = [
        {
            "id": number,
            "name": f"/many{number}",
            "type": f"many_msgs/srv/Many{number}",
            "requestSchema": "uint8 a # ".ljust(100),
            "responseSchema": "uint8 b # ".ljust(200),
        }
        for number in range(5)
    ]

    def script(connection: ServerConnection) -> None:
        connection.send(json.dumps({"op": "advertiseServices", "services": services}))
        connection.send(advertise(channel(1, "/words")))

    reader = liar(script)
    reader.until(lambda: "/words" in reader.source.offers())
    numbers = [number for number in range(5) if type_exists(f"many_msgs/srv/Many{number}_Request")]
    assert numbers == [0, 1, 2]


@pytest.mark.parametrize(
    ("fields", "problem"),
    [
        ({"encoding": "ros1"}, "is a message of ROS 1"),
        ({"encoding": "flatbuffer"}, "comes as 'flatbuffer', no display reads that"),
        ({"schemaEncoding": "omgidl"}, "is defined as 'omgidl'"),
    ],
)
def test_unread_encodings_are_listed_with_the_reason(
    liar: Liar, fields: dict[str, str], problem: str
) -> None:
    reader = liar(lambda c: c.send(advertise(channel(1, "/words", **fields))))
    reader.want(words=STRING)
    reader.until(lambda: "/words" in reader.source.offers())
    assert problem in reader.source.offers()["/words"].problem


def test_names_that_ros_does_not_allow_are_left_out(liar: Liar) -> None:
    names = ["no slash", "/a b", "/" + "x" * 10_000, "/evil\x1b[2J\n", ""]
    channels = [channel(i, name) for i, name in enumerate(names)]
    reader = liar(lambda c: c.send(advertise(channel(9, "/good"), *channels)))
    reader.until(lambda: set(reader.source.offers()) == {"/good"})
    reader.until(lambda: any("no slash" in remark for remark in reader.bridge.remarks))
    assert all("\x1b" not in r and len(r) < 400 for r in reader.bridge.remarks)


def test_a_flood_of_statuses_keeps_the_newest(liar: Liar) -> None:
    def script(connection: ServerConnection) -> None:
        for i in range(5000):
            connection.send(
                json.dumps({"op": "status", "level": 2, "message": f"{i} " + "x" * 999})
            )

    reader = liar(script)
    reader.until(lambda: any("4999 x" in remark for remark in reader.bridge.remarks))
    assert len(reader.bridge.remarks) == foxglove.MAX_STATUSES


def test_a_message_above_the_limit_is_a_problem_of_its_topic(
    liar: Liar, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(source, "MAX_TOTAL", 3 << 20)

    def script(connection: ServerConnection) -> None:
        connection.send(advertise(channel(1, "/words")))
        connection.send(message(next_subscription(connection), "x" * (5 << 20)))

    reader = liar(script)
    reader.want(words=STRING)
    reader.until(lambda: "/words" in reader.source.offers())
    text = "a message of 5 MB is above the limit of 3 MB; publish smaller ones"
    reader.until(lambda: reader.source.offers()["/words"].problem == text)


def test_a_frame_above_all_limits_ends_the_connection(
    liar: Liar, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(source, "MAX_TOTAL", 1000)
    begun: list[float] = []

    def script(connection: ServerConnection) -> None:
        begun.append(time.monotonic())
        connection.send(iter(lambda: "[" * 100_000, None))  # an endless text

    reader = liar(script)
    reader.until(lambda: "sent a frame above the limit" in reader.bridge.problem)
    reader.until(lambda: len(begun) >= 2)  # it is tried again


def test_a_message_of_endless_empty_parts_ends_the_connection(liar: Liar) -> None:
    def script(connection: ServerConnection) -> None:
        connection.send(iter(lambda: b"", None))

    reader = liar(script)
    reader.until(lambda: "a message in more than" in reader.bridge.problem)


def test_a_text_above_its_limit_is_ignored(liar: Liar, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(json_frames, "MAX_TEXT", 1000)
    reader = liar(lambda connection: connection.send(advertise(channel(1, "/" + "x" * 2000))))
    reader.until(lambda: any("above the limit" in remark for remark in reader.bridge.remarks))


def test_calls_that_are_never_answered_end_and_are_bounded(
    liar: Liar, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(foxglove, "MAX_PENDING", 3)
    offer = {"id": 1, "name": "/sleep", "type": "std_srvs/srv/Empty"}
    reader = liar(lambda c: c.send(json.dumps({"op": "advertiseServices", "services": [offer]})))
    reader.until(lambda: reader.bridge.is_up and reader.bridge.limits)
    reader.until(lambda: "does not answer" in str(_call(reader, 0.0).exception(20)))
    answers = [_call(reader, 0.5) for _ in range(4)]
    assert "does not answer within 0.5 s" in str(answers[0].exception(20))
    assert "owes 3 answers" in str(answers[3].exception(20))
    assert "does not answer" in str(_call(reader, 0.1).exception(20))


def _call(reader: BridgeReader, timeout_s: float) -> Any:
    return reader.source.graph.call("/sleep", "std_srvs/srv/Empty", b"\0\1\0\0\0", timeout_s)


def refuse(status: int, body: str) -> Callable[[ServerConnection, Request], Response]:
    return lambda connection, request: connection.respond(http.HTTPStatus(status), body)


@pytest.mark.parametrize(
    ("status", "body", "sentence"),
    [
        (400, "Missing expected sec-websocket-protocol header", "refuses the protocols"),
        (401, "", "asks for credentials (HTTP 401)"),
        (404, "", "answers with HTTP 404"),
    ],
)
def test_refusals_are_explained(liar: Liar, status: int, body: str, sentence: str) -> None:
    reader = liar(lambda connection: None, process_request=refuse(status, body))
    reader.until(lambda: sentence in reader.bridge.problem)
    assert reader.bridge.remedy
    assert body in reader.bridge.problem


def test_large_messages_come_over_the_only_connection_that_a_bridge_accepts(liar: Liar) -> None:
    requests = list[Request]()

    def accept_one(connection: ServerConnection, request: Request) -> Response | None:
        requests.append(request)
        return refuse(503, "")(connection, request) if len(requests) > 1 else None

    def script(connection: ServerConnection) -> None:
        connection.send(advertise(channel(1, "/points", CLOUD)))
        head = struct.pack("<BIQ", 1, next_subscription(connection), 5)
        connection.send(head + encode(CLOUD, {"width": 7}))

    reader = liar(script, process_request=accept_one)
    reader.want(points=CLOUD)
    assert reader.decoded("/points", CLOUD).width == 7
    assert len(requests) > 1


def test_no_redirection_is_followed(liar: Liar, tmp_path: Path) -> None:
    got: list[Request] = []

    def steal(connection: ServerConnection, request: Request) -> None:
        got.append(request)

    def redirect(connection: ServerConnection, request: Request) -> Response:
        response = connection.respond(http.HTTPStatus.FOUND, "")
        response.headers["Location"] = f"{thief.bridge.name}/steal"
        return response

    thief = liar(lambda connection: None, process_request=steal)
    first = liar(lambda connection: None, process_request=redirect)
    file = tmp_path / "headers"
    file.write_text("X-Token: secret\n")
    with reading(first.bridge.name, headers=file) as reader:
        reader.until(lambda: "answers with HTTP 302 instead" in reader.bridge.problem)
    assert all(request.path != "/steal" for request in got)


def test_tokens_are_sent_in_headers(liar: Liar, tmp_path: Path) -> None:
    got: list[str] = []

    def check(connection: ServerConnection, request: Request) -> None:
        got.append(request.headers.get("Authorization", ""))

    first = liar(lambda connection: None, process_request=check)
    first.until(lambda: first.bridge.is_up)
    file = tmp_path / "headers"
    file.write_text("Authorization: Bearer secret\n")
    with reading(first.bridge.name, headers=file) as reader:
        reader.until(lambda: reader.bridge.is_up)
    assert got[-1] == "Bearer secret"


def test_old_bridges_are_spoken_to(liar: Liar) -> None:
    reader = liar(lambda c: c.send(advertise(channel(1, "/scan", SCAN))), "foxglove.websocket.v1")
    reader.until(lambda: "/scan" in reader.source.offers())


def test_a_server_without_websockets_is_reported() -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        port = listener.getsockname()[1]

        def answer() -> None:
            connection, _ = listener.accept()
            with connection:
                connection.recv(1 << 16)
                connection.sendall(b"SSH-2.0-OpenSSH_9.6\r\n")

        threading.Thread(target=answer, daemon=True).start()
        with reading(f"ws://127.0.0.1:{port}") as reader:
            reader.until(lambda: "is not a websocket server" in reader.bridge.problem)
    with reading(f"ws://127.0.0.1:{port}") as reader:
        reader.until(lambda: reader.bridge.problem == f"Nothing listens on 127.0.0.1:{port}.")
    with reading("ws://no-such-robot.invalid:8765") as reader:
        reader.until(lambda: "is unknown" in reader.bridge.problem)
        assert not reader.bridge.was_up


def test_certificates_must_be_trusted(
    liar: Liar, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    authority = trustme.CA()
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    authority.issue_cert("localhost").configure_cert(context)
    plain = liar(lambda connection: None, ssl=context)
    port = plain.bridge.name.rpartition(":")[2]
    plain.until(lambda: not plain.bridge.is_up and "websocket server" in plain.bridge.problem)
    with reading(f"wss://localhost:{port}") as reader:
        reader.until(lambda: "is not trusted" in reader.bridge.problem)
        assert "SSL_CERT_FILE" in reader.bridge.remedy
    authority.cert_pem.write_to_path(str(tmp_path / "ca.pem"))
    monkeypatch.setenv("SSL_CERT_FILE", str(tmp_path / "ca.pem"))
    with reading(f"wss://localhost:{port}") as reader:
        reader.until(lambda: reader.bridge.is_up)
