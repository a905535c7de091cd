"""A guarded viser server that looks like RViz."""

from __future__ import annotations

import functools
import math
import ssl
import threading
from collections.abc import Iterable, Sequence

import viser
import websockets.asyncio.server as websocket

from webviz.scene.adapter.greeting import greet
from webviz.scene.constants import CONSTANTS
from webviz.scene.names import ROOT
from webviz.server.access.access import Access
from webviz.server.access.proxies import Proxies
from webviz.server.channel.channel import Channel
from webviz.server.channel.modules import Modules
from webviz.server.http.connections import ConnectionLimits
from webviz.server.http.guard import RequestGuard
from webviz.server.http.hosts import HostList
from webviz.server.http.listener import Handshakes, listen
from webviz.server.http.revocation import Revocation
from webviz.server.http.shared import SharedFile
from webviz.server.http.steps import at, behind, page, with_link, within
from webviz.server.http.viser_server import Server, replaced

_opening = threading.Lock()


def open_server(
    host: str = "127.0.0.1",
    port: int = 8080,
    allowed_hosts: Iterable[str] = (),
    *,
    tls: ssl.SSLContext | None = None,
    trusted_proxies: Iterable[str] = (),
    access: Access | None = None,
    link_rate: float | None = None,
    embedders: Sequence[str] = (),
) -> Server:
    """Open a server with an empty, lit scene.

    Args:
        host: address to bind to.
        port: TCP port; 0 picks a free one.
        allowed_hosts: names without port by which browsers may address the server, besides
            loopback and `host`.
        tls: certificate and key; None for plain HTTP.
        trusted_proxies: IP addresses or networks of proxies whose forwarded headers are used.
        access: knows who may connect; None for everybody.
        link_rate: bytes a second that the link to each browser takes; None to measure it.
        embedders: origins of pages that may embed the page, such as "http://localhost:8888".

    Returns:
        The running server; `stop()` ends its threads and frees the port.

    Raises:
        PortInUse: another program listens there.
        CannotListen: `host` is not an address of this machine, or the port is not allowed.
        Error: an address of a proxy is invalid.
    """
    proxies = Proxies(trusted_proxies)
    listener = listen(host, port)
    if tls is not None:
        listener.handshakes = Handshakes()
    limits, access = ConnectionLimits(listener.handshakes), access or Access()
    channel, modules, shared = Channel(), Modules(CONSTANTS), SharedFile()
    steps = (
        behind(proxies),
        at(HostList(host, allowed_hosts)),
        with_link(access, listener.getsockname()[1]),
        within(limits),
        shared.step,
        page(modules.head),
    )
    begin = Revocation(access, limits).begin
    guard = RequestGuard(listener, steps, limits, tls, channel, begin, link_rate, embedders)
    with _opening, replaced(websocket, "serve", functools.partial(guard.serve, websocket.serve)):
        server = Server(channel, modules, shared, limits.close, host=host, port=port, verbose=False)
    greet(server, channel, modules)
    _prepare(server)
    return server


def _prepare(server: viser.ViserServer) -> None:
    server.gui.configure_theme(dark_mode=True, show_logo=False, show_share_button=False)
    # An ambient light shows plain colours, which `shade.js` then shades. viser's lights are too
    # bright without tone mapping, and image-based lighting stalls browsers without a GPU.
    server.scene.configure_environment_map(None)
    server.scene.configure_default_lights(False, cast_shadow=False)
    server.scene.add_light_ambient("/lights/ambient", intensity=math.pi)
    server.scene.set_up_direction("+z")
    server.initial_camera.far = 1e5
    server.scene.add_frame(ROOT, show_axes=False)
