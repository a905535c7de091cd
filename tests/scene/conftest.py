"""A server, a scene and a real browser for tests of what people see."""

from __future__ import annotations

import math
import socket
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any, Protocol

import msgspec
import numpy as np
import playwright.sync_api as playwright
import pytest
import viser
import websockets.sync.client
import zstandard
from several import several

from webviz.api.nodes import Rgb
from webviz.scene import ViserScene, open_server
from webviz.shell.pictures.browser import Page
from webviz.shell.pictures.browser_scripts import CANVAS

Point = tuple[float, float, float]

SIZE = (320, 240)
"""Size of a tab in pixels."""


def floats(*values: Any) -> np.ndarray:
    """Values as a node has them: float32."""
    return np.array(values, np.float32)


@pytest.fixture
def server() -> Iterator[viser.ViserServer]:
    server = open_server(port=0)
    yield server
    server.stop()


@pytest.fixture
def scene(server: viser.ViserServer) -> ViserScene:
    return ViserScene(server)


@contextmanager
def opened_view(browser: playwright.Browser) -> Iterator[View]:
    """Open a server of its own, and a tab of it."""
    server = open_server(port=0)
    view = View(browser, ViserScene(server))
    yield view
    view.close()
    server.stop()


@pytest.fixture(scope="package")
def tab(browser: playwright.Browser) -> Iterator[View]:
    """One tab for the tests of all modules: opening it takes seconds."""
    with opened_view(browser) as view:
        yield view


@pytest.fixture(scope="package")
def still(browser: playwright.Browser) -> Iterator[View]:
    """A tab that draws only when it is looked at, which costs less."""
    with opened_view(browser) as view:
        view.hold()
        yield view


@pytest.fixture
def view(tab: View) -> Iterator[View]:
    """A tab with an empty scene that looks down on the origin from 10 m."""
    tab.scene.clear()
    tab.look((0.0, -0.01, 10.0), (0.0, 0.0, 0.0))
    yield tab
    assert tab.errors == []


class View(Page):
    """One browser tab with the scene."""

    def __init__(self, browser: playwright.Browser, scene: ViserScene) -> None:
        self.scene = scene
        server = scene.link.server
        others = set(server.get_clients())
        super().__init__(browser, f"http://127.0.0.1:{server.get_port()}", *SIZE)
        # Until it has placed its camera at the start view, it would leave any other place again.
        self.wait_for(lambda: scene.cameras.views().keys() - others, "the tab has its start view")
        self.wait_for(lambda: self.evaluate(CANVAS) == [*SIZE], "the canvas has its size")

    def look(self, position: Point, at: Point) -> None:
        """Put the camera at `position`."""
        for client in self.scene.link.server.get_clients().values():
            with client.atomic():
                client.camera.position = position
                client.camera.look_at = at
        self.show()
        middle = SIZE[0] / 2, SIZE[1] / 2
        self.wait_for(
            lambda: self.draw(1) or math.dist(self.pixel_of(*at), middle) < 1.0, "the camera there"
        )

    def show(self) -> None:
        """Send what was changed and wait until it is drawn."""
        self.scene.flush()
        # The driver must keep running while the browser answers, so wait in slices of its time.
        self.wait_for(self._acknowledged, "the tab has applied everything")
        self.draw()

    def color_at(self, point: Point) -> Rgb:
        """The colour drawn where a point of the scene (without its origin) is."""
        (color,) = self.colors_at(point)
        return color

    def colors_at(self, *points: Point) -> list[Rgb]:
        """The colours drawn where points are, in one picture: to take one is slow."""
        pixels = self.pixels()
        return [tuple(pixels[self.row_column(point)].tolist()) for point in points]

    def row_column(self, point: Point) -> tuple[int, int]:
        """Return where a point of the scene (without its origin) is drawn."""
        column, row = self.pixel_of(*point)
        return int(row), int(column)

    def nodes(self) -> set[str]:
        """Names of the scene nodes in the page, below the root."""
        names = self.evaluate(
            """() => Object.entries(window.__viserSceneTree.getState())
              .filter(([name, node]) => node !== undefined).map(([name]) => name)"""
        )
        return {name for name in names if name.startswith("/webviz/")}

    def _acknowledged(self) -> bool:
        self.scene.acknowledge(60)
        return True


class HasPort(Protocol):
    """Protocol of a server, which may run in another process."""

    def get_port(self) -> int:
        """Its port on this machine."""
        ...


class Peer:
    """A program that talks to the server as a browser's websocket does.

    Args:
        server: whom to call.
        below: path of its page.
        headers: more headers for the handshake.
    """

    def __init__(self, server: HasPort, below: str = "/", **headers: str) -> None:
        self.websocket = websockets.sync.client.connect(
            f"ws://127.0.0.1:{server.get_port()}{below}",
            subprotocols=[f"viser-v{viser.__version__}"],  # pyright: ignore[reportArgumentType]
            additional_headers=headers,
            compression=None,
            max_size=None,
            ping_interval=None,
            close_timeout=0.1,
            max_queue=1,
        )

    def send(self, message: dict[str, Any] | bytes) -> None:
        """Send a message, or bytes as they are."""
        data = message if isinstance(message, bytes) else msgspec.msgpack.encode(message)
        self.websocket.send(data)

    def look(self, x: float = 1.0) -> None:
        """Send a camera, upon which the server counts this peer as a browser."""
        self.send(
            {
                "type": "ViewerCameraMessage",
                "wxyz": [1, 0, 0, 0],
                "position": [x, 1.0, 1.0],
                "fov": 1.0,
                "near": 0.1,
                "far": 100.0,
                "image_height": 240,
                "image_width": 320,
                "look_at": [0, 0, 0],
                "up_direction": [0, 0, 1],
            }
        )

    def frame(self, timeout: float = 60.0) -> bytes:
        """The next websocket frame."""
        data = self.websocket.recv(timeout)
        assert isinstance(data, bytes)
        return data

    def receive(self, timeout: float = 60.0) -> list[dict[str, Any]]:
        """The messages of the next websocket frame."""
        data = self.frame(timeout)
        size = int.from_bytes(data[8:16], "little")
        packed = zstandard.ZstdDecompressor().decompress(
            data[16 : 16 + size], max_output_size=int.from_bytes(data[:8], "little")
        )
        return msgspec.msgpack.decode(packed)["messages"]

    def replay(self) -> list[dict[str, Any]]:
        """All messages that a joining browser is sent first."""
        messages: list[dict[str, Any]] = []
        while not any(message["type"] == "ReplayDoneMessage" for message in messages):
            messages += self.receive()
        return messages

    def drain(self, timeout: float | None = 60.0) -> None:
        """Receives until the connection ends; `timeout` is that of all, None for none."""
        deadline = None if timeout is None else time.monotonic() + timeout
        while True:
            self.websocket.recv(None if deadline is None else max(0.0, deadline - time.monotonic()))

    def close(self) -> None:
        """Ends the connection without a farewell, to which a server that waits never responds."""
        self.websocket.close_socket()


@pytest.fixture
def call(server: viser.ViserServer) -> Iterator[Callable[..., Peer]]:
    """Connect a `Peer`; headers as keyword arguments."""
    with several(partial(Peer, server)) as call:
        yield call


@pytest.fixture
def ask(server: viser.ViserServer) -> Callable[[bytes], tuple[int, bytes, bytes]]:
    """Send the bytes of a request; return status, headers and body of the answer."""

    def ask(request: bytes) -> tuple[int, bytes, bytes]:
        with socket.create_connection(("127.0.0.1", server.get_port()), timeout=60) as client:
            client.sendall(request)
            answer = b"".join(iter(lambda: client.recv(1 << 16), b""))
        head, _, body = answer.partition(b"\r\n\r\n")
        return int(head.split()[1]), head, body

    return ask
