"""The whole page below a path of a proxy, with the configurations of the documentation."""

from __future__ import annotations

import re
import socket
import ssl
from collections.abc import Iterator
from pathlib import Path

import playwright.sync_api as playwright
import pytest
import viser
from certificates import authority, certificate
from pages import COARSE
from proxies import running

import webviz
from webviz.shell.pictures.browser import Page
from webviz.shell.testing.source import HandFedSource

UPLOADED = "version: 1\ndisplays:\n- type: Axes\n  name: Uploaded\n"


SECRET = "a-token-for-the-owner-behind-a-proxy"


@pytest.fixture(scope="module")
def viewer(tmp_path_factory: pytest.TempPathFactory) -> Iterator[webviz.Viewer]:
    """It asks for tokens, since a proxy brings others to this machine."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CONFIG_HOME", str(tmp_path_factory.mktemp("config")))
        patch.setenv("WEBVIZ_TOKEN_OWN", SECRET)
        with webviz.Viewer(
            port=0,
            source=HandFedSource(),
            allow_hosts=["robots.example"],
            trust_proxies=["127.0.0.1"],
        ) as viewer:
            yield viewer


@pytest.mark.parametrize("name", ["nginx", "caddy"])
def test_page_websockets_and_uploads_work_below_a_path(
    name: str, viewer: webviz.Viewer, browser: playwright.Browser, tmp_path: Path
) -> None:
    viewer.config = {"displays": [{"type": "Grid"}]}
    with running(name, tmp_path, [viewer.port], certificate(tmp_path)) as port:
        own = f"robots.example:{port}"
        assert answer_of(port, own, "/robot1/").startswith(b"HTTP/1.1 403 ")
        let_in = answer_of(port, own, f"/robot1/?own={SECRET}")
        assert let_in.startswith(b"HTTP/1.1 303 ")
        assert b"\r\nLocation: ./\r\n" in let_in
        (cookie,) = re.findall(rb"\r\nSet-Cookie: (\w+)=(\w+);[^\r]*; Secure\r\n", let_in)
        cookie_name, value = cookie[0].decode(), cookie[1].decode()

        page = Page(
            browser,
            f"https://localhost:{port}/robot1",
            900,
            500,
            cookie=(cookie_name, value),
            resolution=COARSE,
        )
        names = page.tab.get_by_role("treeitem")
        page.wait_for(lambda: names.filter(has_text="Grid").count() > 0, "the tree")
        assert page.tab.url == f"https://localhost:{port}/robot1/?fixedDpr={COARSE}"
        assert page.evaluate("() => isSecureContext")

        page.tab.keyboard.press("Control+o")
        page.tab.get_by_label("File of this computer").set_input_files(
            {"name": "a.yaml", "mimeType": "", "buffer": UPLOADED.encode()}
        )
        page.tab.get_by_role("button", name="Discard").click()
        page.wait_for(lambda: [d.name for d in viewer.displays] == ["Uploaded"], "the upload")
        page.wait_for(lambda: names.filter(has_text="Uploaded").count() > 0, "the new tree")
        assert page.errors == []
        page.close()

        secret = f"{cookie_name}={value}"
        assert is_upgraded(answer_of(port, own, "/robot1/", f"https://{own}", secret))
        assert not is_upgraded(answer_of(port, own, "/robot1/", f"https://{own}", ""))
        for host, origin in (
            (own, "https://evil.example"),
            (own, f"https://127.0.0.1:{viewer.port}"),
            ("evil.example", "https://evil.example"),
        ):
            assert not is_upgraded(answer_of(port, host, "/robot1/", origin, secret))


def answer_of(port: int, host: str, path: str, origin: str = "", cookie: str = "") -> bytes:
    """The head of a proxy's answer: to a websocket of a page of an origin, or to a request."""
    context = ssl.create_default_context()
    authority().configure_trust(context)
    lines = [f"GET {path} HTTP/1.1", f"Host: {host}", "Sec-Fetch-Site: none"]
    if cookie:
        lines.append(f"Cookie: {cookie}")
    if origin:
        lines += [
            f"Origin: {origin}",
            "Upgrade: websocket",
            "Connection: Upgrade",
            "Sec-WebSocket-Version: 13",
            "Sec-WebSocket-Key: MDEyMzQ1Njc4OTAxMjM0NQ==",
            f"Sec-WebSocket-Protocol: viser-v{viser.__version__}",
        ]
    with (
        socket.create_connection(("127.0.0.1", port), timeout=60) as plain,
        context.wrap_socket(plain, server_hostname="robots.example") as caller,
    ):
        caller.sendall("\r\n".join([*lines, "", ""]).encode())
        answer = b""
        while b"\r\n\r\n" not in answer and (part := caller.recv(1 << 12)):
            answer += part
        return answer


def is_upgraded(answer: bytes) -> bool:
    """Return whether a websocket is open."""
    return answer.startswith(b"HTTP/1.1 101 ")
