"""The listening socket of the server."""

from __future__ import annotations

import contextlib
import errno
import http
import logging
import os
import socket
from typing import Any

from webviz.api.errors import Error
from webviz.server.http.eviction import network_of, oldest_of_most_crowded

MAX_PORT = 65535

SEND_BUFFER_BYTES = 1 << 19
"""Data in flight per connection: enough for 5 MB/s at a round trip of 100 ms."""

UNSENT_BYTES = 1 << 16
"""Data per connection that is ready to be sent."""

MAX_HANDSHAKES = 32
"""Connections whose TLS handshake is not complete; of more, the oldest of the most crowded network
ends."""

_BUSY = "webviz has no file descriptors left for another connection. Try again later.\n"


class CannotListen(Error, OSError):
    """The server cannot listen at its address; the message says why."""


class PortInUse(CannotListen):
    """Another program listens on the port."""


class Handshakes:
    """Limits the TLS handshakes that are not complete, as of clients that only connect."""

    def __init__(self) -> None:
        self._sockets: dict[int, tuple[socket.socket, str]] = {}
        """Sockets with the network of each."""

    def begin(self, accepted: socket.socket, address: str) -> None:
        """Add a connection; if there are too many, one of the most crowded network ends."""
        self._sockets = {
            number: other for number, other in self._sockets.items() if other[0].fileno() == number
        }
        self._sockets[accepted.fileno()] = accepted, network_of(address)
        if len(self._sockets) > MAX_HANDSHAKES:
            networks = {number: network for number, (_, network) in self._sockets.items()}
            self._shut(oldest_of_most_crowded(networks))

    def end(self, number: int) -> None:
        """Remove a connection, by its file descriptor."""
        self._sockets.pop(number, None)

    def close(self) -> None:
        """Close all."""
        for number in tuple(self._sockets):
            self._shut(number)

    def _shut(self, number: int) -> None:
        # asyncio owns the socket and closes it once it reads the end.
        with contextlib.suppress(OSError):
            self._sockets.pop(number)[0].shutdown(socket.SHUT_RDWR)


class Listener(socket.socket):
    """A listening socket that refuses connections while the process is out of file descriptors.

    asyncio would retry a hundred times a second and log each attempt, while browsers wait. Hence a
    spare descriptor is kept, to accept a connection and refuse it.
    """

    _spare: int | None = None
    log: logging.Logger | None = None
    handshakes: Handshakes | None = None
    """Connections with TLS that have not become one of websockets yet."""

    def accept(self) -> tuple[socket.socket, tuple[Any, ...]]:
        """Accept a connection; raises BlockingIOError if there is none, or no descriptor left."""
        self._keep_spare()
        try:
            accepted = super().accept()
        except OSError as error:
            if error.errno not in (errno.EMFILE, errno.ENFILE) or self._spare is None:
                raise
            if self.log is not None:
                self.log.warning("Refused a connection: %s.", error.strerror)
            self._refuse()
            raise BlockingIOError from None
        if self.handshakes is not None:
            self.handshakes.begin(accepted[0], accepted[1][0])
        return accepted

    def close(self) -> None:
        """Close the socket."""
        self._close_spare()
        super().close()

    def _refuse(self) -> None:
        self._close_spare()
        with contextlib.suppress(OSError):
            untrusted, _ = super().accept()
            with untrusted:
                untrusted.setblocking(False)
                if self.handshakes is None:
                    untrusted.send(_refusal())

    def _keep_spare(self) -> None:
        if self._spare is None:
            with contextlib.suppress(OSError):
                self._spare = os.open(os.devnull, os.O_RDONLY | os.O_CLOEXEC)

    def _close_spare(self) -> None:
        if self._spare is not None:
            os.close(self._spare)
            self._spare = None


def listen(host: str, port: int) -> Listener:
    """Binds a socket.

    Raises:
        PortInUse: another program listens there.
        CannotListen: `host` is not an address of this machine, or the port is not allowed.
    """
    if not 0 <= port <= MAX_PORT:  # the system would use the lower 16 bits
        raise CannotListen(f"{port} is not a valid port. Use 1 to {MAX_PORT}, or 0 for any.")
    try:
        family, _, _, _, address = socket.getaddrinfo(
            host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
        )[0]
        bound = socket.create_server(address[:2], family=family)
    except OSError as error:
        if error.errno == errno.EADDRINUSE:
            raise PortInUse(
                f"Port {port} of {host} is in use. Stop the program that uses it, or choose "
                "another port."
            ) from None
        reason = error.strerror or str(error)
        raise CannotListen(f"Cannot listen on port {port} of {host}: {reason}.") from None
    listener = Listener(bound.family, bound.type, bound.proto, bound.detach())
    listener._keep_spare()
    _let_newest_win(listener)
    return listener


def _let_newest_win(listener: socket.socket) -> None:
    """Limits the kernel's buffers of connections, in which newer messages cannot overtake."""
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SEND_BUFFER_BYTES)
    # What is written goes out at once: else it waits up to 40 ms for an acknowledgement (Nagle).
    listener.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    if hasattr(socket, "TCP_NOTSENT_LOWAT"):
        listener.setsockopt(socket.IPPROTO_TCP, socket.TCP_NOTSENT_LOWAT, UNSENT_BYTES)


def _refusal() -> bytes:
    status = http.HTTPStatus.SERVICE_UNAVAILABLE
    return (
        f"HTTP/1.1 {status.value} {status.phrase}\r\nConnection: close\r\n"
        f"Content-Type: text/plain; charset=utf-8\r\nContent-Length: {len(_BUSY)}\r\n\r\n{_BUSY}"
    ).encode()
