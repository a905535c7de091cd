"""A browser on a poor network: small things first, the newest of large ones, nothing piles up."""

from __future__ import annotations

import contextlib
import math
import socket
import threading
import time
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from viser import _messages as wire
from viser_internals import live_connections, message_buffer

from tests.scene.conftest import Peer, View
from tests.support.slow_link import SlowLink
from webviz.api.nodes import Image, Points, Pose
from webviz.scene import ViserScene
from webviz.scene.adapter.acknowledging import AcknowledgementRequest
from webviz.scene.points import PART
from webviz.server.channel.links import reduced
from webviz.server.http.listener import SEND_BUFFER_BYTES, UNSENT_BYTES
from webviz.server.sending.congestion import CongestionControl, InFlightWindow
from webviz.server.sending.outbox import WINDOW_BYTES, Outbox, bulk
from webviz.server.sending.pieces import Piece

PLENTY = 1e9
SLOW = 1e6


class Queue:
    """The messages there are, as viser's buffer holds them."""

    def __init__(self, rate: float = PLENTY) -> None:
        self.live: dict[int, Any] = {}
        self.now = 100.0
        self.congestion = CongestionControl(rate, lambda: self.now)
        self.outbox = Outbox(AcknowledgementRequest, self.congestion)
        self.count = 0

    def push(self, message: Any) -> None:
        key = message.redundancy_key()
        self.live = {n: m for n, m in self.live.items() if m.redundancy_key() != key}
        self.live[self.count] = message
        self.count += 1

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
        messages = self.outbox.small(self.live, self.count - 1, None)
        return messages + self.outbox.large(self.live)


def with_parts(queue: Queue, version: int, names: str) -> None:
    """Put a version of a cloud in the queue, of which two parts do not fit one frame."""
    for name in names:
        points = np.zeros(WINDOW_BYTES // 4, np.float32)
        updates = {"points": points, "cloud": ("cloud", version, len(names))}
        queue.push(wire.SceneNodeUpdateMessage(name, updates))


def test_small_messages_go_before_large_ones_queued_earlier() -> None:
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
    observed = []
    for _ in range(9):
        for name in ("/a", "/b", "/c"):
            queue.cloud(name)
        observed += queue.window()
    assert observed == ["/a", "/b", "/c"] * 3


def test_a_cloud_that_was_begun_is_finished_before_the_newest_is_sent() -> None:
    queue = Queue()
    observed = []
    for version in range(7):
        with_parts(queue, version, "abcd")
        queue.cloud("/map")
        observed += queue.versions()
    assert observed == ["a0", "b0", "c0", "d0", "/map", "a5", "b5"]
    while queue.outbox.is_waiting():
        observed += queue.versions()
    assert observed[7:] == ["c5", "d5", "/map", "a6", "b6", "c6", "d6"]
    assert queue.outbox.progress.begun == {}


def test_the_rest_of_a_removed_cloud_is_not_sent() -> None:
    queue = Queue()
    with_parts(queue, 0, "abc")
    assert queue.versions() == ["a0"]
    with_parts(queue, 1, "abc")
    queue.live.clear()
    assert queue.versions() == []
    assert not queue.outbox.is_waiting()
    assert queue.outbox.progress.begun == {}


def test_removed_and_replaced_messages_are_not_sent() -> None:
    queue = Queue()
    for name in ("/a", "/b"):
        queue.cloud(name)
    assert queue.window() == ["/a"]
    queue.live.clear()
    assert queue.window() == []
    assert not queue.outbox.is_waiting()


def test_an_acknowledgement_request_is_sent_in_the_end() -> None:
    queue = Queue()
    for name in ("/a", "/b"):
        queue.cloud(name)
    queue.push(AcknowledgementRequest("1"))
    messages = [queue.window()]
    queue.cloud("/a")
    messages += [queue.window(), queue.window(), queue.window()]
    assert messages == [["/a"], ["/b", "AcknowledgementRequest"], ["/a"], []]


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
            for message in message_buffer(scene.link.server).message_from_id.values()
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
    observed: list[dict[str, Any]] = []
    while [2.0, 0.0, 0.0] not in [m.get("position") for m in observed]:
        observed += peer.receive()
    assert sum("points" in m.get("updates", {}) for m in observed) < 40


def test_a_connection_holds_little_that_nothing_can_overtake(
    scene: ViserScene, call: Callable[..., Any]
) -> None:
    call().replay()
    (connection,) = live_connections(scene.link.server).values()
    sock = connection.transport.get_extra_info("socket")
    # Linux counts its own bookkeeping, for which it doubles what it was asked for.
    assert sock.getsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF) <= 2 * SEND_BUFFER_BYTES
    assert sock.getsockopt(socket.IPPROTO_TCP, socket.TCP_NOTSENT_LOWAT) == UNSENT_BYTES


def cloud(count: int) -> dict[str, np.ndarray]:
    """Points whose colours are their numbers."""
    points = np.repeat(np.arange(count, dtype=np.float32)[:, None], 3, axis=1)
    return {"points": points, "colors": points.astype(np.uint8)}


def take_all(queue: Queue, seconds: float = 10.0) -> list[Any]:
    """Return the messages sent meanwhile."""
    messages = []
    until = queue.now + seconds
    while queue.now < until:
        queue.now += 0.01
        messages += queue.outbox.small(queue.live, queue.count - 1, None)
        messages += queue.outbox.large(queue.live)
    return messages


def completed(messages: list[Any]) -> list[tuple[str, dict[str, np.ndarray]]]:
    """Names and properties of all updates, whose pieces are put together as in the page."""
    updates, slots = [], {}
    for message in messages:
        if not isinstance(message, Piece):
            updates.append((message.name, message.updates))
            continue
        slots[message.slot] = (slots[message.slot] if message.start else b"") + message.data
        if message.update is not None:
            data = slots[message.slot]
            assert len(data) == message.size
            values = {
                name: np.frombuffer(data[value["start"] : value["end"]], value["dtype"] or "|u1")
                for name, value in message.update["values"].items()
            }
            updates.append((message.update["name"], values))
    return updates


def test_a_slow_link_gets_fewer_points_of_a_cloud_and_all_of_them_once_it_rests() -> None:
    queue = Queue(SLOW)
    full = cloud(100_000)
    queue.push(wire.SceneNodeUpdateMessage("/lidar", full))
    (_, thin), (_, last) = completed(take_all(queue))
    points = thin["points"].reshape(-1, 3)[:, 0]
    assert len(points) == 100_000 // 8
    assert (points.astype(np.uint8) == thin["colors"].reshape(-1, 3)[:, 0]).all()
    assert len(set((points % 8).tolist())) == 8
    assert (last["points"] == full["points"].ravel()).all()
    assert (last["colors"] == full["colors"].ravel()).all()
    assert not queue.outbox.is_waiting()
    assert queue.congestion.every == 1


def test_scans_and_thinned_clouds_go_on_beside_a_map() -> None:
    queue = Queue(SLOW)
    queue.push(wire.SceneNodeUpdateMessage("/map", {"png": bytes(2_000_000)}))
    messages: list[Any] = []
    for _ in range(50):
        queue.push(wire.SceneNodeUpdateMessage("/lidar", cloud(100_000)))
        queue.push(wire.SceneNodeUpdateMessage("/scan", {"points": np.zeros((1000, 3), "f4")}))
        messages += take_all(queue, 0.1)
    names = [name for name, _ in completed(messages)]
    assert names.count("/scan") >= 30
    assert names.count("/lidar") >= 5
    assert names.count("/map") == 1
    assert (
        max(len(values["points"]) for name, values in completed(messages) if name == "/lidar")
        < 50e3
    )
    assert reduced(queue.congestion) == "Slow link, 8 Mbit/s: clouds show every 8th point"


def image(name: str, size: int, value: int = 0) -> wire.SceneNodeUpdateMessage:
    return wire.SceneNodeUpdateMessage(name, {"png": bytes([value]) * size})


def named(messages: list[Any]) -> list[tuple[str, int]]:
    """The images that are complete, and their values."""
    return [(name, int(values["png"][0])) for name, values in completed(messages)]


def test_pieces_of_four_messages_are_under_way_at_most() -> None:
    queue = Queue(SLOW)
    names = [f"/{number}" for number in range(6)]
    for name in names:
        queue.push(image(name, 400_000))
    messages = take_all(queue)
    assert sorted(name for name, _ in named(messages)) == names
    begun = [(index, piece) for index, piece in enumerate(messages) if piece.start == 0]
    over = [index for index, piece in enumerate(messages) if piece.update]
    under_way = [
        sum(each <= index for each, _ in begun) - sum(each < index for each in over)
        for index, _ in begun
    ]
    assert max(under_way) == 4
    assert {piece.slot for _, piece in begun} == {0, 1, 2, 3}


def test_messages_in_pieces_take_turns() -> None:
    queue = Queue(SLOW)
    for name in ("/a", "/b"):
        queue.push(image(name, 400_000))
    slots = [piece.slot for piece in take_all(queue)]
    assert slots[:8] in ([0, 1] * 4, [1, 0] * 4)


def test_a_message_in_pieces_is_sent_to_its_end_then_the_newest() -> None:
    queue = Queue(SLOW)
    messages = []
    for version in range(6):
        queue.push(image("/map", 1_000_000, version))
        messages += take_all(queue, 0.01)
    messages += take_all(queue)
    assert named(messages) == [("/map", 0), ("/map", 5)]


def test_the_question_whether_all_arrived_follows_the_last_piece() -> None:
    queue = Queue(SLOW)
    queue.push(image("/map", 400_000))
    messages = take_all(queue, 0.05)
    queue.push(AcknowledgementRequest("1"))
    messages += take_all(queue)
    assert isinstance(messages[-1], AcknowledgementRequest)
    assert messages[-2].update is not None


def test_messages_before_an_acknowledgement_request_are_not_thinned() -> None:
    queue = Queue(SLOW)
    queue.push(wire.SceneNodeUpdateMessage("/lidar", cloud(100_000)))
    queue.push(AcknowledgementRequest("1"))
    messages = take_all(queue)
    ((name, updates),) = completed(messages[: messages.index(queue.live[1])])
    assert (name, len(updates["points"]) // 3) == ("/lidar", 100_000)


def test_a_thinned_cloud_is_not_sent_whole_once_there_is_a_newer_one() -> None:
    queue = Queue(SLOW)
    queue.push(wire.SceneNodeUpdateMessage("/lidar", cloud(100_000)))
    messages: list[Any] = []
    while not (messages and isinstance(messages[-1], Piece)):
        messages += take_all(queue, 0.01)  # thinned, then the first piece of the whole
    queue.push(wire.SceneNodeUpdateMessage("/lidar", cloud(90_000)))
    messages += take_all(queue, 0.5)
    assert [len(values["points"]) // 3 for _, values in completed(messages)][:2] == [12_500, 11_250]


def test_a_cloud_that_waits_to_be_sent_whole_is_thinned_if_a_newer_one_comes() -> None:
    queue = Queue(SLOW)
    queue.push(wire.SceneNodeUpdateMessage("/lidar", cloud(100_000)))
    messages: list[Any] = []
    while not messages:
        messages += take_all(queue, 0.01)
    queue.push(AcknowledgementRequest("1"))
    assert queue.outbox.small(queue.live, queue.count - 1, None) == []  # after the whole cloud
    queue.push(wire.SceneNodeUpdateMessage("/lidar", cloud(90_000)))
    messages += take_all(queue, 0.5)
    clouds = [each for each in messages if not isinstance(each, AcknowledgementRequest)]
    assert [len(values["points"]) // 3 for _, values in completed(clouds)][:2] == [12_500, 11_250]


def test_neither_pieces_nor_scans_wait_for_the_others_to_end() -> None:
    queue = Queue(SLOW)
    queue.push(image("/map", 400_000))
    messages: list[Any] = []
    while not any(isinstance(each, Piece) and each.update for each in messages):
        queue.push(wire.SceneNodeUpdateMessage("/scan", {"points": np.zeros((2600, 3), "f4")}))
        messages += take_all(queue, 0.01)
        assert queue.now < 110.0
    assert sum(not isinstance(each, Piece) for each in messages) >= 5


def test_pieces_of_a_node_that_was_removed_are_not_sent() -> None:
    queue = Queue(SLOW)
    queue.push(wire.SceneNodeUpdateMessage("/map", {"png": bytes(2_000_000)}))
    assert take_all(queue, 0.2)
    queue.live.clear()
    assert not take_all(queue, 0.2)
    assert not queue.outbox.is_waiting()


def test_a_fast_link_is_not_throttled() -> None:
    now = [0.0]
    window = InFlightWindow(CongestionControl(None, lambda: now[0]))
    for _ in range(100):
        window.send(1000)
        if (mark := window.end()) is not None:
            now[0] += 0.3  # a busy browser
            window.congestion.acknowledge(mark)
        now[0] += 0.05
    assert window.congestion.rate is None
    assert window.congestion.room() > 0


@contextlib.contextmanager
def driving(scene: ViserScene) -> Iterator[None]:
    """A robot that moves 20 times a second and sends a cloud of 100 000 points each time."""
    random = np.random.default_rng(0)
    clouds = [random.random((100_000, 3), np.float32) for _ in range(3)]
    colors = np.zeros((100_000, 3), np.uint8)
    ended = threading.Event()

    def drive() -> None:
        turn = 0
        while not ended.wait(0.05):
            turn += 1
            scene.upsert("lidar", "it", Points(clouds[turn % 3], colors, 0.1))
            scene.set_pose("robot", Pose((time.monotonic(), 0.0, 0.0)))
            scene.flush()

    robot = threading.Thread(target=drive)
    robot.start()
    try:
        yield
    finally:  # or it would draw in a scene that has ended
        ended.set()
        robot.join()


def test_on_a_link_of_5_mbit_the_pose_stays_fresh_and_the_cloud_is_thinned(
    scene: ViserScene,
) -> None:
    link = SlowLink(scene.link.server.get_port(), 5e6 / 8, 0.1)
    peer = Peer(link)
    channel = scene.link.server.channel
    try:
        peer.replay()
        with driving(scene):
            ages, texts = [], set()
            began, until = time.monotonic(), math.inf
            while (now := time.monotonic()) < until:
                poses = [m["position"][0] for m in peer.receive() if "position" in m]
                (browser,) = channel.browsers()
                congestion = channel.congestion(browser)
                assert congestion is not None
                if congestion.rate is None:  # after two clouds of 0.8 s each, it is known
                    assert now < began + 60.0
                    continue
                if until == math.inf:
                    until = now + 3.0
                if poses and now > until - 2.0:
                    ages.append(time.monotonic() - poses[-1])
                    texts.add(reduced(congestion))
                    assert congestion.in_flight < 5e5
    finally:
        peer.close()
        link.close()
    assert len(ages) > 5
    assert max(ages) < 1.0  # 0.3 s on a quiet machine
    assert any("clouds show every" in text for text in texts)


def test_the_page_puts_pieces_together(view: View) -> None:
    channel = view.scene.link.server.channel
    congestion = channel.congestion(max(channel.browsers()))
    assert congestion is not None
    congestion.rate = SLOW
    cells = np.random.default_rng(0).integers(0, 255, (400, 400, 4), np.uint8)
    cells[200:, :, :] = (200, 100, 50, 255)
    view.scene.upsert("map", "grid", Image(cells, 4.0, 4.0))
    side = np.linspace(-4.0, -1.0, 200, dtype=np.float32)
    xyz = np.stack([*np.meshgrid(side, side), np.zeros((200, 200), np.float32)], -1).reshape(-1, 3)
    colors = np.full((len(xyz), 3), (0, 0, 255), np.uint8)
    view.scene.upsert("lidar", "it", Points(xyz, colors, 0.03))
    view.show()
    view.wait_for(lambda: view.draw(1) or view.color_at((1.0, 3.0, 0.0)) == (200, 100, 50))
    view.wait_for(lambda: view.draw(1) or view.color_at((-2.0, -2.0, 0.0)) == (0, 0, 255))
    congestion.rate = None
