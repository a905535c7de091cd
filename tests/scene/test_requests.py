"""Answers to requests that are not a browser's."""

from __future__ import annotations

import logging
import socket
import threading
from collections.abc import Callable
from typing import Any

import playwright.sync_api as playwright
import pytest
import viser
import websockets.sync.server
from pages import COARSE
from serving import serving
from waiting import until

from webviz.scene import ViserScene
from webviz.server.http.middleware import rate_limited_log

Ask = Callable[[bytes], tuple[int, bytes, bytes]]
HOST = b"Host: localhost\r\n"


def test_head_is_answered_like_get_without_the_page(ask: Ask) -> None:
    status, head, body = ask(b"HEAD / HTTP/1.1\r\n" + HOST + b"\r\n")
    full_status, full_head, full_body = ask(b"GET / HTTP/1.1\r\n" + HOST + b"\r\n")
    assert (status, body) == (full_status, b"") == (200, b"")
    assert head == full_head
    assert f"Content-Length: {len(full_body)}".encode() in head


@pytest.mark.parametrize(
    ("request_", "expected"),
    [
        (b"POST / HTTP/1.1\r\n" + HOST + b"Content-Length: 5\r\n\r\nhello", 405),
        (b"OPTIONS * HTTP/1.1\r\n" + HOST + b"\r\n", 405),
        (b"GET /etc/passwd HTTP/1.1\r\n" + HOST + b"\r\n", 404),
        (b"GET /%00 HTTP/1.1\r\n" + HOST + b"\r\n", 404),
        (b"GET /" + 1000 * b"a" + b" HTTP/1.1\r\n" + HOST + b"\r\n", 404),
        (b"GET /" + 8000 * b"a" + b" HTTP/1.1\r\n" + HOST + b"\r\n", 414),
        (b"GET /" + 80_000 * b"a", 414),
        (b"GET / HTTP/1.1\r\n" + HOST + 50_000 * b"a", 431),
        (b"GET / HTTP/1.1\r\n" + HOST + 200 * b"A: b\r\n" + b"\r\n", 400),
        (b"GET / HTTP/1.1\r\n" + HOST + b"Transfer-Encoding: chunked\r\n\r\n", 400),
        (b"GET / HTTP/1.1\nHost: localhost\n\n", 400),
        (b"GET / HTTP/1.0\r\n\r\n", 505),
        (b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 400),
        (b"GET / HTTP/1.1\r\n\r\n", 403),
        (b"GET / HTTP/1.1\r\n" + HOST + b"Origin: http://[::1\r\n\r\n", 403),
        (b"GET / HTTP/1.1\r\n" + HOST + b"Upgrade: websocket\r\nConnection: Upgrade\r\n\r\n", 400),
    ],
    ids=lambda value: str(value)[:60],
)
def test_invalid_requests_are_refused_in_one_sentence(
    ask: Ask, request_: bytes, expected: int
) -> None:
    status, head, body = ask(request_)
    assert status == expected
    assert body.decode().strip().endswith(".")
    assert b"\r\nX-Content-Type-Options: nosniff" in head


def test_a_client_that_closes_its_sending_side_is_answered(
    server: viser.ViserServer, caplog: pytest.LogCaptureFixture
) -> None:
    for path, status in ((b"/", b"200"), (b"/nothing", b"404")):
        with socket.create_connection(("127.0.0.1", server.get_port()), timeout=60) as client:
            client.sendall(b"GET " + path + b" HTTP/1.1\r\n" + HOST + b"\r\n")
            client.shutdown(socket.SHUT_WR)
            answer = b"".join(iter(lambda: client.recv(1 << 16), b""))
        assert answer.startswith(b"HTTP/1.1 " + status)
    assert caplog.messages == []


def test_duplicate_headers_are_accepted(ask: Ask) -> None:
    twice = b"Accept-Encoding: br\r\nAccept-Encoding: gzip\r\n"
    status, head, _ = ask(b"GET / HTTP/1.1\r\n" + HOST + twice + b"\r\n")
    assert status == 200
    assert b"Content-Encoding: gzip" in head


def test_the_page_cannot_be_embedded_and_sends_no_referrer(ask: Ask) -> None:
    _, head, _ = ask(b"GET / HTTP/1.1\r\n" + HOST + b"\r\n")
    assert b"frame-ancestors 'none'" in head
    assert b"connect-src 'self' ws://localhost wss://localhost data: blob:" in head
    assert b"\r\nReferrer-Policy: no-referrer" in head
    assert b"\r\nCross-Origin-Opener-Policy: same-origin" in head
    assert b"\r\nCross-Origin-Resource-Policy: same-origin" in head
    assert b"camera=(), " in head
    assert b"gamepad" not in head
    assert b"Strict-Transport-Security" not in head


def test_another_site_cannot_show_the_page_in_a_frame_nor_hold_its_window(
    browser: playwright.Browser, server: viser.ViserServer, scene: ViserScene
) -> None:
    url = f"http://127.0.0.1:{server.get_port()}/?fixedDpr={COARSE}"
    tab = browser.new_page()
    tab.route(
        "http://trap.example/**",
        lambda route: route.fulfill(
            content_type="text/html",
            body=f"<iframe src={url}></iframe><script>opened = () => open('{url}')</script>",
        ),
    )
    tab.goto("http://trap.example/")
    (frame,) = tab.main_frame.child_frames
    assert frame.url == "chrome-error://chromewebdata/"
    with tab.expect_popup() as popup:
        tab.evaluate("() => { window.held = opened(); }")
    popup.value.wait_for_function("window.webviz")
    assert popup.value.evaluate("() => window.opener === null")
    assert tab.evaluate("() => held.closed")
    tab.context.close()


def test_a_link_cannot_make_the_page_obey_another_server(
    browser: playwright.Browser,
    server: viser.ViserServer,
    scene: ViserScene,
) -> None:
    called = threading.Event()
    with serving(websockets.sync.server.serve(lambda _: called.set(), "127.0.0.1", 0)) as other:
        port = other.socket.getsockname()[1]
        page = browser.new_page()
        link = f"?fixedDpr={COARSE}&websocket=ws://127.0.0.1:{port}"
        page.goto(f"http://127.0.0.1:{server.get_port()}/{link}")
        # It connects to one server only: to this one, although the link names another.
        until(lambda: len(server.get_clients()) == 1)
        page.close()
    assert not called.is_set()


def test_clients_that_only_connect_do_not_fill_the_log(
    server: viser.ViserServer,
    caplog: pytest.LogCaptureFixture,
    call: Callable[..., Any],
) -> None:
    for _ in range(20):
        socket.create_connection(("127.0.0.1", server.get_port())).close()
    peer = call()
    for _ in range(20):
        peer.send({"type": "ViewerCameraMessage", "wxyz": "a"})
    peer.look()
    until(lambda: len(server.get_clients()) == 1)
    assert len(caplog.records) <= 2
    assert all(len(record.getMessage()) < 200 for record in caplog.records)
    assert not any(record.exc_info for record in caplog.records)


def test_a_rate_limited_log_counts_omitted_lines(caplog: pytest.LogCaptureFixture) -> None:
    log = rate_limited_log("webviz.server")

    def at(seconds: float, message: str) -> None:
        record = log.makeRecord(log.name, logging.WARNING, "", 0, message, (), None)
        record.created = seconds
        log.handle(record)

    for second in (0.0, 1.0, 59.0, 60.5):
        at(second, "It rains")
    at(61.0, "It snows")
    assert caplog.messages == ["It rains", "It rains (2 similar lines omitted)", "It snows"]
