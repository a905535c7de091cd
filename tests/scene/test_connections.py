"""Limits on connections and on what each may send."""

from __future__ import annotations

import contextlib
import socket
import subprocess
import sys

import pytest
import viser
import websockets.exceptions
from several import Make
from viser_internals import server_thread
from waiting import until
from websockets.frames import Frame, Opcode

from webviz.server.http import connections, rate_limits
from webviz.server.http.connections import MAX_BROWSERS, READ_BYTES, Connection
from webviz.server.http.eviction import network_of
from webviz.server.http.rate_limits import (
    FIRST_S,
    FORGIVEN_S,
    MAX_REMEMBERED,
    MAX_S,
    BackOff,
    RateLimit,
    SpentRates,
)

PAGE = b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n"


def test_one_browser_too_many_is_refused_with_the_reason(ask: Make, call: Make) -> None:
    peers = [call() for _ in range(MAX_BROWSERS)]
    with pytest.raises(websockets.exceptions.InvalidStatus, match="503"):
        call()
    status, _, body = ask(PAGE)
    assert (status, body.split(b",")[0]) == (503, b"128 browsers are connected")
    peers[0].close()
    until(lambda: ask(PAGE)[0] == 200)


def test_connections_that_never_ask_keep_no_browser_out(
    server: viser.ViserServer, ask: Make
) -> None:
    address = ("127.0.0.1", server.get_port())
    clients = [socket.create_connection(address, timeout=60) for _ in range(3 * MAX_BROWSERS)]
    for client in clients:
        client.sendall(b"GET / HT")
    assert ask(PAGE)[0] == 200
    with contextlib.suppress(ConnectionResetError):  # as good an end
        assert clients[0].recv(1) == b""
    for client in clients:
        client.close()


@pytest.mark.parametrize("partial_request", [b"", PAGE[:10]])
def test_requests_that_are_not_complete_end_none_of_another_address(
    server: viser.ViserServer, partial_request: bytes
) -> None:
    address = ("127.0.0.1", server.get_port())
    with socket.create_connection(address, timeout=60) as asking, contextlib.ExitStack() as stack:
        asking.sendall(PAGE[:10])
        for _ in range(2 * MAX_BROWSERS):
            other = socket.create_connection(address, timeout=60, source_address=("127.0.0.2", 0))
            stack.enter_context(other).sendall(partial_request)
        asking.sendall(PAGE[10:])
        assert asking.recv(12) == b"HTTP/1.1 200"


@pytest.mark.parametrize(
    ("address", "network"),
    [
        ("192.0.2.1", "192.0.2.1"),
        ("::ffff:192.0.2.1", "192.0.2.1"),
        ("2001:db8::1", "2001:db8::/64"),
        ("2001:db8::ffff:0:0:1", "2001:db8::/64"),
        ("2001:db8:0:1::1", "2001:db8:0:1::/64"),
        ("fe80::1%eth0", "fe80::/64"),
        ("", ""),
        ("unknown", "unknown"),
    ],
)
def test_addresses_that_one_subscriber_has_are_one_network(address: str, network: str) -> None:
    assert network_of(address) == network


FEW_FILES = """
import os, resource, socket
from webviz.scene import open_server
server = open_server(port=0)
address = ("127.0.0.1", server.get_port())
request = b"GET / HTTP/1.1\\r\\nHost: localhost\\r\\n\\r\\n"
resource.setrlimit(resource.RLIMIT_NOFILE, (64, 64))
asking, again = socket.socket(), socket.socket()
asking.settimeout(60), again.settimeout(60)
taken = []
try:
    while True:
        taken.append(os.open(os.devnull, os.O_RDONLY))
except OSError:
    pass
asking.connect(address)
asking.sendall(request)
print(asking.recv(12).decode(), flush=True)
for number in taken:
    os.close(number)
again.connect(address)
again.sendall(request)
print(again.recv(12).decode(), flush=True)
server.stop()
"""


def test_without_file_descriptors_browsers_are_refused_and_served_again_later() -> None:
    run = subprocess.run(
        [sys.executable, "-c", FEW_FILES], capture_output=True, text=True, timeout=120, check=True
    )
    assert run.stdout.split() == ["HTTP/1.1", "503", "HTTP/1.1", "200"]
    assert run.stderr == "Refused a connection: Too many open files.\n"


def test_a_browser_may_send_a_burst_and_then_a_steady_rate() -> None:
    rate_limit = RateLimit(rate=10.0, burst=5.0)
    waits = [rate_limit.spend(1.0, now=100.0) for _ in range(7)]
    assert waits == pytest.approx([0, 0, 0, 0, 0, 0.1, 0.2])
    assert rate_limit.spend(1.0, now=101.0) == 0.0
    assert rate_limit.spend(10.0, now=200.0) == pytest.approx(0.5)


def test_a_browser_that_connects_again_has_no_new_burst() -> None:
    spent, before = SpentRates(), RateLimit(rate=10.0, burst=5.0)
    before.spend(8.0, now=100.0)
    spent.note("a", before)
    spent.note("a", RateLimit(rate=10.0, burst=5.0))
    again, other, later = (RateLimit(rate=10.0, burst=5.0) for _ in range(3))
    spent.resume("a", again, now=100.1)
    assert again.spend(1.0, now=100.1) == pytest.approx(0.3)
    assert again.exhausted_s(now=100.4) == pytest.approx(0.3)
    spent.resume("b", other, now=100.1)
    assert other.spend(5.0, now=100.1) == 0.0
    spent.resume("a", later, now=200.0)
    assert later.spend(5.0, now=200.0) == 0.0


def test_over_the_limit_the_browsers_that_spent_least_are_forgotten() -> None:
    spent = SpentRates()
    for number in range(MAX_REMEMBERED + 1):
        before = RateLimit(rate=10.0, burst=5.0)
        before.spend(5.0 if number == 1 else 6.0, now=100.0)
        spent.note(number, before)

    def wait_s(sender: int) -> float:
        again = RateLimit(rate=10.0, burst=5.0)
        spent.resume(sender, again, now=100.0)
        return again.spend(1.0, now=100.0)

    waits = [wait_s(number) for number in range(MAX_REMEMBERED + 1)]
    assert [number for number, wait in enumerate(waits) if wait == 0.0] == [1]


def test_the_back_off_doubles_with_each_flood_and_is_forgiven_later() -> None:
    back_off, now, waits = BackOff(), 100.0, []
    for _ in range(7):
        back_off.send_away("a", now)
        back_off.send_away("a", now + 1.0)  # its other connection
        waits.append(back_off.wait_s("a", now))
        now += waits[-1]
    assert waits == [10.0, 20.0, 40.0, 80.0, 160.0, MAX_S, MAX_S]
    assert (back_off.wait_s("a", now), back_off.wait_s("b", now)) == (0.0, 0.0)
    back_off.send_away("a", now + FORGIVEN_S + 1.0)
    assert back_off.wait_s("a", now + FORGIVEN_S + 1.0) == FIRST_S


def test_over_the_limit_the_first_browser_in_back_off_is_forgotten() -> None:
    back_off = BackOff()
    back_off.send_away(0, 0.0)
    back_off.send_away(0, FIRST_S)  # for 20 s
    for number in range(1, rate_limits.MAX_REMEMBERED + 1):
        back_off.send_away(number, 15.0)
    waits = [back_off.wait_s(number, 15.0) for number in range(rate_limits.MAX_REMEMBERED + 1)]
    assert waits == [0.0, *rate_limits.MAX_REMEMBERED * [FIRST_S]]


def test_a_browser_that_sends_too_much_waits_and_others_do_not(
    server: viser.ViserServer,
    call: Make,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(connections, "RateLimit", lambda *_: RateLimit(rate=1e-9, burst=3.5))
    eager, other = call(), call()
    for number in range(1, 6):
        eager.look(float(number))
    until(lambda: cameras_x(server) == [3.0])
    other.look(9.0)
    until(lambda: len(server.get_clients()) == 2)
    assert cameras_x(server) == [3.0, 9.0]


def cameras_x(server: viser.ViserServer) -> list[float]:
    """The x of every camera that the server has heard of."""
    cameras = [client.camera for client in server.get_clients().values()]
    return sorted(float(camera.position[0]) for camera in cameras)


@pytest.mark.parametrize(
    "frame", [Frame(Opcode.PING, 125 * b"x"), Frame(Opcode.CONT, b"x", fin=False)], ids=str
)
def test_a_flood_of_pings_or_fragments_ends_the_connection(
    server: viser.ViserServer, call: Make, frame: Frame
) -> None:
    peer = call()
    raw = peer.websocket.socket
    if frame.opcode is Opcode.CONT:
        raw.sendall(Frame(Opcode.BINARY, b"x", fin=False).serialize(mask=True))
    flood = 1000 * frame.serialize(mask=True)
    with contextlib.suppress(OSError):
        for _ in range(1000):
            raw.sendall(flood)
        pytest.fail("the server took a million frames")
    call().replay()  # an owner need not stay away


def test_a_turn_of_the_event_loop_reads_little_from_each_browser(
    call: Make,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    sizes: list[int] = []
    receive = Connection.data_received

    def count(self: Connection, data: bytes) -> None:
        sizes.append(len(data))
        receive(self, data)

    monkeypatch.setattr(Connection, "data_received", count)
    peer = call()
    peer.send({"type": "Nothing", "filling": 100_000 * "x"})
    until(lambda: sum(sizes) > 100_000)
    assert max(sizes) == READ_BYTES


def test_a_message_that_is_too_large_is_dropped_and_one_without_bounds_ends_the_connection(
    server: viser.ViserServer,
    call: Make,
) -> None:
    clicked: list[str] = []
    names = "/" + 10_000 * "x", "/short"
    for name in names:
        node = server.scene.add_icosphere(name)
        node.on_click(lambda event: clicked.append(event.target.name))
    peer = call()
    peer.look()
    until(lambda: len(server.get_clients()) == 1)
    rest = {
        "instance_index": None,
        "ray_origin": [0.0, 0.0, 1.0],
        "ray_direction": [0.0, 0.0, -1.0],
        "screen_pos": [0.5, 0.5],
        "modifier": None,
    }
    for name in names:
        peer.send({"type": "SceneNodeClickMessage", "name": name} | rest)
    until(lambda: "/short" in clicked)
    assert clicked == ["/short"]
    peer.send({"type": "SceneNodeClickMessage", "name": 5_000_000 * "x"})

    def acknowledge() -> None:
        while True:
            peer.receive()

    with pytest.raises(websockets.exceptions.ConnectionClosed, match="message too big"):
        acknowledge()


def test_a_server_that_stops_waits_for_no_browser(
    call: Make,
    server: viser.ViserServer,
    ask: Make,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(connections, "RateLimit", lambda *_: RateLimit(rate=1e-9, burst=1.5))
    eager = call()  # must wait for ages, and does not read, so that it never answers a farewell
    eager.look(1.0)
    eager.look(2.0)
    until(lambda: cameras_x(server) == [1.0])
    with socket.create_connection(("127.0.0.1", server.get_port())) as client:
        client.sendall(b"GET / HT")
        assert ask(PAGE)[0] == 200
        thread = server_thread(server)
        server.stop()
        assert thread is not None
        assert not thread.is_alive()
