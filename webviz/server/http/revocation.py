"""The end of connections whose link was revoked or has expired."""

from __future__ import annotations

import asyncio
import contextlib

from webviz.server.access.access import CHECK_S, Access
from webviz.server.http.connections import ConnectionLimits


class Revocation:
    """Looks again and again at who may still be connected.

    Args:
        access: knows the tokens.
        limits: knows the connections.
    """

    def __init__(self, access: Access, limits: ConnectionLimits) -> None:
        self._access = access
        self._limits = limits

    def begin(self, loop: asyncio.AbstractEventLoop) -> None:
        """Look now and every `CHECK_S` from now on, unless everybody may connect."""
        if self._access.asks:
            self._look(loop)

    def _look(self, loop: asyncio.AbstractEventLoop) -> None:
        def then() -> None:
            with contextlib.suppress(RuntimeError):  # the server has stopped
                loop.call_soon_threadsafe(self._disconnect)

        loop.call_later(CHECK_S, self._look, loop)  # first, as nothing may end this
        self._disconnect()  # tokens expire also while the disk does not respond
        self._access.begin_refresh(then)

    def _disconnect(self) -> None:
        self._limits.disconnect(lambda connection: not self._access.holds(connection.grant))
