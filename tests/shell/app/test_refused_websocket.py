"""A proxy that lets the page through, but not its websocket."""

from __future__ import annotations

import contextlib
import socket
import socketserver
import threading
from collections.abc import Iterator

import playwright.sync_api as playwright
import pytest
from pages import COARSE
from playwright.sync_api import expect
from serving import serving

import webviz
from webviz.shell.testing.source import HandFedSource

REFUSED = "webviz serves this page, but its websocket does not open."


class Proxy(socketserver.ThreadingTCPServer):
    """Forwards connections to a port, and ends those that ask for a websocket while it refuses."""

    daemon_threads = True
    is_refusing = True

    def __init__(self, port: int) -> None:
        self.port = port
        super().__init__(("127.0.0.1", 0), Forward)


class Forward(socketserver.BaseRequestHandler):
    """Forwards one connection in both directions."""

    def handle(self) -> None:
        proxy = self.server
        assert isinstance(proxy, Proxy)
        head = self.request.recv(1 << 16)
        if proxy.is_refusing and b"upgrade: websocket" in head.lower():
            return
        with socket.create_connection(("127.0.0.1", proxy.port)) as viewer:
            viewer.sendall(head)
            back = threading.Thread(target=_copy, args=(viewer, self.request), daemon=True)
            back.start()
            _copy(self.request, viewer)
            back.join()


def _copy(source: socket.socket, target: socket.socket) -> None:
    with contextlib.suppress(OSError):
        while data := source.recv(1 << 16):
            target.sendall(data)
    with contextlib.suppress(OSError):
        target.shutdown(socket.SHUT_WR)


@pytest.fixture
def proxy() -> Iterator[Proxy]:
    with (
        webviz.Viewer(port=0, source=HandFedSource()) as viewer,
        serving(Proxy(viewer.port)) as proxy,
    ):
        yield proxy


def test_a_page_shows_why_its_websocket_is_refused_until_it_opens(
    proxy: Proxy, browser: playwright.Browser, said_on_consoles: list[str]
) -> None:
    context = browser.new_context(viewport={"width": 500, "height": 300})
    page = context.new_page()
    # Each websocket to the proxy has the origin of the page that the proxy forwards.
    page.goto(f"http://localhost:{proxy.server_address[1]}/?fixedDpr={COARSE}")
    bar = page.get_by_role("alert").filter(has_text=REFUSED)
    expect(bar).to_be_visible(timeout=60_000)
    proxy.is_refusing = False
    expect(bar).to_have_count(0, timeout=60_000)
    expect(page.get_by_role("alert")).to_have_count(0)
    context.close()
    said_on_consoles.clear()  # the browser reports each websocket that did not open
