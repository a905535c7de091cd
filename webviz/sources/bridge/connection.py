"""A websocket that knows when it last heard from the other side."""

from __future__ import annotations

import time

from websockets.asyncio.client import ClientConnection
from websockets.frames import DATA_OPCODES, CloseCode, Frame
from websockets.protocol import Event

from webviz.sources.graph import NotConnected

STALLED_S = 1.0
"""Time in seconds without any byte from the bridge, after which nothing is sent: it would arrive
late."""
MAX_UNSENT = 64 << 10
"""Bytes that may wait to be sent, beyond which nothing is."""
MAX_PARTS = 10_000
"""Frames of one message, as parts may be empty and so are not bounded by the size of a message."""
TOO_MANY_PARTS = f"a message in more than {MAX_PARTS} parts"


class BridgeConnection(ClientConnection):
    """A connection whose silence is measured in bytes.

    An answer to a ping may wait behind a large message, so that is not silence.
    """

    _heard_s = 0.0
    _parts = 0
    """Frames of the message that is under way."""

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

    def process_event(self, event: Event) -> None:
        """Take a frame, and refuse a message that never ends."""
        if isinstance(event, Frame) and event.opcode in DATA_OPCODES:
            self._parts = 0 if event.fin else self._parts + 1
            if self._parts > MAX_PARTS:
                self.protocol.fail(CloseCode.MESSAGE_TOO_BIG, TOO_MANY_PARTS)
                self.transport.abort()
                return
        super().process_event(event)


class Silent(Exception):
    """Nothing comes from the bridge any more; one sentence."""
