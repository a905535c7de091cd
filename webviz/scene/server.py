"""A viser server behind checks that looks like RViz."""

from __future__ import annotations

import functools
import math
import ssl
import threading
from collections.abc import Iterable, Sequence

import viser
import websockets.asyncio.server as websocket

from webviz.api.roles import Role
from webviz.scene.adapter.greeting import greet
from webviz.scene.constants import CONSTANTS
from webviz.scene.names import ROOT
from webviz.server.access.access import Access
from webviz.server.access.proxies import Proxies
from webviz.server.channel.channel import Channel
from webviz.server.channel.modules import Modules
from webviz.server.http.connections import ConnectionLimits
from webviz.server.http.hosts import HostList
from webviz.server.http.listener import Handshakes, Listener, listen
from webviz.server.http.middleware import Middleware
from webviz.server.http.revocation import Revocation
from webviz.server.http.shared import SharedFile
from webviz.server.http.steps import Step, at, behind, page, with_link, within
from webviz.server.http.tunnels import BackListener, Tunnels, listen_behind
from webviz.server.http.viser_server import Door, Server, replaced

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
    hosts, own_port = HostList(host, allowed_hosts), listener.getsockname()[1]
    door = Door(hosts, access, own_port, link_rate, embedders, Tunnels())
    modules, shared = Modules(CONSTANTS), SharedFile()
    steps = (
        behind(proxies),
        at(hosts),
        with_link(access, own_port),
        within(limits),
        door.tunnels.step,
        shared.step,
        page(modules),
    )
    return _opened(listener, steps, limits, door, modules, shared, tls=tls)


def open_behind(front: Door, path: str, max_pages: int) -> Server:
    """Open a server behind another one, which hands requests over to it.

    Operator is the highest role there.

    Args:
        front: of the other one.
        path: of the socket, in a folder that other users cannot read.
        max_pages: that may be connected at once.

    Raises:
        OSError: the socket cannot be made.
    """
    listener, limits, access = listen_behind(path), ConnectionLimits(), front.access
    limits.limit = max_pages
    access = access.limited(Role.OPERATOR)
    door = Door(front.hosts, access, front.port, front.link_rate, front.embedders, Tunnels())
    modules = Modules(CONSTANTS)
    steps = (
        behind(Proxies()),
        at(front.hosts),
        with_link(access, front.port),
        within(limits),
        page(modules),
    )
    return _opened(listener, steps, limits, door, modules, SharedFile())


def _opened(
    listener: Listener | BackListener,
    steps: Sequence[Step],
    limits: ConnectionLimits,
    door: Door,
    modules: Modules,
    shared: SharedFile,
    *,
    tls: ssl.SSLContext | None = None,
) -> Server:
    """Serve an empty scene."""
    channel = Channel()
    begin = Revocation(door.access, limits).begin
    middleware = Middleware(
        listener, steps, limits, tls, channel, begin, door.link_rate, door.embedders
    )
    with (
        _opening,
        replaced(websocket, "serve", functools.partial(middleware.serve, websocket.serve)),
    ):
        server = Server(channel, modules, shared, limits.close, door, port=door.port, verbose=False)
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
