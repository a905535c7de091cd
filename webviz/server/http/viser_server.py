"""viser's server without output on the terminal."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import msgspec
import rich
import viser

from webviz.server.access.access import Access
from webviz.server.channel.channel import Channel
from webviz.server.channel.modules import Modules
from webviz.server.http.hosts import HostList
from webviz.server.http.shared import SharedFile
from webviz.server.http.tunnels import Tunnels


class Door(msgspec.Struct, frozen=True):
    """The way of browsers to a server.

    Args:
        hosts: names by which they address it.
        access: knows who may connect.
        port: that they use.
        link_rate: bytes a second that the link to each takes; None to measure it.
        embedders: origins of pages that may embed the page.
        tunnels: the servers behind it.
    """

    hosts: HostList
    access: Access
    port: int
    link_rate: float | None
    embedders: Sequence[str]
    tunnels: Tunnels


class Server(viser.ViserServer):
    """viser's server without its banner; it stops without waiting for browsers.

    Args:
        channel: to the modules of its pages.
        modules: of its pages.
        shared: the file that its pages can download.
        close: closes all connections; called on the event loop.
        door: how browsers reach it.
        options: for viser.
    """

    def __init__(
        self,
        channel: Channel,
        modules: Modules,
        shared: SharedFile,
        close: Callable[[], None],
        door: Door,
        **options: Any,
    ) -> None:
        self.channel = channel
        self.modules = modules
        self.shared = shared
        self.door = door
        self._close = close
        with replaced(rich.get_console(), "quiet", True):
            super().__init__(**options)

    def stop(self) -> None:
        """End the server's threads and free the port."""
        with contextlib.suppress(RuntimeError):  # stopped already
            self.get_event_loop().call_soon_threadsafe(self._close)
        with replaced(rich.get_console(), "quiet", True):
            super().stop()


@contextlib.contextmanager
def replaced(target: Any, name: str, value: Any) -> Iterator[None]:
    """Replace an attribute during the block."""
    original = getattr(target, name)
    setattr(target, name, value)
    try:
        yield
    finally:
        setattr(target, name, original)
