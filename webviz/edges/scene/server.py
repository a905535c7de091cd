"""Opens a viser server that is safe to leave running and looks like RViz."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
import rich
import viser
import websockets.asyncio.server as websocket

from webviz.api.nodes import Rgb
from webviz.edges.scene.connections import Gate
from webviz.edges.scene.guard import guarded_serve
from webviz.edges.scene.gui_values import accepts_update
from webviz.edges.scene.hosts import HostList
from webviz.edges.scene.lights import add_lights
from webviz.edges.scene.listener import listen

BACKGROUND: Rgb = (48, 48, 48)
"""RViz's default."""

_opening = threading.Lock()


def open_server(
    host: str = "127.0.0.1", port: int = 8080, allowed_hosts: Iterable[str] = ()
) -> viser.ViserServer:
    """Opens a server with an empty, lit scene.

    Args:
        host: address to bind to.
        port: TCP port; 0 picks a free one.
        allowed_hosts: names, without port, under which browsers may address the server, besides
            the loopback ones and `host`.

    Returns:
        The running server; `stop()` ends its threads and frees the port.

    Raises:
        PortInUse: another program listens there.
        CannotListen: `host` is no address of this machine, or the port is not allowed.
    """
    listener = listen(host, port)
    server: viser.ViserServer | None = None

    def accepts(message: dict[str, Any]) -> bool:
        return server is not None and accepts_update(server, message)

    gate, hosts = Gate(), HostList(host, allowed_hosts)
    serve = guarded_serve(websocket.serve, listener, gate, hosts, accepts)
    with _opening, _replaced(websocket, "serve", serve):
        server = _Server(gate, host=host, port=port, verbose=False)
    _prepare(server)
    return server


def set_background(server: viser.ViserServer, rgb: Rgb) -> None:
    """Fills what lies behind the scene with one colour."""
    server.scene.set_background_image(np.array([[rgb]], dtype=np.uint8), format="png")


class _Server(viser.ViserServer):
    """viser's server without its greetings on the terminal, that waits for nobody when it stops."""

    def __init__(self, gate: Gate, **options: Any) -> None:
        self._gate = gate
        with _quiet():
            super().__init__(**options)

    def stop(self) -> None:
        with contextlib.suppress(RuntimeError):  # it has stopped before
            self.get_event_loop().call_soon_threadsafe(self._gate.close)
        with _quiet():
            super().stop()


def _prepare(server: viser.ViserServer) -> None:
    server.gui.configure_theme(dark_mode=True, show_logo=False, show_share_button=False)
    set_background(server, BACKGROUND)
    add_lights(server.scene)
    server.scene.set_up_direction("+z")
    server.initial_camera.far = 1e5


@contextlib.contextmanager
def _replaced(module: Any, name: str, value: Any) -> Iterator[None]:
    original = getattr(module, name)
    setattr(module, name, value)
    try:
        yield
    finally:
        setattr(module, name, original)


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    console = rich.get_console()
    with _replaced(console, "quiet", True):
        yield
