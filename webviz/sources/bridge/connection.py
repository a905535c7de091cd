"""A websocket that knows when it last heard from the other side."""

from __future__ import annotations

import time

from websockets.asyncio.client import ClientConnection


class BridgeConnection(ClientConnection):
    """A connection whose silence is measured in bytes.

    An answer to a ping may wait behind a large message, so that is not silence.
    """

    _heard_s = 0.0

    @property
    def silent_s(self) -> float:
        """Seconds since the last byte arrived."""
        return time.monotonic() - self._heard_s if self._heard_s else 0.0

    def data_received(self, data: bytes) -> None:
        """Note the time."""
        self._heard_s = time.monotonic()
        super().data_received(data)


class Silent(Exception):
    """Nothing comes from the bridge any more; one sentence."""
