"""The server with TLS."""

from __future__ import annotations

import contextlib
import socket
import ssl
from collections.abc import Iterator
from pathlib import Path

import playwright.sync_api as playwright
import pytest
import viser
from certificates import authority, certificate

import webviz
from webviz.scene import open_server
from webviz.server.access.tls import server_context
from webviz.server.http.listener import MAX_HANDSHAKES
from webviz.shell.pictures.browser import Page
from webviz.shell.testing.source import HandFedSource


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A certificate beside its key."""
    return certificate(tmp_path_factory.mktemp("tls"))


@pytest.fixture
def server(files: Path) -> Iterator[viser.ViserServer]:
    context = server_context(files, files.with_suffix(".key"))
    server = open_server(port=0, allowed_hosts=["robot.example"], tls=context)
    yield server
    server.stop()


def ask(server: viser.ViserServer, request: bytes) -> bytes:
    """The answer to a request."""
    context = ssl.create_default_context()
    authority().configure_trust(context)
    with (
        socket.create_connection(("127.0.0.1", server.get_port()), timeout=60) as plain,
        context.wrap_socket(plain, server_hostname="robot.example") as caller,
    ):
        caller.sendall(request)
        return b"".join(iter(lambda: caller.recv(1 << 16), b""))


def test_requests_are_answered_as_without_tls(server: viser.ViserServer) -> None:
    answer = ask(server, b"GET / HTTP/1.1\r\nHost: robot.example\r\n\r\n")
    assert answer.startswith(b"HTTP/1.1 200 ")
    assert b"\r\nStrict-Transport-Security: max-age=" in answer
    answer = ask(server, b"POST / HTTP/1.1\r\nHost: robot.example\r\nContent-Length: 1\r\n\r\n1")
    assert answer.startswith(b"HTTP/1.1 405 ")
    assert answer.endswith(b"Only GET and HEAD are supported.\n")


def test_https_for_all_ports_of_loopback_is_not_demanded(server: viser.ViserServer) -> None:
    answer = ask(server, b"HEAD / HTTP/1.1\r\nHost: localhost:8080\r\n\r\n")
    assert answer.startswith(b"HTTP/1.1 200 ")
    assert b"Strict-Transport-Security" not in answer


def test_clients_that_only_connect_keep_no_browser_out(
    server: viser.ViserServer, caplog: pytest.LogCaptureFixture
) -> None:
    address = ("127.0.0.1", server.get_port())
    clients = [socket.create_connection(address, 60) for _ in range(MAX_HANDSHAKES + 2)]
    assert clients[0].recv(1) == clients[1].recv(1) == b""
    clients[2].sendall(b"GET / HTTP/1.1\r\n\r\n")
    clients[3].sendall(b"\x16\x03\x01" + 500 * b"\xff")
    assert ask(server, b"HEAD / HTTP/1.1\r\nHost: localhost\r\n\r\n").startswith(b"HTTP/1.1 200 ")
    for client in clients:
        client.close()
    assert caplog.messages == []


def test_clients_that_only_connect_end_no_handshake_of_another_address(
    server: viser.ViserServer,
) -> None:
    address = ("127.0.0.1", server.get_port())
    context = ssl.create_default_context()
    authority().configure_trust(context)
    with (
        socket.create_connection(address, timeout=60) as plain,
        contextlib.ExitStack() as clients,
    ):
        for _ in range(2 * MAX_HANDSHAKES):
            client = socket.create_connection(address, 60, source_address=("127.0.0.2", 0))
            clients.enter_context(client)
        with context.wrap_socket(plain, server_hostname="robot.example") as caller:
            caller.sendall(b"HEAD / HTTP/1.1\r\nHost: localhost\r\n\r\n")
            assert caller.recv(12) == b"HTTP/1.1 200"


def test_a_viewer_is_shown_by_https(browser: playwright.Browser, files: Path) -> None:
    with webviz.Viewer(
        port=0, source=HandFedSource(), certfile=files, keyfile=files.with_suffix(".key")
    ) as viewer:
        assert viewer.url.startswith("https://127.0.0.1:")
        viewer.config = {"displays": [{"type": "Grid"}]}
        page = Page(browser, viewer.url, 400, 300)
        page.wait_for(lambda: page.tab.get_by_text("Grid", exact=True).count() > 0, "the display")
        assert page.errors == []
        page.close()


def test_a_key_without_a_certificate_is_an_error(files: Path) -> None:
    with pytest.raises(webviz.Error, match=r"^`keyfile` needs `certfile`\.$"):
        webviz.Viewer(port=0, source=HandFedSource(), keyfile=files)
