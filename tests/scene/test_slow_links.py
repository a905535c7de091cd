"""A browser on a poor network: small things first, the newest of large ones, nothing piles up."""

from __future__ import annotations

import socket
from collections.abc import Callable
from typing import Any

import numpy as np
from viser import _messages as wire

from webviz.api.nodes import Points, Pose
from webviz.edges.scene import ViserScene
from webviz.edges.scene.adapter.acknowledging import Marker
from webviz.edges.scene.listener import SEND_BUFFER_BYTES, UNSENT_BYTES
from webviz.edges.scene.outbox import WINDOW_BYTES, Outbox, bulk
from webviz.edges.scene.points import PART


class Queue:
    """The messages there are, as viser's buffer holds them."""

    def __init__(self) -> None:
        self.live: dict[int, Any] = {}
        self.outbox = Outbox(Marker)
        self._count = 0

    def push(self, message: Any) -> None:
        key = message.redundancy_key()
        self.live = {n: m for n, m in self.live.items() if m.redundancy_key() != key}
        self.live[self._count] = message
        self._count += 1

    def cloud(self, name: str, count: int = WINDOW_BYTES // 4) -> None:
        self.push(wire.SceneNodeUpdateMessage(name, {"points": np.zeros(count, np.float32)}))

    def window(self) -> list[str]:
        """Names of the nodes in the next frame, the type of what has none."""
        return [getattr(message, "name", type(message).__name__) for message in self._next()]

    def versions(self) -> list[str]:
        """Names of the nodes in the next frame, with the versions of their clouds."""
        clouds = [(each.name, each.updates.get("cloud")) for each in self._next()]
        return [f"{name}{cloud[1]}" if cloud else name for name, cloud in clouds]

    def _next(self) -> list[Any]:
        messages = self.outbox.small(self.live, self._count - 1, None)
        return messages + self.outbox.large(self.live)


def with_parts(queue: Queue, version: int, names: str) -> None:
    """Puts a version of a cloud in the queue, of which two parts do not fit one frame."""
    for name in names:
        points = np.zeros(WINDOW_BYTES // 4, np.float32)
        updates = {"points": points, "cloud": ("cloud", version, len(names))}
        queue.push(wire.SceneNodeUpdateMessage(name, updates))


def test_what_is_small_goes_before_what_is_large_and_was_queued_before() -> None:
    queue = Queue()
    for name in ("/a", "/b", "/c"):
        queue.cloud(name)
    queue.push(wire.SetPositionMessage("/robot", (1.0, 0.0, 0.0)))
    assert queue.window() == ["/robot", "/a"]
    queue.push(wire.SetPositionMessage("/robot", (2.0, 0.0, 0.0)))
    assert queue.window() == ["/robot", "/b"]


def test_large_messages_share_a_frame_while_there_is_room() -> None:
    queue = Queue()
    for index in range(20):
        queue.cloud(f"/{index}", WINDOW_BYTES // 4 // 8)
    assert [len(queue.window()) for _ in range(4)] == [8, 8, 4, 0]


def test_large_messages_take_turns_however_fast_newer_ones_come() -> None:
    queue = Queue()
    seen = []
    for _ in range(9):
        for name in ("/a", "/b", "/c"):
            queue.cloud(name)
        seen += queue.window()
    assert seen == ["/a", "/b", "/c"] * 3


def test_a_cloud_that_was_begun_is_finished_before_the_newest_is_sent() -> None:
    queue = Queue()
    seen = []
    for version in range(7):
        with_parts(queue, version, "abcd")
        queue.cloud("/map")
        seen += queue.versions()
    assert seen == ["a0", "b0", "c0", "d0", "/map", "a5", "b5"]
    while queue.outbox.is_waiting():
        seen += queue.versions()
    assert seen[7:] == ["c5", "d5", "/map", "a6", "b6", "c6", "d6"]
    assert queue.outbox.progress.begun == {}


def test_of_a_cloud_that_was_begun_and_removed_nothing_more_is_sent() -> None:
    queue = Queue()
    with_parts(queue, 0, "abc")
    assert queue.versions() == ["a0"]
    with_parts(queue, 1, "abc")
    queue.live.clear()
    assert queue.versions() == []
    assert not queue.outbox.is_waiting()
    assert queue.outbox.progress.begun == {}


def test_what_was_removed_or_replaced_is_not_sent() -> None:
    queue = Queue()
    for name in ("/a", "/b"):
        queue.cloud(name)
    assert queue.window() == ["/a"]
    queue.live.clear()
    assert queue.window() == []
    assert not queue.outbox.is_waiting()


def test_the_question_whether_all_arrived_is_asked_after_all() -> None:
    queue = Queue()
    for name in ("/a", "/b"):
        queue.cloud(name)
    queue.push(Marker("1"))
    sent = [queue.window()]
    queue.cloud("/a")
    sent += [queue.window(), queue.window(), queue.window()]
    assert sent == [["/a"], ["/b", "Marker"], ["/a"], []]


def test_a_cloud_that_grows_and_shrinks_is_whole_in_parts_that_are_sent_apart(
    scene: ViserScene,
) -> None:
    for count in (3, 2 * PART + 1, 5, PART + 5):
        xyz = np.arange(3 * count, dtype=np.float32).reshape(-1, 3)
        colors = np.zeros((count, 3), np.uint8)
        scene.upsert("lidar", "it", Points(xyz, colors, 0.1))
        scene.flush()
        clouds = [
            message
            for message in scene.link._buffer.message_from_id.values()
            if isinstance(message, wire.SceneNodeUpdateMessage) and "points" in message.updates
        ]
        clouds.sort(key=lambda message: message.name)
        assert (np.concatenate([cloud.updates["points"] for cloud in clouds]) == xyz).all()
        assert sum(len(np.atleast_2d(cloud.updates["colors"])) for cloud in clouds) >= count
        assert max(map(bulk, clouds)) <= WINDOW_BYTES
        assert len(clouds) <= 3


def test_a_stalled_browser_gets_the_newest_change_of_the_panel_before_the_cloud(
    scene: ViserScene, call: Callable[..., Any]
) -> None:
    peer = call()
    peer.replay()
    colors = np.zeros((40 * PART, 3), np.uint8)
    for index in range(3):
        scene.upsert("lidar", "it", Points(np.full((40 * PART, 3), index, np.float32), colors, 0.1))
        scene.set_pose("robot", Pose((float(index), 0.0, 0.0)))
        scene.flush()
    seen: list[dict[str, Any]] = []
    while [2.0, 0.0, 0.0] not in [m.get("position") for m in seen]:
        seen += peer.receive()
    assert sum("points" in m.get("updates", {}) for m in seen) < 40


def test_a_connection_holds_little_that_nothing_can_overtake(
    scene: ViserScene, call: Callable[..., Any]
) -> None:
    call().replay()
    (connection,) = scene.link._socket._live_connections.values()
    sock = connection.transport.get_extra_info("socket")
    # Linux counts its own bookkeeping, for which it doubles what it was asked for.
    assert sock.getsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF) <= 2 * SEND_BUFFER_BYTES
    assert sock.getsockopt(socket.IPPROTO_TCP, socket.TCP_NOTSENT_LOWAT) == UNSENT_BYTES
