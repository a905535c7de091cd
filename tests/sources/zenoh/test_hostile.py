"""Networks that lie: tokens, payloads, answers, routers and what stands in for them."""

from __future__ import annotations

import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator

import pytest
from waiting import until
from zenoh_robot import ZenohRobot, ZenohRouter, robot_attachment

from webviz.api.declared import Topic
from webviz.data.messages import decode, encode
from webviz.sources import Advertisement, NotConnected, Subscription
from webviz.sources.zenoh import address as zenoh_address_module
from webviz.sources.zenoh import calls, discovered, link
from webviz.sources.zenoh import source as zenoh_source
from webviz.sources.zenoh.address import zenoh_address
from webviz.sources.zenoh.discovered import MAX_ENTITIES, DiscoveredGraph
from webviz.sources.zenoh.source import ZenohSource

STRING = "std_msgs/msg/String"
SET_BOOL = "std_srvs/srv/SetBool"


def test_a_hundred_thousand_nodes_are_bounded() -> None:
    graph = DiscoveredGraph()
    began_s = time.process_time()
    for number in range(100_000):
        graph.add(f"@ros2_lv/0/zid/0/{number}/NN/%/%/node{number}")
    snapshot = graph.snapshot()
    assert snapshot is not None
    assert len(snapshot.nodes) == MAX_ENTITIES
    assert snapshot.remarks[0].startswith("The graph has more than 20000 nodes and endpoints")
    assert time.process_time() - began_s < 10
    graph.clear()
    cleared = graph.snapshot()
    assert cleared is not None
    assert cleared.remarks == ()


def test_malformed_tokens_are_counted_and_hidden(
    source: ZenohSource, robot: ZenohRobot, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(discovered, "MAX_ENTITIES", 100)
    lies = [
        "@ros2_lv/0/z/0/0/NN/%/%/<img onerror=alert(1)>",
        "@ros2_lv/0/z/0/0/NN/%/%/" + "a" * 60_000,
        "@ros2_lv/0/z/0/0/MP/%/%/node/%scan/<b>/x/::",
        f"@ros2_lv/0/z/0/0/MP/%/%/node/%scan/{'x' * 300}::msg::dds_::A_/h/::,:,:,:,,",
        "@/z/@ros2_lv/MP/<script>/a/b",
    ]
    for lie in lies:
        robot.declare(lie)
    for number in range(200):
        robot.declare(f"@ros2_lv/0/z/0/{number}/NN/%/%/node{number}")
    publish = robot.publisher("/words", STRING)
    until(lambda: len(source.bridges[0].remarks) == 2)
    ignored, left_out = source.bridges[0].remarks
    assert ignored.startswith(f"{len(lies)} liveliness tokens ignored: ")
    assert "<" not in ignored
    assert left_out.startswith("The graph has more than 100 nodes and endpoints")
    assert len(source.graph.nodes()) <= 100
    publish({"data": "still here"})


def test_payloads_above_the_bound_are_refused(
    source: ZenohSource, robot: ZenohRobot, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(zenoh_source, "MAX_TOTAL", 1 << 20)
    publish = robot.publisher("/words", STRING)
    until(lambda: "/words" in source.offers())
    source.want({"/words": Subscription(STRING, Topic("/words"))})
    until(lambda: source.offers()["/words"].subscribers)
    # The engine drops what it cannot send at once.
    large = {"data": "a" * (3 << 20)}
    until(lambda: source.offers()["/words"].problem, turn=lambda: publish(large), look_s=0.1)
    assert source.offers()["/words"].problem == (
        "a message of 3 MB is above the limit of 1 MB; publish smaller ones"
    )
    small = {"data": "small"}
    arrived = until(
        lambda: source.inbox.drain().get("/words"), turn=lambda: publish(small), look_s=0.1
    )
    assert decode(STRING, arrived[-1].cdr).data == "small"


def test_the_engine_drops_messages_over_the_limit_before_they_are_complete(
    router: ZenohRouter, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A gigabyte would take that much memory before anybody could look at its size."""
    monkeypatch.setattr(zenoh_address_module, "MAX_TOTAL", 1 << 20)
    robot = ZenohRobot(router.endpoint, transport__shared_memory__enabled=False)
    publish = robot.publisher("/words", STRING)
    source = ZenohSource(zenoh_address(router.endpoint, {}))
    try:
        source.want({"/words": Subscription(STRING, Topic("/words"))})
        until(lambda: source.offers().get("/words") and source.offers()["/words"].subscribers)
        time.sleep(0.2)
        publish({"data": "a" * (8 << 20)})
        time.sleep(0.5)
        publish({"data": "small"})
        (raw,) = until(lambda: source.inbox.drain().get("/words"))
        assert decode(STRING, raw.cdr).data == "small"
        assert source.bridges[0].is_up
    finally:
        source.close()
        robot.close()


def test_undecodable_bytes_are_dropped(source: ZenohSource, robot: ZenohRobot) -> None:
    words, clock = robot.publisher("/words", STRING), robot.publisher("/clock", STRING)
    until(lambda: {"/words", "/clock"} <= set(source.offers()))
    source.want({"/words": Subscription(STRING, Topic("/words"))})
    until(lambda: source.offers()["/words"].subscribers)
    time.sleep(0.1)
    for data in (b"", b"\0", b"\xff" * 1000):
        words(data)
        clock(data)
    until(lambda: source.inbox.received().get("/words", (0, 0))[0] == 3)
    assert source.clock_messages() is None


def test_invalid_answers_are_refused(
    source: ZenohSource, robot: ZenohRobot, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(calls, "MAX_TOTAL", 1 << 20)
    answers = {"/error": b"<b>" + b"x" * 10_000, "/huge": b"\0" * (2 << 20)}

    def answer(query: object) -> None:
        key = str(query.key_expr)  # type: ignore[attr-defined]
        name = "/" + key.split("/")[1]
        if name == "/error":
            query.reply_err(answers[name])  # type: ignore[attr-defined]
        elif name == "/huge":
            query.reply(key, answers[name])  # type: ignore[attr-defined]
        else:
            query.drop()  # type: ignore[attr-defined]

    for name in ("/error", "/huge", "/silent"):
        token = robot.token("SS", name, SET_BOOL, hash=f"RIHS01_{'1' * 64}")
        key = f"0{name}/std_srvs::srv::dds_::SetBool_/RIHS01_{'1' * 64}"
        robot.session.declare_queryable(key, answer, complete=True)
        assert token
    until(lambda: set(answers) <= set(source.graph.services()))

    def failure(name: str) -> str:
        with pytest.raises(NotConnected) as raised:
            source.graph.call(name, SET_BOOL, b"\0\1\0\0\1", 5).result(10)
        return str(raised.value)

    text = failure("/error")
    assert text.startswith("/error failed: ")
    assert len(text) < 300
    assert failure("/huge") == "The answer of /huge is above the limit of 1 MB."
    assert failure("/silent").startswith("The node that offered /silent has ended.")


def test_a_flood_of_calls_is_refused(source: ZenohSource, robot: ZenohRobot) -> None:
    robot.service("/slow", SET_BOOL, lambda request: time.sleep(0.2) or {})
    until(lambda: "/slow" in source.graph.services())
    request = encode(f"{SET_BOOL}_Request", {})
    answers = [source.graph.call("/slow", SET_BOOL, request, 0.5) for _ in range(300)]
    errors = [str(answer.exception(20) or "") for answer in answers]
    assert any("service calls are pending. Try again later." in error for error in errors)


def test_stamps_of_a_clock_that_disagrees(source: ZenohSource, robot: ZenohRobot) -> None:
    robot.publisher("/words", STRING)
    until(lambda: "/words" in source.offers())
    source.want({"/words": Subscription(STRING, Topic("/words"))})
    until(lambda: source.offers()["/words"].subscribers)
    key = str(source.snapshot.publishers["/words"][0].key)
    for stamp_ns in (0, -1, 2**62, time.time_ns() + 3_600 * 10**9):
        attachment = robot_attachment(1, stamp_ns, bytes(16))
        robot.session.put(key, encode(STRING, {"data": "x"}), attachment=attachment)
    robot.session.put(key, encode(STRING, {"data": "x"}), attachment=b"\xff" * 40)
    until(lambda: source.inbox.received().get("/words", (0, 0))[0] == 5)
    assert source.bridges[0].is_up


class Impostor:
    """A server that is no router: it answers everything with the same bytes."""

    def __init__(self, answer: bytes) -> None:
        self._server = socket.create_server(("127.0.0.1", 0))
        self.endpoint = f"tcp/127.0.0.1:{self._server.getsockname()[1]}"
        self._answer = answer
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self) -> None:
        while True:
            try:
                connection, _ = self._server.accept()
            except OSError:
                return
            with connection:
                connection.settimeout(1)
                try:
                    connection.recv(1000)
                    connection.sendall(self._answer)
                except OSError:
                    continue

    def close(self) -> None:
        self._server.shutdown(socket.SHUT_RDWR)
        self._server.close()
        self._thread.join()


@pytest.mark.parametrize(
    "answer", [b"HTTP/1.1 400 Bad Request\r\n\r\n", b"\xff" * 100_000, bytes(70_000), b""]
)
def test_something_else_on_the_port(answer: bytes) -> None:
    impostor = Impostor(answer)
    source = ZenohSource(zenoh_address(impostor.endpoint, {}))
    try:
        until(lambda: "is not a Zenoh router" in source.bridges[0].problem)
        assert "7447 by default" in source.bridges[0].remedy
        with pytest.raises(NotConnected, match="is not a Zenoh router"):
            source.graph.publish(Advertisement("/x", STRING), b"").result(10)
    finally:
        source.close()
        impostor.close()


@pytest.fixture
def apart() -> Iterator[tuple[subprocess.Popen[str], str]]:
    """A router in a process of its own, and its endpoint."""
    command = [sys.executable, "-m", "webviz_sim.zenoh_router"]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, text=True, stdin=pipe, stdout=pipe) as process:
        assert process.stdout is not None
        yield process, process.stdout.readline().strip()
        process.send_signal(signal.SIGCONT)
        process.kill()


def test_a_router_that_hangs(
    apart: tuple[subprocess.Popen[str], str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(link, "BROKEN_S", 4.0)
    process, endpoint = apart
    robot = ZenohRobot(endpoint)
    publish = robot.publisher("/words", STRING)
    source = ZenohSource(zenoh_address(endpoint, {}))
    try:
        source.want({"/words": Subscription(STRING, Topic("/words"))})
        until(lambda: source.offers().get("/words") and source.offers()["/words"].subscribers)
        process.send_signal(signal.SIGSTOP)
        until(lambda: "has not answered" in "".join(source.bridges[0].remarks))
        with pytest.raises(NotConnected, match=r"has not answered for .* would arrive late"):
            source.graph.publish(Advertisement("/x", STRING), b"").result(10)
        until(lambda: not source.bridges[0].is_up)
        assert "has not answered" in source.bridges[0].problem
        process.send_signal(signal.SIGCONT)
        until(lambda: source.bridges[0].is_up)

        def again() -> bool:
            publish({"data": "again"})
            return bool(source.inbox.drain().get("/words"))

        until(again, look_s=0.1)
    finally:
        began_s = time.monotonic()
        source.close()
        assert time.monotonic() - began_s < 5
        robot.close()


def test_closes_while_messages_flood(router: ZenohRouter, robot: ZenohRobot) -> None:
    publish = robot.publisher("/words", STRING)
    source = ZenohSource(zenoh_address(router.endpoint, {}))
    source.want({"/words": Subscription(STRING, Topic("/words"))})
    until(lambda: source.offers().get("/words") and source.offers()["/words"].subscribers)
    is_over = threading.Event()

    def flood() -> None:
        while not is_over.is_set():
            publish({"data": "x" * 10_000})

    flooding = threading.Thread(target=flood)
    flooding.start()
    until(lambda: source.inbox.received().get("/words", (0, 0))[0] > 100)
    began_s = time.monotonic()
    source.close()
    assert time.monotonic() - began_s < 5
    is_over.set()
    flooding.join()
