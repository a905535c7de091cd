"""rosbridge as a source: against recorded exchanges of the real one, and against a lying one."""

from __future__ import annotations

import functools
import json
import re
import struct
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import cbor2
import numpy as np
import pytest
from bridges import SCAN, STRING, TF, BridgeReader, reading
from hostile_definitions import REFUSED, renamed
from rosbridge_recording import (
    GET,
    GOAL,
    MAP,
    ODOMETRY,
    PATH,
    POSE,
    Replay,
    do_all,
    read,
)
from several import several
from websockets.sync.server import ServerConnection

from webviz.data.messages import EncodeError, decode, encode, interfaces, register
from webviz.sources.bridge import json_frames, rosapi, rosbridge, rosbridge_wire
from webviz.sources.bridge.rosbridge_values import from_values, to_values
from webviz.sources.bridge.rosbridge_wire import Fragment, Fragments
from webviz.sources.bridge.session import WireError
from webviz.sources.graph import Advertisement, NotConnected

DEMO = Path(__file__).with_name("rosbridge_demo.jsonl.gz")
FRAGMENTS = Path(__file__).with_name("rosbridge_fragments.jsonl.gz")
WIDE = "wide_msgs_of_bridges/msg/Wide"
CLOCK = "rosgraph_msgs/msg/Clock"
Liar = Callable[..., BridgeReader]


@pytest.fixture
def replay() -> Iterator[Callable[..., Replay]]:
    """Play a recording back."""
    with several(Replay) as replay:
        yield replay


def test_the_same_is_sent_as_to_the_real_server(replay: Callable[..., Replay]) -> None:
    server = replay(DEMO)
    with reading(server.url) as reader:
        do_all(reader)
    recorded = [
        json.loads(frame)
        for is_client, frame in read(DEMO)
        if is_client and isinstance(frame, str) and "/rosapi/" not in frame
    ]
    assert _first(server.got) == _first(recorded)


def _first(frames: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Frames of the first connection without their ids: maps have a second one."""
    return [
        {name: value for name, value in frame.items() if name != "id"}
        for frame in frames
        if frame.get("topic") != "/map"
    ]


def test_recorded_topics_are_read(replay: Callable[..., Replay]) -> None:
    with reading(replay(DEMO).url) as reader:
        reader.until_up()
        assert reader.bridge.protocol == "rosbridge"
        offers = reader.source.offers()
        assert offers["/odom"].publishers[0].type == ODOMETRY
        assert offers["/map"].publishers[0].durability == "transient_local"
        reader.until(lambda: reader.source.graph.nodes())
        assert "/sim" in reader.source.graph.nodes()
        reader.until(lambda: "/sim" in reader.bridge.parameters.nodes)
        reader.want(scan=SCAN, map=MAP, path=PATH, robot_description=STRING, tf=TF)
        for topic in ("/scan", "/map", "/path", "/robot_description", "/tf"):
            reader.until(lambda topic=topic: reader.take(topic))
        first = {topic: raws[0].cdr for topic, raws in reader.arrived.items()}
        assert len(decode(SCAN, first["/scan"]).ranges) == 360
        assert decode(MAP, first["/map"]).info.width > 100
        assert decode(STRING, first["/robot_description"]).data.startswith("<?xml")


def test_recorded_answers_are_read(replay: Callable[..., Replay]) -> None:
    interfaces.service(GET)
    request = encode(f"{GET}_Request", {"names": ["robot", "scan_noise", "rate"]})
    with reading(replay(DEMO).url) as reader:
        reader.until_up()
        graph = reader.source.graph
        response = graph.call("/sim/get_parameters", GET, request, 10).result(20)
        values = decode(f"{GET}_Response", response).values
        assert [each.type for each in values] == [4, 3, 3]
        assert values[2].double_value > 0.0
        problem = graph.call("/nobody", GET, request, 10).exception(20)
        assert "finds no service /nobody" in str(problem)
        with pytest.raises(NotConnected, match="sends no files"):
            graph.fetch("package://arm/a.stl").result(20)


def test_a_list_in_fragments_is_read(replay: Callable[..., Replay]) -> None:
    with reading(replay(FRAGMENTS).url) as reader:
        reader.until_up()
        reader.want(odom=ODOMETRY)
        reader.until(lambda: not reader.source.offers()["/odom"].problem)
        reader.until(lambda: reader.source.offers()["/odom"].requested)


def test_all_subscriptions_are_restored_after_a_break(replay: Callable[..., Replay]) -> None:
    first = replay(DEMO)
    with reading(first.url) as reader:
        reader.until_up()
        reader.want(odom=ODOMETRY)
        reader.receive("/odom")
        goal = Advertisement("/goal_pose", POSE)
        reader.source.graph.advertise([goal]).result(20)
        first.close()
        reader.until(lambda: not reader.bridge.is_up)
        assert "/odom" in reader.source.offers()
        second = replay(DEMO, first.port)
        reader.receive("/odom")
        reader.until(lambda: {"advertise", "subscribe"} <= {each["op"] for each in second.got})


def test_the_clock_is_followed(liar: Liar) -> None:
    reader = liar(lambda c: _serve(c, {"/clock": CLOCK}, {"/clock": {"clock": {"sec": 42}}}))
    reader.until(lambda: reader.source.now_ns() == 42_000_000_000)
    assert reader.source.clock_messages() == 1


@pytest.mark.parametrize(
    ("type", "values"),
    [
        (POSE, GOAL),
        (SCAN, {"ranges": [1.0, float("nan"), float("inf")], "intensities": []}),
        ("sensor_msgs/msg/Image", {"encoding": "rgb8", "data": b"\0\xff\x80"}),
        (TF, {"transforms": [{"child_frame_id": "laser"}, {"child_frame_id": "arm"}]}),
        (ODOMETRY, {"pose": {"covariance": list(range(36))}}),
        ("rcl_interfaces/msg/ParameterValue", {"bool_array_value": [True], "type": 6}),
        ("std_msgs/msg/Empty", {}),
        ("diagnostic_msgs/msg/DiagnosticArray", {"status": [{"level": 2, "name": "motor"}]}),
        (WIDE, {"text": "Zürich 東京", "texts": ["a", ""], "words": ["", "b"]}),
    ],
)
def test_values_are_those_of_the_message(type: str, values: dict[str, Any]) -> None:
    register(WIDE, "wstring text\nwstring[] texts\nstring[] words\n")
    cdr = encode(type, values)
    assert from_values(type, json.loads(json.dumps(to_values(type, cdr)))) == cdr


def test_null_is_not_a_number() -> None:
    ranges = decode(SCAN, from_values(SCAN, {"ranges": [None, 1.5]})).ranges
    assert np.isnan(ranges[0])
    assert ranges[1] == 1.5


@pytest.mark.parametrize("values", [{"data": "not base64!"}, {"data": 5}, {"nothing": 1}])
def test_values_that_do_not_fit_are_refused(values: dict[str, Any]) -> None:
    with pytest.raises(EncodeError):
        from_values("sensor_msgs/msg/Image", values)


# A server that lies


@pytest.fixture
def liar(liar: Liar) -> Callable[[Callable[[ServerConnection], None]], BridgeReader]:
    """Run a script for each connection, and read from it."""
    return functools.partial(liar, protocol="")


def _serve(
    connection: ServerConnection,
    types: dict[str, str],
    messages: dict[str, Any] | None = None,
    texts: dict[str, str] | None = None,
) -> None:
    """Answer as rosbridge does, and send a message of each topic that is subscribed to."""
    lists = {"topics": list(types), "types": list(types.values())}
    values = {
        "/rosapi/topics": lists,
        "/rosapi/topics_and_raw_types": {
            **lists,
            "typedefs_full_text": [(texts or {}).get(t, "") for t in types],
        },
        "/rosapi/nodes": {"nodes": ["/robot", "no name"]},
        "/rosapi/services_for_type": {"services": ["/robot/get_parameters"]},
    }
    for frame in connection:
        text = json.loads(frame)
        if text["op"] == "call_service" and text["service"] in values:
            answer = {"op": "service_response", "id": text["id"], "result": True}
            connection.send(json.dumps({**answer, "values": values[text["service"]]}))
        elif text["op"] == "subscribe":
            topic = text["topic"]
            cdr = encode(types[topic], (messages or {}).get(topic))
            connection.send(message(topic, cdr))


def message(topic: str, cdr: Any, **more: Any) -> bytes:
    inner = {"secs": 5, "nsecs": 6, "bytes": cdr, **more}
    return cbor2.dumps({"op": "publish", "topic": topic, "msg": inner})


MALFORMED = {
    "no CBOR": b"\xff\xff\xff",
    "nothing": b"",
    "a number": b"\x05",
    "deep nesting": b"\x81" * 100_000,
    "an array of 2^62 elements": b"\x9b\x40" + b"\0" * 7,
    "a text of 2^62 bytes": b"\x7b\x40" + b"\0" * 7,
    "cut off": message("/words", b"x" * 100)[:-50],
    "no message": cbor2.dumps({"op": "publish", "topic": "/words"}),
    "a message that is a list": cbor2.dumps({"topic": "/words", "msg": [1]}),
    "bytes that are a text": message("/words", "text"),
    "a time that is a text": message("/words", b"", secs="now"),
    "a topic that is a number": message(5, b""),  # pyright: ignore[reportArgumentType]
    "no JSON": "{",
    "no op": "{}",
    "a response without id": '{"op": "service_response"}',
    "a fragment that is not the first": '{"op": "fragment", "id": "1", "data": "", "num": 3, '
    '"total": 5}',
}


def test_malformed_frames_are_counted_and_the_rest_is_read(liar: Liar) -> None:
    def script(connection: ServerConnection) -> None:
        for frame in MALFORMED.values():
            connection.send(frame)
        connection.send('{"op": "future op"}')
        connection.send('{"op": "service_response", "id": "of no call", "result": true}')
        connection.send('{"op": "status", "level": "error", "msg": "the motor is hot"}')
        connection.send(message("/not_subscribed", b"x"))
        _serve(connection, {"/words": STRING}, {"/words": {"data": "still here"}})

    reader = liar(script)
    reader.want(words=STRING)
    assert reader.decoded("/words", STRING).data == "still here"
    ignored = f"{len(MALFORMED)} frames of the bridge ignored."
    reader.until(lambda: any(remark.startswith(ignored) for remark in reader.bridge.remarks))
    assert "The bridge reports: the motor is hot" in reader.bridge.remarks
    reader.until(lambda: reader.source.graph.nodes() == ("/robot",))


def test_everything_but_hostile_definitions_is_subscribed_to(liar: Liar) -> None:
    evil = {f"ros_evil{number}": each for number, each in enumerate(REFUSED.values())}
    types = {f"/{name}": f"{name}_msgs/msg/Evil" for name in evil}
    texts = {f"/{name}": renamed(text, f"{name}_msgs") for name, (text, _) in evil.items()}
    reader = liar(
        lambda c: _serve(c, {**types, "/words": STRING}, {"/words": {"data": "still here"}}, texts)
    )
    topics: dict[str, Any] = {name: types[f"/{name}"] for name in evil}
    reader.want(**topics, words=STRING)
    assert reader.decoded("/words", STRING).data == "still here"
    for name, (_, problem) in evil.items():
        reader.until(
            lambda name=name, sentence=problem: (
                sentence in reader.source.offers()[f"/{name}"].problem
            )
        )


@pytest.mark.parametrize("values", [None, "text", {"topics": 5}, {"topics": [5], "types": [""]}])
def test_invalid_lists_are_malformed(values: Any) -> None:
    with pytest.raises(WireError):
        rosbridge_wire.converted(values, rosbridge_wire.Topics)


def test_topics_over_the_limit_are_dropped_and_reported(liar: Liar) -> None:
    types = {"/words": STRING, "no name": STRING} | {f"/t{i}": STRING for i in range(100_000)}
    reader = liar(lambda c: _serve(c, types, {"/words": {"data": "first"}}))
    reader.want(words=STRING)
    assert reader.decoded("/words", STRING).data == "first"
    reader.until(lambda: len(reader.source.offers()) == rosapi.MAX_TOPICS)
    reader.until(lambda: any("90001 topics more" in remark for remark in reader.bridge.remarks))
    assert any("no name" in remark for remark in reader.bridge.remarks)


def test_nodes_that_start_later_are_listed(liar: Liar, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rosapi, "POLL_S", 0.01)
    listed: list[str] = []

    def script(connection: ServerConnection) -> None:
        for frame in connection:
            text = json.loads(frame)
            if text.get("service") == "/rosapi/nodes":
                listed.append(f"/node_{len(listed)}")
            answer = {"op": "service_response", "id": text["id"], "result": True}
            values = {"topics": [], "types": [], "nodes": listed, "services": []}
            connection.send(json.dumps({**answer, "values": values}))

    reader = liar(script)
    reader.until(lambda: "/node_1" in reader.source.graph.nodes())


def test_a_server_without_rosapi_is_explained(liar: Liar) -> None:
    def script(connection: ServerConnection) -> None:
        for frame in connection:
            answer = {"op": "service_response", "id": json.loads(frame)["id"], "result": False}
            values = "Service /rosapi/topics does not exist"
            connection.send(json.dumps({**answer, "values": values}))

    reader = liar(script)
    reader.until(lambda: any("rosapi, too" in remark for remark in reader.bridge.remarks))
    assert not reader.source.offers()


def test_a_silent_rosapi_is_reported(liar: Liar, monkeypatch: pytest.MonkeyPatch) -> None:
    reader = liar(lambda connection: None)
    reader.until(lambda: reader.bridge.is_up)
    assert not reader.bridge.remarks
    monkeypatch.setattr(rosapi, "LATE_S", 0.0)
    text = r"rosapi has not answered for \d s, so topics may be missing"
    reader.until(lambda: any(re.match(text, r) for r in reader.bridge.remarks))


def test_a_flood_of_statuses_keeps_the_newest(liar: Liar) -> None:
    def script(connection: ServerConnection) -> None:
        for i in range(1000):
            status = {"op": "status", "level": "warning", "msg": f"{i} " + "x" * 999}
            connection.send(json.dumps(status))

    reader = liar(script)
    reader.until(lambda: any("999 x" in remark for remark in reader.bridge.remarks))
    assert len(reader.bridge.remarks) == rosbridge.MAX_STATUSES


def test_calls_that_are_never_answered_end_and_are_bounded(
    liar: Liar, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(rosbridge, "MAX_PENDING", 3)
    interfaces.service("std_srvs/srv/Empty")
    reader = liar(lambda connection: None)
    reader.until(lambda: reader.bridge.is_up)
    call = reader.source.graph.call
    empty = encode("std_srvs/srv/Empty_Request")
    answers = [call("/sleep", "std_srvs/srv/Empty", empty, 0.3) for _ in range(4)]
    assert "owes 3 answers" in str(answers[3].exception(20))
    assert "does not answer within 0.3 s" in str(answers[0].exception(20))
    assert "does not answer" in str(call("/sleep", "std_srvs/srv/Empty", empty, 0.1).exception(20))


def test_the_missing_package_cbor2_is_reported(liar: Liar, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rosbridge_wire, "is_readable", lambda: False)
    reader = liar(lambda c: _serve(c, {"/words": STRING}))
    reader.want(words=STRING)
    reader.until(lambda: "/words" in reader.source.offers())
    assert "needs the package cbor2" in reader.source.offers()["/words"].problem
    assert any("needs the package cbor2" in remark for remark in reader.bridge.remarks)


def test_fragments_are_put_together_and_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    fragments = Fragments()
    assert fragments.add(Fragment("a", "one ", 0, 2.3)) is None
    assert fragments.add(Fragment("b", "other", 0, 1.0)) == "other"
    assert fragments.add(Fragment("a", "two", 1, 2.3)) == "one two"
    with pytest.raises(WireError, match="does not follow"):
        fragments.add(Fragment("a", "again", 1, 2.3))
    monkeypatch.setattr(json_frames, "MAX_TEXT", 1000)
    fragments.add(Fragment("a", "x" * 600, 0, 9.0))
    with pytest.raises(WireError, match="above the limit"):
        fragments.add(Fragment("b", "x" * 600, 0, 9.0))
    for i in range(rosbridge_wire.MAX_FRAGMENTED):
        fragments.add(Fragment(i, "", 0, 9.0))
    with pytest.raises(WireError, match="above the limit"):
        fragments.add(Fragment("more", "", 0, 9.0))


def test_binary_messages_are_cdr() -> None:
    cdr = struct.pack("<4sI", b"\0\1\0\0", 7)
    assert rosbridge_wire.read_binary(message("/n", cdr)) == ("/n", 5_000_000_006, cdr)
