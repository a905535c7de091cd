"""The channel between pages and server, next to viser's connection."""

from __future__ import annotations

import asyncio
import contextlib
import http.client
import re
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, cast

import msgspec
import playwright.sync_api as playwright
import pytest
import websockets.exceptions
import websockets.sync.client
from several import Make
from viser_internals import live_connections
from waiting import until
from websockets.sync.connection import Connection

from webviz.api.roles import Role
from webviz.scene import ViserScene, open_server
from webviz.scene.adapter.greeting import greet
from webviz.server.access import rules
from webviz.server.access.roles import LIMITS
from webviz.server.channel.messages import FromPage, SyncReply, SyncRequest, ToPage
from webviz.server.channel.outgoing import MAX_WAITING
from webviz.server.http.viser_server import Server
from webviz.shell.pictures.browser import Page


class Wish(FromPage, frozen=True):
    text: str


class News(ToPage, frozen=True):
    text: str


class Weather(ToPage, frozen=True):
    is_latched = True
    text: str


@pytest.fixture
def server(monkeypatch: pytest.MonkeyPatch) -> Iterator[Server]:
    monkeypatch.setitem(cast(dict[str, Role], rules.MESSAGES), "Wish", Role.WATCHER)
    server = open_server(port=0)
    yield server
    server.stop()


@contextmanager
def channel(server: Server, **options: Any) -> Iterator[Connection]:
    url = f"ws://127.0.0.1:{server.get_port()}/webviz/channel"
    with websockets.sync.client.connect(url, compression=None, close_timeout=0.1, **options) as it:
        yield it


def key_of(peer: Any) -> tuple[int, str]:
    """The browser id and channel key that viser's connection receives."""
    for message in peer.replay():
        if message["type"] == "RunJavascriptMessage":
            received = msgspec.json.decode(message["source"].partition("(")[2].removesuffix(");"))
            return received["browser"], received["key"]
    raise AssertionError("no bootstrap")


def receive(page: Connection) -> dict[str, Any]:
    """The next message that is not only a sign of life."""
    while (message := msgspec.json.decode(page.recv(60)))["type"] == "Heartbeat":
        pass
    return message


def hello(key: str) -> str:
    return msgspec.json.encode({"type": "Hello", "key": key}).decode()


def test_a_message_reaches_the_listener_with_the_browser_that_sent_it(
    server: Server,
    call: Make,
) -> None:
    acknowledged: list[tuple[int, Wish]] = []
    server.channel.on(Wish, lambda browser, wish: acknowledged.append((browser, wish)))
    call().replay()
    browser, key = key_of(call())
    with channel(server) as page:
        page.send(hello(key))
        page.send('{"type":"Wish","text":"rain"}')
        until(lambda: bool(acknowledged))
    assert acknowledged == [(browser, Wish("rain"))]


def test_a_page_receives_its_queue_and_the_newest_of_each_store(server: Server, call: Make) -> None:
    server.channel.send(Weather("rain"))
    server.channel.send(News("no browser is here"))
    server.channel.send(Weather("sun"))
    browser, key = key_of(call())
    other, _ = key_of(call())
    server.channel.send(News("for another"), other)
    server.channel.send(News("for you"), browser)
    server.channel.send(Weather("wind"))
    with channel(server) as page:
        page.send(hello(key))
        you, *got = (receive(page) for _ in range(3))
    assert you == {"type": "Identity", "role": "owner", "name": ""}
    assert got == [{"type": "News", "text": "for you"}, {"type": "Weather", "text": "wind"}]


def test_a_page_measures_its_way_before_the_viewer_is_ready(
    server: Server, call: Make, caplog: pytest.LogCaptureFixture
) -> None:
    _, key = key_of(call())
    with channel(server) as page:
        page.send(hello(key))
        assert receive(page)["type"] == "Identity"
        page.send('{"type":"Ping"}')
        assert receive(page) == {"type": "Pong"}
    assert "ignored" not in caplog.text


@pytest.mark.parametrize(
    "first", [hello("x"), hello(""), "", "[", '{"type":"Hello"}', b"\x00", '{"type":"Wish"}']
)
def test_a_client_without_a_key_is_sent_away(
    server: Server, call: Make, first: str | bytes
) -> None:
    key_of(call())
    with channel(server) as page:
        page.send(first)
        if isinstance(first, bytes):  # not even read
            page.send("{}")
        with pytest.raises(websockets.exceptions.ConnectionClosed):
            page.recv(60)


def test_a_key_opens_one_channel_only(server: Server, call: Make) -> None:
    _, key = key_of(call())
    with channel(server) as page, channel(server) as thief:
        server.channel.send(News("hello"))
        page.send(hello(key))
        receive(page)
        thief.send(hello(key))
        with pytest.raises(websockets.exceptions.ConnectionClosed):
            thief.recv(60)


def test_a_channel_from_another_site_is_refused(server: Server) -> None:
    with (
        pytest.raises(websockets.exceptions.InvalidStatus, match="403"),
        channel(server, additional_headers={"Origin": "http://evil.example"}),
    ):
        pass


@pytest.mark.parametrize(
    "nonsense",
    [
        "",
        "null",
        "[" * 60_000,
        '{"type":"Wish"}',
        '{"type":"Wish","text":1e999}',
        '{"type":"Wish","text":"a","more":1}',
        '{"type":"None"}',
        '{"type":"News","text":"a"}',
        f'{{"type":"Wish","text":"{"a" * LIMITS[Role.OWNER].max_characters}"}}',
        b'{"type":"Wish","text":"a"}',
    ],
)
def test_nonsense_is_ignored(server: Server, call: Make, nonsense: str | bytes) -> None:
    acknowledged: list[Wish] = []
    server.channel.on(Wish, lambda _, wish: acknowledged.append(wish))
    _, key = key_of(call())
    with channel(server) as page:
        page.send(hello(key))
        page.send(nonsense)
        page.send('{"type":"Wish","text":"sense"}')
        until(lambda: bool(acknowledged))
    assert acknowledged == [Wish("sense")]


@pytest.mark.parametrize(("count", "size"), [(40 * MAX_WAITING, 10_000), (60, 1 << 20)])
def test_a_page_that_reads_nothing_is_disconnected(
    server: Server,
    call: Make,
    count: int,
    size: int,
) -> None:
    peer = call()
    browser, key = key_of(peer)
    live = live_connections(server)
    with channel(server, max_queue=1) as page:
        page.send(hello(key))
        for _ in range(MAX_WAITING):
            server.channel.send(Weather("x" * 10_000))  # of these the newest only
        assert browser in live
        for _ in range(count):
            server.channel.send(News("x" * size), browser)
        until(lambda: browser not in live)


def test_when_the_channel_ends_viser_notifies_the_page(server: Server, call: Make) -> None:
    browser, key = key_of(call())
    with channel(server) as page:
        page.send(hello(key))
        server.channel.send(News("hello"))
        receive(page)
    until(lambda: browser not in live_connections(server))


def test_when_viser_s_connection_ends_so_does_the_channel(server: Server, call: Make) -> None:
    """A page that keeps only its channel would keep a file descriptor as well."""
    peer = call()
    _, key = key_of(peer)
    with channel(server) as connection:
        connection.send(hello(key))
        connection.recv(60)
        peer.close()
        with contextlib.suppress(websockets.exceptions.ConnectionClosed):
            while connection.recv(60):
                pass
        assert connection.close_code is not None


def test_the_page_is_one_file_that_may_load_nothing_from_elsewhere(server: Server) -> None:
    with urllib.request.urlopen(f"http://127.0.0.1:{server.get_port()}/?x", timeout=60) as answer:
        headers, page = answer.headers, answer.read()
    assert headers["Content-Type"] == "text/html; charset=utf-8"
    assert headers["X-Content-Type-Options"] == "nosniff"
    policy = headers["Content-Security-Policy"]
    assert "default-src 'none'" in policy
    assert "script-src 'self' 'unsafe-inline' 'unsafe-eval' blob: data:;" in policy
    assert int(headers["Content-Length"]) == len(page)
    assert b"$MODULES" not in page
    assert not re.search(rb"<(script|link)[^>]* (src|href)=.webviz/", page)


@pytest.mark.parametrize("path", ["", "main.js", "messages.py", "../webviz/main.js", "."])
def test_nothing_is_below_the_folder_of_the_modules(server: Server, path: str) -> None:
    connection = http.client.HTTPConnection("127.0.0.1", server.get_port(), timeout=60)
    connection.request("GET", f"/webviz/{path}")
    assert connection.getresponse().status == 404


def test_a_real_page_answers_and_is_back_when_the_server_is_another(
    browser: playwright.Browser,
    server: Server,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    answers: list[tuple[int, SyncReply]] = []

    def listen(server: Server) -> None:
        ViserScene(server)
        server.channel.on(SyncReply, lambda *answer: answers.append(answer))

    listen(server)
    page = Page(browser, f"http://127.0.0.1:{server.get_port()}", 320, 240)
    server.channel.send(SyncRequest("first"))
    page.wait_for(lambda: answers, "the page answers")
    assert answers == [(page.evaluate("() => window.webviz.browser"), SyncReply("first"))]
    port = server.get_port()
    server.stop()

    def greet_late(server: Server, *rest: Any) -> None:
        until(lambda: bool(live_connections(server)))
        greet(server, *rest)

    # The worst case: the page is there before anybody has told the server how to greet it.
    monkeypatch.setattr("webviz.scene.server.greet", greet_late)
    again = open_server(port=port)
    try:
        listen(again)
        page.wait_for(again.get_clients, "the page is back")

        def answers_again() -> bool:
            again.channel.send(
                SyncRequest("second")
            )  # again, as a slow page may have to connect twice
            return answers[-1][1] == SyncReply("second")

        page.wait_for(answers_again, "the page answers again")
    finally:
        page.close()
        again.stop()


def test_a_page_below_a_folder_of_a_proxy_loads_its_modules_and_opens_the_channel(
    browser: playwright.Browser,
    server: Server,
) -> None:
    ViserScene(server)
    answers: list[int] = []
    server.channel.on(SyncReply, lambda browser, _: answers.append(browser))

    async def forward(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        head = await reader.readuntil(b"\r\n\r\n")
        to, out = await asyncio.open_connection("127.0.0.1", server.get_port())
        out.write(head.replace(b"GET /robot", b"GET ", 1).replace(b"GET  ", b"GET / ", 1))

        async def pump(source: asyncio.StreamReader, sink: asyncio.StreamWriter) -> None:
            with contextlib.suppress(ConnectionError):
                while data := await source.read(1 << 16):
                    sink.write(data)
                    await sink.drain()
            sink.close()

        await asyncio.gather(pump(reader, out), pump(to, writer))

    loop = server.get_event_loop()
    proxy = asyncio.run_coroutine_threadsafe(
        asyncio.start_server(forward, "127.0.0.1", 0), loop
    ).result(60)
    port = proxy.sockets[0].getsockname()[1]
    page = Page(browser, f"http://127.0.0.1:{port}/robot", 320, 240)
    server.channel.send(SyncRequest("below"))
    page.wait_for(lambda: answers, "the page answers")
    page.close()
    loop.call_soon_threadsafe(proxy.close)
