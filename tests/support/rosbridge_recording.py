"""Exchanges with the real rosbridge, recorded once and played back in tests.

    python rosbridge_recording.py URL FILE [FEW]

connects a source to rosbridge through a proxy that notes all frames, does what tests do, and writes
the file. FEW is for a server with a small max_message_size, from which only lists are asked.

The files of `tests/sources/bridge/` are of rosbridge_suite 2.1.0 (branch ros2, commit c1bfc2f) on
rclpy 7.1.6 and tornado 6.6.1, with `webviz demo`'s robot as the graph. Server and rosapi ran from
their sources in one process: rosapi_msgs cannot be built from PyPI's packages, so that its services
were functions of that process. What a service answers is the same.
"""

from __future__ import annotations

import base64
import gzip
import json
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from bridges import SCAN, STRING, TF, BridgeReader, reading
from serving import serving
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect
from websockets.sync.connection import Connection
from websockets.sync.server import ServerConnection, serve

from webviz.data.messages import encode, interfaces
from webviz.sources.graph import Advertisement, NotConnected

MAP = "nav_msgs/msg/OccupancyGrid"
POSE = "geometry_msgs/msg/PoseStamped"
PATH = "nav_msgs/msg/Path"
ODOMETRY = "nav_msgs/msg/Odometry"
GET = "rcl_interfaces/srv/GetParameters"
GOAL = {"header": {"frame_id": "map"}, "pose": {"position": {"x": 1.0, "y": 0.5}}}
EACH = 3
"""Messages of a topic that are kept."""

Frame = str | bytes


class Replay:
    """A server that answers as the recorded one did.

    Args:
        path: of the recording.
        port: 0 for a free one.
    """

    def __init__(self, path: Path, port: int = 0) -> None:
        self.got: list[dict[str, Any]] = []
        """Frames of clients other than calls of rosapi."""
        self._answers: dict[str, list[dict[str, Any]]] = {}
        self._messages: dict[str, list[bytes]] = {}
        self._load(path)
        self._server = serve(self._talk, "127.0.0.1", port, compression=None, max_size=None)
        self.port: int = self._server.socket.getsockname()[1]
        self.url = f"ws://127.0.0.1:{self.port}"
        self._connections: set[ServerConnection] = set()
        threading.Thread(target=self._server.serve_forever, daemon=True).start()

    def _load(self, path: Path) -> None:
        calls: dict[str, str] = {}
        for is_client, frame in read(path):
            if isinstance(frame, bytes):
                self._messages.setdefault(_topic(frame), []).append(frame)
                continue
            text = json.loads(frame)
            if is_client and text["op"] == "call_service":
                calls[text["id"]] = _call(text)
            elif not is_client and text["id"] in calls:
                self._answers.setdefault(calls[text["id"]], []).append(text)

    def _talk(self, connection: ServerConnection) -> None:
        self._connections.add(connection)
        try:
            for frame in connection:
                self._answer(connection, json.loads(frame))
        except ConnectionClosed:
            return

    def _answer(self, connection: ServerConnection, text: dict[str, Any]) -> None:
        if text["op"] == "call_service":
            for answer in self._answers.get(_call(text), ()):
                connection.send(json.dumps({**answer, "id": text["id"]}))
            if text["service"].startswith("/rosapi/"):
                return
        self.got.append(text)
        if text["op"] == "subscribe":
            for message in self._messages.get(text["topic"], ()):
                connection.send(message)

    def close(self) -> None:
        """End it and all its connections."""
        self._server.shutdown()
        for connection in self._connections:
            connection.close_socket()


def read(path: Path) -> Iterator[tuple[bool, Frame]]:
    """All frames of a recording: whether it is of the client, and the frame."""
    with gzip.open(path, "rt") as lines:
        for line in lines:
            entry = json.loads(line)
            is_binary = "binary" in entry
            yield (
                entry["client"],
                base64.b64decode(entry["binary"]) if is_binary else entry["text"],
            )


def _call(text: dict[str, Any]) -> str:
    return json.dumps([text["service"], text.get("args")], sort_keys=True)


def _topic(frame: bytes) -> str:
    """The topic of a message in CBOR: the text after the key."""
    start = frame.index(b"etopic") + 6
    length, start = (
        (frame[start + 1], start + 2) if frame[start] == 0x78 else (frame[start] & 31, start + 1)
    )
    return frame[start : start + length].decode()


@contextmanager
def recording(url: str, frames: list[tuple[bool, Frame]]) -> Iterator[str]:
    """Run a proxy before a server; its address."""

    def talk(near: ServerConnection) -> None:
        with connect(url, compression=None, max_size=None) as far:

            def back() -> None:
                forward(far, near, is_client=False)

            thread = threading.Thread(target=back, daemon=True)
            thread.start()
            forward(near, far, is_client=True)

    def forward(
        source: Connection,
        target: Connection,
        *,
        is_client: bool,
    ) -> None:
        try:
            for frame in source:
                frames.append((is_client, frame))
                target.send(frame)
        except ConnectionClosed:
            return

    with serving(serve(talk, "127.0.0.1", 0, compression=None, max_size=None)) as server:
        yield f"ws://127.0.0.1:{server.socket.getsockname()[1]}"


def do_all(reader: BridgeReader, count: int = EACH) -> None:
    """Do what tests compare with the recording, after so many messages of /odom."""
    reader.until_up()
    types: dict[str, Any] = {"scan": SCAN, "tf": TF, "tf_static": TF, "map": MAP, "odom": ODOMETRY}
    reader.want(**types, robot_description=STRING)
    reader.receive("/odom", count)
    graph = reader.source.graph
    goal = Advertisement("/goal_pose", POSE)
    graph.advertise([goal]).result(10)
    graph.publish(goal, encode(POSE, GOAL)).result(10)
    reader.want(path=PATH)
    reader.receive("/path")
    graph.advertise([]).result(10)
    interfaces.service(GET)
    request = encode(f"{GET}_Request", {"names": ["robot", "scan_noise", "rate"]})
    graph.call("/sim/get_parameters", GET, request, 10).result(11)
    try:
        graph.call("/nobody", GET, request, 10).result(11)
    except NotConnected:
        return


def main(url: str, path: str, few: str = "") -> None:
    """Record."""
    frames: list[tuple[bool, Frame]] = []
    with recording(url, frames) as proxied, reading(proxied) as reader:
        if few:
            reader.until_up()
            reader.until(lambda: any('"op": "fragment"' in str(frame) for _, frame in frames))
            reader.until(lambda: reader.source.graph.nodes())
        else:
            do_all(reader, 20)
    counts: dict[str, int] = {}
    with gzip.GzipFile(path, "wb", mtime=0) as file:
        for is_client, frame in frames:
            entry: dict[str, Any] = {"client": is_client}
            if isinstance(frame, bytes):
                topic = _topic(frame)
                counts[topic] = counts.get(topic, 0) + 1
                if counts[topic] > EACH:
                    continue
                entry["binary"] = base64.b64encode(frame).decode()
            else:
                entry["text"] = frame
            file.write(json.dumps(entry).encode() + b"\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
