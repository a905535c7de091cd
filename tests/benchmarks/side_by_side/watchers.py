"""Clients: they receive what a viewer sends and note which publications they see."""

from __future__ import annotations

import json
import struct
import threading
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Protocol

import viser

from side_by_side import viser_wire
from side_by_side.log import RECORD, Sighting
from side_by_side.scenes import Scene
from side_by_side.streams import STAMP
from side_by_side.websocket import Closed, Opcode, WebSocket


class Watcher(Protocol):
    """A client of a viewer."""

    @property
    def sightings(self) -> Sequence[Sighting]:
        """Return the sightings so far, in order."""
        ...

    @property
    def bytes(self) -> int:
        """Received so far."""
        ...

    @property
    def is_connected(self) -> bool:
        """Return whether the viewer still sends to it."""
        ...

    def close(self) -> None:
        """Leave."""
        ...


class SocketWatcher:
    """A websocket client with a thread of its own.

    Args:
        socket: the connection.
        scene: what is published, to be recognised; None counts bytes only.
        stalls: whether it stops reading after the first binary message.
    """

    def __init__(self, socket: WebSocket, scene: Scene | None, stalls: bool = False) -> None:
        self.sightings: list[Sighting] = []
        self._stalls = stalls
        self._end = threading.Event()
        self._socket = socket
        self._scene = scene
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    @property
    def bytes(self) -> int:
        """Received so far."""
        return self._socket.bytes

    @property
    def is_connected(self) -> bool:
        """Return whether the connection stands."""
        return self._thread.is_alive()

    def close(self) -> None:
        """Leave."""
        self._end.set()
        self._socket.close()
        self._thread.join()

    def hear(self, kind: Opcode, data: memoryview) -> None:
        """Take a message, also where nothing is to be recognised."""

    def recognise(self, scene: Scene, data: memoryview, now_ns: int) -> Sequence[Sighting]:
        """The publications in a binary message."""
        raise NotImplementedError

    def _run(self) -> None:
        try:
            while True:
                kind, data = self._socket.receive()
                now_ns = time.time_ns()
                self.hear(kind, data)
                if self._stalls and kind == Opcode.BINARY:
                    self._end.wait()
                if self._scene is not None and kind == Opcode.BINARY:
                    self.sightings += self.recognise(self._scene, data, now_ns)
        except Closed:
            pass


class ViserWatcher(SocketWatcher):
    """A client of a viser server."""

    def __init__(self, port: int, scene: Scene | None, stalls: bool = False) -> None:
        self.nodes: set[str] = set()
        """The names of the nodes that there are, if publications are recognised."""
        super().__init__(WebSocket(port, f"viser-v{viser.__version__}"), scene, stalls)

    def recognise(self, scene: Scene, data: memoryview, now_ns: int) -> Sequence[Sighting]:
        """Return the marks found in the arrays, poses and pictures of a window of messages."""
        window = viser_wire.messages(data)
        viser_wire.follow_nodes(window, self.nodes)
        return viser_wire.sightings(window, scene.lanes, now_ns)


class FoxgloveWatcher(SocketWatcher):
    """A client of a Foxglove websocket server that subscribes to every channel."""

    def __init__(self, port: int, scene: Scene | None, stalls: bool = False) -> None:
        self._stamps: dict[int, int | None] = {}
        self._stamp_at = {s.topic: s.stamp_at for s in scene.streams} if scene else {}
        super().__init__(WebSocket(port, "foxglove.sdk.v1"), scene, stalls)

    def hear(self, kind: Opcode, data: memoryview) -> None:
        """Subscribe to what is advertised."""
        if kind != Opcode.TEXT:
            return
        message = json.loads(bytes(data))
        if message["op"] == "advertise":
            channels = message["channels"]
            self._stamps |= {c["id"]: self._stamp_at.get(c["topic"]) for c in channels}
            subscriptions = [{"id": c["id"], "channelId": c["id"]} for c in channels]
            self._socket.send(
                json.dumps({"op": "subscribe", "subscriptions": subscriptions}).encode()
            )

    def recognise(self, scene: Scene, data: memoryview, now_ns: int) -> Sequence[Sighting]:
        """The stamp in the message that the server passes on."""
        opcode, channel, _ = struct.unpack_from("<BIQ", data)
        at = self._stamps.get(channel)
        if opcode != 1 or at is None:
            return []
        sec, nanosec = STAMP.unpack_from(data, 13 + at)
        return [Sighting(now_ns, None, sec * 1_000_000_000 + nanosec)]


class FileWatcher:
    """Reader of the file that the floor's callback writes."""

    def __init__(self, path: Path) -> None:
        self._path = path
        # From the newest record on: a client that joins late gets that message, too, and in a scene
        # where nothing moves no other follows.
        self._start = max(0, path.stat().st_size - RECORD.size) if path.exists() else 0
        self.is_connected = True

    @property
    def sightings(self) -> list[Sighting]:
        """All since it was made, and the one before."""
        data = self._path.read_bytes()[self._start :] if self._path.exists() else b""
        whole = data[: len(data) // RECORD.size * RECORD.size]
        return [Sighting(now, None, stamp) for _, _, stamp, now in RECORD.iter_unpack(whole)]

    @property
    def bytes(self) -> int:
        """Nothing is sent."""
        return 0

    def close(self) -> None:
        """Nothing to do."""
