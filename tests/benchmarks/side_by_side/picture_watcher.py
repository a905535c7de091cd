"""A client of webviz that shows its panes, as a page does over the channel of webviz."""

from __future__ import annotations

import json
import struct
from collections.abc import Sequence
from typing import Any

from side_by_side import viser_wire
from side_by_side.log import Sighting
from side_by_side.scenes import Scene
from side_by_side.watchers import SocketWatcher, ViserWatcher
from side_by_side.websocket import Opcode, WebSocket

WIDTH = 1920
"""Of each pane on the screen."""


class PictureWatcher(ViserWatcher):
    """A client of viser's server that opens the channel once it knows its key."""

    def __init__(self, port: int, scene: Scene | None, stalls: bool = False) -> None:
        self._channel: _Channel | None = None
        self._open = lambda key: _Channel(port, key, scene, stalls)
        super().__init__(port, scene, stalls)

    @property
    def bytes(self) -> int:
        """Received so far on both connections."""
        return super().bytes + (self._channel.bytes if self._channel else 0)

    @property
    def is_connected(self) -> bool:
        """Return whether both connections stand."""
        return super().is_connected and self._channel is not None and self._channel.is_connected

    def hear(self, kind: Opcode, data: memoryview) -> None:
        """Open the channel."""
        if self._channel is None and kind == Opcode.BINARY:
            for message in viser_wire.messages(data):
                if message["type"] == "RunJavascriptMessage":
                    source = message["source"].partition("(")[2].removesuffix(");")
                    self._channel = self._open(json.loads(source)["key"])
                    self._channel.sightings = self.sightings

    def close(self) -> None:
        """Leave."""
        super().close()
        if self._channel is not None:
            self._channel.close()


class _Channel(SocketWatcher):
    """Asks for the pictures of all panes, and says that each is shown."""

    def __init__(self, port: int, key: str, scene: Scene | None, stalls: bool) -> None:
        socket = WebSocket(port, "", "/webviz/channel")
        for message in ({"type": "Hello", "key": key}, {"type": "Watch", "store": "panes"}):
            socket.send(json.dumps(message).encode())
        super().__init__(socket, scene, stalls)

    def hear(self, kind: Opcode, data: memoryview) -> None:
        """Ask for pictures, and for the next one."""
        if kind == Opcode.BINARY:
            head = _head(data)
            self._say("FramesShown", numbers={head["display"]: head["number"]})
            return
        message = json.loads(bytes(data))
        if message["type"] == "Values" and "order" in message["set"]:
            self._say("ShowPictures", widths=dict.fromkeys(message["set"]["order"], WIDTH))

    def recognise(self, scene: Scene, data: memoryview, now_ns: int) -> Sequence[Sighting]:
        """The stamp of a picture."""
        return [Sighting(now_ns, None, round(_head(data)["stamp"] * 1e6) * 1000)]

    def _say(self, kind: str, **fields: Any) -> None:
        self._socket.send(json.dumps({"type": kind, **fields}).encode())


def _head(data: memoryview) -> dict[str, Any]:
    (size,) = struct.unpack_from("<I", data)
    return json.loads(bytes(data[4 : 4 + size]))
