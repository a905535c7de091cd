"""A websocket that knows when it last heard from the other side."""

from __future__ import annotations

import time

from websockets.asyncio.client import ClientConnection

from webviz.sources.graph import NotConnected

STALLED_S = 1.0
"""Without any byte from the bridge, after which nothing is sent: it would arrive late."""
MAX_UNSENT = 64 << 10
"""Bytes that may wait to be sent, beyond which nothing is."""


class BridgeConnection(ClientConnection):
    """A connection whose silence is measured in bytes.

    An answer to a ping may wait behind a large message, so that is not silence.
    """

    _heard_s = 0.0

    @property
    def silent_s(self) -> float:
        """Seconds since the last byte arrived."""
        return time.monotonic() - self._heard_s if self._heard_s else 0.0

    def require_fresh(self) -> None:
        """Raise NotConnected if what is sent now would arrive late."""
        silent_s = self.silent_s
        if silent_s > STALLED_S:
            raise NotConnected(
                f"The link to the bridge stalls: nothing came for {silent_s:.1f} s, so nothing is "
                "sent that would arrive late."
            )
        if self.transport.get_write_buffer_size() > MAX_UNSENT:
            raise NotConnected(
                "The link to the bridge is too slow for what is sent. Send less, or use a faster "
                "link."
            )

    def data_received(self, data: bytes) -> None:
        """Note the time."""
        self._heard_s = time.monotonic()
        super().data_received(data)


class Silent(Exception):
    """Nothing comes from the bridge any more; one sentence."""
