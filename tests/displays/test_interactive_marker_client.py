"""The protocol of interactive markers: what is followed, waits, and is sent, without ROS."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from webviz import Axes, Context, Error, Frames, Group, Hit, Instances, Labels, Level, Pose
from webviz.api.connection import ReceivedMessages
from webviz.api.handles import Drag, DragKind, Handle
from webviz.data.messages import decode, encode, interfaces
from webviz.data.transforms import TransformBuffer
from webviz_displays.interactive_markers import InteractiveMarkers
from webviz_displays.interactive_markers import client as protocol
from webviz_displays.interactive_markers import server as known_server
from webviz_displays.interactive_markers.client import (
    ANSWER_S,
    MAX_WAITING,
    PAUSE_S,
    SLOW_BYTES,
    Client,
)
from webviz_displays.interactive_markers.completion import Completed, completed
from webviz_displays.interactive_markers.drawing import AXES_RADIUS, MarkerLook
from webviz_displays.interactive_markers.feedback import (
    BUTTON_CLICK,
    MENU_SELECT,
    MOUSE_DOWN,
    MOUSE_UP,
    POSE_UPDATE,
    FeedbackQueue,
)
from webviz_displays.interactive_markers.feedback import KEEP_ALIVE as STAYS
from webviz_displays.interactive_markers.reading import (
    MAX_MARKERS,
    SERVICE,
    UPDATE,
    News,
    read_update,
)
from webviz_displays.interactive_markers.server import MAX_IGNORED, InteractiveMarkerServer
from webviz_displays.interactive_markers.tracked import Place, Tracked

KEEP_ALIVE, CHANGE = 0, 1
MENU, BUTTON, MOVE_AXIS, ROTATE_AXIS = 1, 2, 3, 5
MARKER = "visualization_msgs/msg/InteractiveMarker"


class Replies:
    """Server side of a client: recorded requests and prepared answers."""

    clock_s = 0.0
    node = "/webviz"

    def __init__(self) -> None:
        interfaces.service(SERVICE)  # declares its messages
        self.endpoints: frozenset[bytes] = frozenset({b"first"})
        self.is_ready, self.has_gap = True, False
        self.messages: list[bytes] = []
        self.requests: list[Future[bytes]] = []
        self.jobs: list[tuple[Future[Any], Callable[[], Any]]] = []

    def listen(self, topic: str, type: str, depth: int) -> ReceivedMessages:
        messages, self.messages = tuple(self.messages), []
        publishers = ("/server",) * len(self.endpoints)
        return ReceivedMessages(messages, publishers, self.endpoints, self.is_ready, self.has_gap)

    def query(
        self, service: str, type: str, timeout_s: float, request: Mapping[str, Any] | None = None
    ) -> Future[bytes]:
        assert (service, type, timeout_s) == ("/arm/get_interactive_markers", SERVICE, ANSWER_S)
        assert request is None
        self.requests.append(Future())
        return self.requests[-1]

    def advertise(self, topic: str, type: str, depth: int) -> str:
        return ""

    def publish(self, topic: str, values: Mapping[str, Any]) -> None: ...

    def run(self, fn: Callable[..., Any], *args: Any) -> Future[Any]:
        self.jobs.append((job := Future(), lambda: fn(*args)))
        return job

    def wake(self) -> None: ...

    def work(self) -> None:
        """Do the first job of the worker."""
        job, fn = self.jobs.pop(0)
        if job.set_running_or_notify_cancel():
            job.set_result(fn())

    def update(self, number: int, kind: int = CHANGE, size: int = 0) -> None:
        erases = [f"at {number}", *["x" * size] * bool(size)]
        values = {"seq_num": number, "type": kind, "erases": erases}
        self.messages.append(encode(UPDATE, values))

    def answer(self, number: int, *names: str) -> None:
        values = {"sequence_number": number, "markers": [{"name": name} for name in names]}
        self.requests[-1].set_result(encode(f"{SERVICE}_Response", values))


@pytest.fixture
def server() -> Replies:
    return Replies()


@pytest.fixture
def client(server: Replies) -> Client:
    """One that has asked."""
    client = Client("/arm")
    client.step(server)
    return client


def erased(news: Sequence[News]) -> list[str]:
    return [name for each in news for name in each.erased if not name.startswith("x")]


def all_of(news: Sequence[News]) -> list[str]:
    """The names of the markers that replace all others."""
    assert news[0].is_all
    return list(news[0].markers)


def test_updates_that_the_answer_includes_are_not_applied_again(
    server: Replies, client: Client
) -> None:
    for number in (3, 4, 5, 6):
        server.update(number)
    assert client.step(server) == []
    server.answer(4, "a")
    news = client.step(server)
    assert all_of(news) == ["a"]
    assert erased(news) == ["at 5", "at 6"]
    assert (client.state, client.sequence, client.gaps) == ("running", 6, 0)
    server.update(6)  # later, it is a gap
    assert client.step(server) == []
    assert (client.state, client.gaps) == ("searching", 1)


def test_a_server_is_queried_once_it_publishes_and_at_a_limited_rate(server: Replies) -> None:
    client = Client("/arm")
    server.is_ready = False
    client.step(server)
    assert not server.requests
    server.is_ready = True
    client.step(server)
    server.answer(4)
    client.step(server)
    server.has_gap = True  # messages were dropped
    client.step(server)
    assert (client.state, len(server.requests)) == ("searching", 1)
    server.has_gap = False
    server.clock_s += PAUSE_S
    client.step(server)
    server.clock_s += PAUSE_S
    server.requests[-1].set_exception(Error("It did not answer."))
    assert client.step(server) == []
    assert client.status(0).text == "It did not answer."
    for count in (2, 3):
        client.step(server)
        assert len(server.requests) == count
        server.clock_s += PAUSE_S


def test_updates_that_wait_are_bounded_by_bytes(
    server: Replies, client: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(protocol, "MAX_WAITING_BYTES", 10_000)
    for number in (1, 2):
        server.update(number, size=5000)
    server.clock_s += PAUSE_S
    client.step(server)
    assert len(server.requests) == 2


def test_keep_alives_are_not_updates(server: Replies, client: Client) -> None:
    server.answer(4)
    server.update(4, KEEP_ALIVE)
    server.update(5)
    server.update(5, KEEP_ALIVE)
    assert erased(client.step(server)) == ["at 5"]
    assert (client.state, client.gaps) == ("running", 0)
    server.update(7)
    assert erased(client.step(server)) == []
    assert (client.state, client.gaps) == ("searching", 1)


def test_a_restarted_server_is_queried_again(server: Replies, client: Client) -> None:
    server.answer(4, "old")
    client.step(server)
    server.endpoints = frozenset({b"second"})
    server.clock_s += 1.0
    assert client.step(server) == []
    server.answer(0, "new")
    assert all_of(client.step(server)) == ["new"]
    assert client.sequence == 0
    # One that ends while it is asked takes its markers along.
    server.update(9)
    client.step(server)
    server.endpoints = frozenset()
    news = client.step(server)
    assert all_of(news) == []
    assert client.step(server) == []


def test_an_undecodable_answer_is_requested_again(server: Replies, client: Client) -> None:
    server.requests[-1].set_result(b"\0\1\0\0\7")
    assert client.step(server) == []
    assert client.problem
    server.clock_s += 1.0
    client.step(server)
    server.answer(1, "a")
    assert all_of(client.step(server)) == ["a"]


def test_large_messages_are_read_in_a_worker_and_all_others_wait_for_them(
    server: Replies, client: Client
) -> None:
    server.update(3)
    server.update(4, KEEP_ALIVE)
    server.answer(4, "a", "x" * SLOW_BYTES)
    assert client.step(server) == []
    assert "Loading the markers" in client.status(0).text
    server.update(5)
    assert client.step(server) == []
    server.work()
    news = client.step(server)
    assert all_of(news) == ["a", "x" * 1000]
    assert erased(news) == ["at 5"]

    server.update(6, size=SLOW_BYTES)
    server.update(7)
    assert client.step(server) == []
    server.update(7, KEEP_ALIVE)
    server.update(8, size=SLOW_BYTES)
    server.update(9)
    assert client.step(server) == []
    assert len(server.jobs) == 1
    server.work()
    assert erased(client.step(server)) == ["at 6", "at 7"]
    server.work()
    assert erased(client.step(server)) == ["at 8", "at 9"]
    assert (client.state, client.sequence, client.gaps) == ("running", 9, 0)

    # What a server that ended has sent is not read any more.
    server.update(10, size=SLOW_BYTES)
    client.step(server)
    server.endpoints = frozenset({b"second"})
    server.clock_s += 1.0
    client.step(server)
    server.work()
    assert client.step(server) == []
    server.answer(0, "b")
    assert all_of(client.step(server)) == ["b"]
    server.update(1, size=SLOW_BYTES)
    client.step(server)
    server.jobs.pop(0)[0].cancel()  # as when the display is hidden
    server.update(2)
    assert client.step(server) == []
    assert (client.state, client.gaps) == ("searching", 1)


def test_updates_that_cannot_be_read_or_are_too_many_are_reported(
    server: Replies, client: Client
) -> None:
    server.answer(0, "a")
    client.step(server)
    server.messages.append(b"\0\1\0\0\7")
    assert client.step(server) == []
    assert client.status(1).level is Level.WARN
    assert "An update cannot be read" in client.status(1).text
    server.update(1)
    assert erased(client.step(server)) == ["at 1"]
    assert client.status(1).text == "Connected to /arm, 1 marker."

    server.endpoints = frozenset({b"second"})
    server.clock_s += 1.0
    client.step(server)
    for number in range(1, MAX_WAITING + 2):
        server.update(number)
    server.clock_s += 1.0
    client.step(server)
    assert len(server.requests) == 3
    server.answer(MAX_WAITING + 1, "b")
    server.update(MAX_WAITING + 2)
    assert erased(client.step(server)) == [f"at {MAX_WAITING + 2}"]


def test_sequences_that_jump_back_or_wrap_are_gaps(server: Replies, client: Client) -> None:
    last = 2**64 - 1
    for before, after in ((7, 3), (last, 0), (7, 7), (0, last)):
        server.answer(before, "a")
        assert all_of(client.step(server)) == ["a"]
        server.update(after)
        server.update(after + 1 if after < last else 0)
        assert erased(client.step(server)) == []
        assert f"Update {after} came instead of {before + 1}." in client.status(1).text
        server.clock_s += 1.0
        client.step(server)
    assert client.gaps == 4


def news_of(**values: Any) -> News:
    news = read_update(encode(UPDATE, {"type": CHANGE, **values})).news
    assert news
    return news


def test_markers_names_and_remarks_of_a_server_are_bounded() -> None:
    marker_server = InteractiveMarkerServer("/arm", "webviz")
    marker_server.take([news_of(markers=[{"name": f"{n}"} for n in range(MAX_MARKERS + 20)])])
    assert (len(marker_server.markers), marker_server.left_out) == (MAX_MARKERS, 20)
    marker_server.take([news_of(markers=[{"name": "0"}, {"name": "more"}])])
    assert (len(marker_server.markers), marker_server.left_out) == (MAX_MARKERS, 21)
    marker_server.take([news_of(poses=[{"name": f"{n}"} for n in range(-MAX_IGNORED - 5, 0)])])
    assert (len(marker_server.ignored), marker_server.left_out) == (MAX_IGNORED, 26)
    marker_server.take([news_of(erases=["-1005", "0", "0", "ghost"])])
    assert (len(marker_server.ignored), len(marker_server.markers)) == (
        MAX_IGNORED - 1,
        MAX_MARKERS - 1,
    )
    far = [{"name": "1", "pose": {"position": {"x": math.nan}}}]
    marker_server.take([news_of(erases=list(marker_server.ignored)), news_of(poses=far)])
    assert marker_server.ignored == {
        "1": "Its new pose is not finite, or too large. Correct the server."
    }
    marker_server.take([news_of(poses=[{"name": "1"}])])
    assert not marker_server.ignored  # once a pose is good
    marker_server.take([news_of(poses=far)])
    marker_server.take([News(is_all=True)])
    assert (marker_server.markers, marker_server.ignored, marker_server.left_out) == ({}, {}, 0)
    marker_server.take(
        [news_of(markers=[{"name": "n" * 100_000}], poses=[{"name": "p" * 100_000}])]
    )
    assert marker_server.markers == {}
    assert max(map(len, marker_server.ignored)) <= 1000
    assert "has 100000 characters; the limit is 1000" in next(iter(marker_server.ignored.values()))


def test_the_contents_of_all_markers_are_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(known_server, "MAX_BYTES", 30_000)

    def line(name: str, points: int) -> dict[str, Any]:
        shape = {"type": 4, "points": [{}] * points}
        return {"name": name, "controls": [{"markers": [shape]}]}

    marker_server = InteractiveMarkerServer("/arm", "webviz")
    marker_server.take([news_of(markers=[line("a", 1000), line("b", 1000)])])
    assert marker_server.markers.keys() == {"a"}
    assert marker_server.ignored.keys() == {"b"}
    marker_server.take([news_of(markers=[line("a", 100), line("b", 1000)])])
    assert marker_server.markers.keys() == {"a", "b"}
    assert not marker_server.ignored
    marker_server.take([news_of(erases=["b"]), news_of(markers=[line("c", 1000)])])
    assert marker_server.markers.keys() == {"a", "c"}


def test_many_markers_are_redrawn_over_several_ticks(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(known_server, "DRAWING_S", -1.0)  # one at a time
    marker_server, around = InteractiveMarkerServer("/arm", "webviz"), frames("map")

    def box(name: str, x: float) -> dict[str, Any]:
        solid = {"color": {"a": 1.0}}
        line = {"type": 5, "points": [{"x": math.nan}, {}], **solid}
        shapes = [{"type": 1, **solid}, line]
        header, at = {"frame_id": "map"}, {"position": {"x": x}}
        return {"name": name, "header": header, "pose": at, "controls": [{"markers": shapes}]}

    def draw() -> dict[str, float]:
        """Draw; where each box is, by the key of its marker."""
        ctx = Context(around, lambda *_, **__: None, None)
        marker_server.draw(MarkerLook(titles=False, axes=False, is_transparent=True), ctx)
        boxes = [group for group in ctx.groups.values() if "box" in " ".join(group.nodes)]
        assert all("line" not in " ".join(group.nodes) for group in boxes)
        return {
            key.rpartition("/")[0].partition("/")[2]: group.placement.offset.position[0]
            for group in boxes
            for key in group.nodes
            if key.startswith("c0/")
        }

    marker_server.take([news_of(markers=[box("a", 1.0), box("b", 2.0), box("c", 3.0)])])
    assert (draw(), marker_server.undrawn) == ({"m1": 1.0}, 2)
    marker_server.take([news_of(markers=[box("a", 5.0)])])
    assert (draw(), marker_server.undrawn) == ({"m1": 1.0, "m2": 2.0}, 2)
    assert (draw(), marker_server.undrawn) == ({"m1": 1.0, "m2": 2.0, "m3": 3.0}, 1)
    assert (draw(), marker_server.undrawn) == ({"m1": 5.0, "m2": 2.0, "m3": 3.0}, 0)


def test_shapes_in_frames_of_their_own_are_looked_for_when_transforms_come() -> None:
    marker_server, around = InteractiveMarkerServer("/arm", "webviz"), frames("map")
    own = {"type": 1, "header": {"frame_id": "tool"}, "color": {"a": 1.0}}
    values = {"name": "a", "header": {"frame_id": "map"}, "controls": [{"markers": [own]}]}
    marker_server.take([news_of(markers=[values])])
    look = MarkerLook(titles=False, axes=False, is_transparent=True)

    def draw() -> None:
        now = Frames(around.buffer, "map", 0)
        marker_server.draw(look, Context(now, lambda *_, **__: None, None))

    draw()
    server_marker = marker_server.by_name["a"]
    assert marker_server.is_waiting
    assert "tool" in server_marker.transform_error
    frame = server_marker.drawn_in
    draw()
    assert server_marker.drawn_in == frame  # nothing is new
    around.buffer.set_transform("map", "tool", 0, (1.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0), True)
    draw()
    assert not server_marker.transform_error
    assert not marker_server.is_waiting


def tracked(stamp: int) -> Tracked:
    values = {"name": "a", "header": {"frame_id": "hand", "stamp": {"sec": stamp}}}
    marker = completed(decode(MARKER, encode(MARKER, values)))
    assert isinstance(marker, Completed)
    return Tracked("m1", marker)


def frames(fixed: str) -> Frames:
    buffer = TransformBuffer()
    for parent, child, x in (("map", "odom", 1.0), ("odom", "hand", 2.0)):
        buffer.set_transform(parent, child, 0, (x, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0), is_static=True)
    return Frames(buffer, fixed, 0)


def test_a_stamped_marker_moves_with_the_fixed_frame() -> None:
    marker = tracked(stamp=1)
    for fixed, x in (("map", 3.0), ("odom", 2.0), ("map", 3.0)):
        place = marker.place(frames(fixed))
        assert place
        assert (place.frame, place.stamp_ns, place.pose.position) == (fixed, 0, (x, 0.0, 0.0))
        assert marker.place(frames(fixed)) is place


def test_a_pose_of_the_server_waits_for_the_end_of_a_drag_once() -> None:
    marker, around = tracked(stamp=0), frames("hand")
    marker.press()
    expected = Place("hand", 0, Pose((7.0, 0.0, 0.0)))
    marker.put(expected)
    assert marker.drag("", Pose((1.0, 0.0, 0.0)), 0.0, around)
    assert marker.pose.position[0] == 1.0
    marker.release()
    assert marker.source == expected
    marker.press()
    assert marker.drag("", Pose((2.0, 0.0, 0.0)), 0.0, around)
    version = marker.version
    marker.release()  # nothing waits any more
    assert (marker.pose.position[0], marker.version) == (2.0, version)


def test_only_changes_of_a_marker_are_drawn_and_sent() -> None:
    marker, around = tracked(stamp=0), frames("hand")
    marker.press()
    turned = marker.content.pose
    assert not marker.drag("x", turned, 0.0, around)
    assert marker.drag("x", turned, 1.0, around)
    assert not marker.drag("x", turned, 1.0, around)
    marker.release()
    version = marker.version
    marker.put(marker.source)
    assert marker.version == version
    marker.update(marker.content)  # which has no control x
    assert marker.turned == {}


def test_only_successive_poses_of_one_control_replace_each_other() -> None:
    def message(event: int, marker: str, control: str, x: float) -> dict[str, Any]:
        return {"event_type": event, "marker_name": marker, "control_name": control, "x": x}

    queue = FeedbackQueue()
    feedback = [
        message(POSE_UPDATE, "a", "x", 1.0),
        message(POSE_UPDATE, "a", "y", 2.0),
        message(POSE_UPDATE, "b", "y", 3.0),
        message(MOUSE_DOWN, "b", "y", 4.0),
        message(MOUSE_DOWN, "b", "y", 5.0),
        message(POSE_UPDATE, "b", "y", 6.0),
    ]
    for each in feedback:
        queue.add(each)
    queue.add(message(POSE_UPDATE, "b", "y", 7.0))
    results = [each["x"] for each in iter(queue.next, None)]
    assert results == [1.0, 2.0, 3.0, 4.0, 5.0, 7.0]


class MarkerBench:
    """A display with one marker of a server, which records what is sent to it."""

    def __init__(
        self, server: Replies, display: Mapping[str, Any] | None = None, **values: Any
    ) -> None:
        self.display = InteractiveMarkers(interactive_markers_namespace="/arm", **(display or {}))
        self.state, self.connection, self.around = self.display.new_state(), server, frames("map")
        self.display.communicate(server, self.context())
        cdr = encode(MARKER, {"name": "a", "header": {"frame_id": "odom"}, **values})
        marker = completed(decode(MARKER, cdr))
        assert isinstance(marker, Completed)
        self.marker_server.take([News(markers={"a": marker})])

    @property
    def marker_server(self) -> InteractiveMarkerServer:
        assert self.state.server
        return self.state.server

    def context(self, fixed: str = "map") -> Context:
        here = Frames(self.around.buffer, fixed, 0)
        return Context(here, lambda *_, **__: None, self.state)

    def handle(self, fixed: str = "map") -> Handle:
        return self.display.handles(self.context(fixed))["m1"]

    def groups(self) -> Mapping[str, Group]:
        """Draw; what follows a frame, by key."""
        ctx = self.context()
        self.display.draw_all((), ctx)
        return {key.rpartition("|")[2]: group for key, group in ctx.groups.items()}

    def drag(
        self, kind: DragKind, x: float | None = None, **values: Any
    ) -> list[tuple[int, float]]:
        """Do it; the events that the server gets, and where the marker is in them."""
        pose = None if x is None else Pose((x, 0.0, 0.0))
        self.display.drag(Drag("m1", 0, kind, pose, **values), self.connection, self.context())
        outgoing = self.marker_server.outgoing
        feedback = list(iter(outgoing.next, None))
        return [(each["event_type"], each["pose"]["position"]["x"]) for each in feedback]


def test_a_gesture_is_reported_to_the_server_event_by_event(server: Replies) -> None:
    marker_bench = MarkerBench(server, controls=[{"interaction_mode": MOVE_AXIS}])
    assert marker_bench.drag("move", 5.0) == []  # without a press
    assert marker_bench.drag("press") == [(POSE_UPDATE, 0.0), (MOUSE_DOWN, 0.0)]
    assert marker_bench.drag("move", 1.0, turned=0.5) == [(POSE_UPDATE, 1.0)]
    assert marker_bench.drag("move", 1.0, turned=0.5) == []
    assert marker_bench.handle().controls[0].turned == 0.5
    assert marker_bench.drag("hold") == [(STAYS, 1.0)]
    assert marker_bench.drag("release", 2.0) == [(POSE_UPDATE, 2.0), (MOUSE_UP, 2.0)]
    assert marker_bench.drag("hold", 7.0) == [(STAYS, 2.0)]

    button = MarkerBench(server, controls=[{"interaction_mode": BUTTON}])
    assert button.drag("press", 3.0) == [(POSE_UPDATE, 0.0), (MOUSE_DOWN, 0.0)]
    clicked = [(BUTTON_CLICK, 0.0), (POSE_UPDATE, 0.0), (MOUSE_UP, 0.0)]
    assert button.drag("release") == clicked
    menu = [{"id": 4, "title": "Go"}, {"id": 5, "title": "rm", "command_type": 1}]
    chosen = MarkerBench(server, controls=[{"interaction_mode": MENU}], menu_entries=menu)
    assert chosen.drag("choose", entry=4) == [(MENU_SELECT, 0.0)]
    assert chosen.drag("choose", entry=5) == []
    still = MarkerBench(server, controls=[{"interaction_mode": 0}])
    assert still.drag("press") == []


def test_a_release_without_a_press_moves_nothing(server: Replies) -> None:
    marker_bench = MarkerBench(server, controls=[{"interaction_mode": MOVE_AXIS}])
    assert marker_bench.drag("release", 5.0) == [(POSE_UPDATE, 0.0), (MOUSE_UP, 0.0)]


def test_the_point_under_the_pointer_is_that_of_presses_and_clicks(
    server: Replies,
) -> None:
    marker_bench = MarkerBench(server, controls=[{"interaction_mode": MOVE_AXIS}])
    drags = (
        Drag("m1", 0, "press", point=(1.0, 2.0, 3.0)),
        Drag("m1", 0, "move", Pose((4.0, 0, 0))),
    )
    for drag in drags:
        marker_bench.display.drag(
            replace(drag, point=(1.0, 2.0, 3.0)), server, marker_bench.context()
        )
    messages = list(iter(marker_bench.marker_server.outgoing.next, None))
    assert [each["mouse_point_valid"] for each in messages] == [False, True, False]


def test_a_server_is_known_as_long_as_its_namespace_is_that_of_the_display(
    server: Replies,
) -> None:
    marker_bench = MarkerBench(server)
    before = marker_bench.marker_server
    marker_bench.display.communicate(server, marker_bench.context())
    assert marker_bench.marker_server is before


def test_a_marker_that_is_picked_is_inspected(server: Replies) -> None:
    controls = [{"interaction_mode": MOVE_AXIS, "markers": [{"type": 1, "color": {"a": 1.0}}]}]
    marker_bench = MarkerBench(server, description="An arm", controls=controls)
    node = marker_bench.groups()["m1"].nodes["c0/m1/box"]

    def inspect(key: str) -> Any:
        hit = Hit(key, node, 0, (0.0, 0.0, 0.0), "odom", ())
        return marker_bench.display.inspect(hit, marker_bench.context())

    whole = {"Marker": "a", "Description": "An arm", "Scale": 1.0}
    control = {"Control": "(no name)", "Interaction": "move axis"}
    pose = {"Pose in odom": Pose()}
    assert inspect("c0/m1/box").values == whole | control | pose
    assert inspect("c1/m1/box").values == whole | pose  # it has one control less than before
    assert inspect("title/m1").values == whole | pose
    assert inspect("c0/m9/box") is None


def test_axes_are_as_long_as_the_marker_and_only_texts_have_a_ball_to_grip(
    server: Replies,
) -> None:
    solid = {"type": 1, "color": {"a": 1.0}}
    controls = [{"interaction_mode": BUTTON, "markers": [solid]}]
    nodes = (
        MarkerBench(server, {"show_axes": True}, scale=2.0, controls=controls).groups()["m1"].nodes
    )
    assert "c0/m1/drag" not in nodes
    axes = nodes["axes/m1"]
    assert isinstance(axes, Axes)
    assert (axes.length, axes.radius) == (2.0, 2.0 * AXES_RADIUS)
    assert (axes.positions.tolist(), axes.wxyzs.tolist()) == ([[0, 0, 0]], [[1, 0, 0, 0]])


def test_a_title_is_above_its_marker_in_the_size_of_the_marker(server: Replies) -> None:
    marker_bench = MarkerBench(server, {"show_descriptions": True}, scale=2.0, description="An arm")
    title = marker_bench.groups()["m1.title"].nodes["title/m1"]
    assert isinstance(title, Labels)
    assert (title.texts, title.height) == (("An arm",), pytest.approx(0.3))
    np.testing.assert_allclose(title.positions, [(0.0, 0.0, 2.8)])


def test_without_transparency_all_that_is_visible_is_opaque(server: Replies) -> None:
    shapes = [{"type": 1, "color": {"a": alpha}} for alpha in (0.0, 0.25)]
    controls = [{"interaction_mode": BUTTON, "markers": shapes}]
    for is_transparent, opacity in ((True, 0.25), (False, 1.0)):
        display = {"enable_transparency": is_transparent}
        nodes = MarkerBench(server, display, controls=controls).groups()["m1"].nodes
        (box,) = (node for key, node in nodes.items() if "/box" in key)
        assert isinstance(box, Instances)
        assert len(box.positions) == 1
        assert box.opacity == pytest.approx(opacity, abs=0.01)


def test_a_fixed_control_turns_about_its_own_axis(server: Replies) -> None:
    shapes = [{"type": 1, "color": {"a": 1.0}}]
    control = {"orientation_mode": 1, "interaction_mode": ROTATE_AXIS, "markers": shapes}
    up = {"w": math.sqrt(0.5), "y": -math.sqrt(0.5)}
    for orientation, axis in (({"w": 1.0}, (1.0, 0.0, 0.0)), (up, (0.0, 0.0, 1.0))):
        marker_bench = MarkerBench(server, controls=[{"orientation": orientation, **control}])
        assert marker_bench.groups()["m1.0"].placement.offset.wxyz == (1.0, 0.0, 0.0, 0.0)
        marker_bench.drag("press")
        marker_bench.drag("move", 0.0, turned=0.5)
        expected = [math.cos(0.25), *(math.sin(0.25) * each for each in axis)]
        assert marker_bench.groups()["m1.0"].placement.offset.wxyz == pytest.approx(expected)


def test_a_marker_has_a_handle_once_its_transform_has_come() -> None:
    marker_server, around = InteractiveMarkerServer("/arm", "webviz"), frames("map")
    header = {"frame_id": "tool", "stamp": {"sec": 1}}
    marker_server.take([news_of(markers=[{"name": "a", "header": header}])])
    assert marker_server.handles(around, aids=True, refusal="") == {}
    around.buffer.set_transform("map", "tool", 0, (1.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0), True)
    result = marker_server.handles(Frames(around.buffer, "map", 0), aids=True, refusal="")
    assert [(each.name, each.frame) for each in result.values()] == [("a", "map")]


def test_handles_are_replaced_only_when_something_changes(server: Replies) -> None:
    marker_bench = MarkerBench(server, controls=[{"interaction_mode": MOVE_AXIS}])
    marker_bench.marker_server.markers["a"].put(Place("hand", 5, Pose()))
    first = marker_bench.handle()
    assert marker_bench.display.handles(marker_bench.context()) is marker_bench.display.handles(
        marker_bench.context()
    )
    assert (first.frame, first.refusal, marker_bench.handle("hand").frame) == ("map", "", "hand")
    marker_bench.state.refusal = "Read-only."
    assert marker_bench.handle().refusal == "Read-only."


def test_shapes_turn_with_the_marker_or_apart_from_it(server: Replies) -> None:
    solid = {"type": 1, "color": {"a": 1.0}}
    text = {"type": 9, "text": "four\nno", "scale": {"z": 0.5}, "color": {"a": 1.0}}
    shapes = {"interaction_mode": BUTTON, "markers": [solid, text]}
    across = {"w": math.sqrt(0.5), "z": math.sqrt(0.5)}
    facings = [{"orientation_mode": facing, **shapes} for facing in (0, 1, 2)]
    facings.append({"independent_marker_orientation": True, **facings[2]})
    marker_bench = MarkerBench(server, controls=facings, pose={"orientation": across})
    groups = marker_bench.groups()
    assert groups.keys() == {"m1", "m1.1", "m1.2v"}
    turned = {key: group.placement.offset.wxyz[3] for key, group in groups.items()}
    assert turned == pytest.approx({"m1": math.sqrt(0.5), "m1.1": 0.0, "m1.2v": 0.0})
    assert {"c0/m1/box", "c3/m1/box"} <= groups["m1"].nodes.keys()
    ball = groups["m1"].nodes["c0/m1/drag"]  # around the text
    assert isinstance(ball, Instances)
    np.testing.assert_allclose(ball.scales, [(1.0, 1.0, 0.5)])


def test_a_hidden_marker_is_an_error_and_an_incomplete_one_a_warning(
    server: Replies, monkeypatch: pytest.MonkeyPatch
) -> None:
    # A busy machine would draw some of them in the next round.
    monkeypatch.setattr("webviz_displays.interactive_markers.server.DRAWING_S", math.inf)
    marker_bench = MarkerBench(server, controls=[{}])
    there, nowhere = {"header": {"frame_id": "map"}}, {"frame_id": "nowhere"}
    late = {**nowhere, "stamp": {"sec": 9}}
    markers = [
        {"name": "refused", "scale": math.nan},
        {"name": "frameless"},
        {"name": "late", "header": late, "controls": [{}]},
        {"name": "lost", "header": nowhere, "controls": [{}]},
        {"name": "strange", **there, "controls": [{"markers": [{"type": 99}]}]},
        {"name": "odd", **there, "controls": [{}, {"interaction_mode": 10}]},
        {"name": "bare", **there},
        {"name": "fixed", "header": {**late, "frame_id": "odom"}, "controls": [{}]},
    ]
    marker_bench.marker_server.take([news_of(markers=markers)])
    marker_bench.groups()
    ctx = marker_bench.context()
    marker_bench.display.tick(ctx)
    levels = {key: status.level for key, status in ctx.statuses.items() if key != "Server"}
    hidden = dict.fromkeys(("refused", "frameless", "late", "lost", "strange"), Level.ERROR)
    lacking = dict.fromkeys(("odd", "bare"), Level.WARN)
    assert levels == {"a": Level.OK, "fixed": Level.OK, **hidden, **lacking}
    assert ctx.statuses["a"].text == "Locked to frame odom."
    assert ctx.statuses["fixed"].text == "Position is fixed."


def test_feedback_has_the_newest_stamp_of_the_frame_of_a_marker(server: Replies) -> None:
    marker_bench = MarkerBench(
        server, header={"frame_id": "cart"}, controls=[{"interaction_mode": MOVE_AXIS}]
    )
    assert marker_bench.drag("press") == []  # its frame is unknown
    at = (0.0, 0.0, 0.0)
    for stamp_ns in (3_000_000_001, 5_000_000_002):
        marker_bench.around.buffer.set_transform("map", "cart", stamp_ns, at, (0.0, 0.0, 0.0, 1.0))
    marker_bench.display.drag(
        Drag("m1", 0, "press", point=(1.0, 2.0, 3.0)), server, marker_bench.context()
    )
    move, down = iter(marker_bench.marker_server.outgoing.next, None)
    for each in (move, down):
        assert each["header"] == {"stamp": {"sec": 5, "nanosec": 2}, "frame_id": "cart"}
    assert (move["mouse_point_valid"], down["mouse_point_valid"]) == (False, True)
    assert down["mouse_point"] == {"x": 1.0, "y": 2.0, "z": 3.0}


def test_feedback_in_the_fixed_frame_has_no_stamp(server: Replies) -> None:
    marker_bench = MarkerBench(
        server, header={"frame_id": "map"}, controls=[{"interaction_mode": MOVE_AXIS}]
    )
    marker_bench.display.drag(Drag("m1", 0, "press"), server, marker_bench.context())
    for each in iter(marker_bench.marker_server.outgoing.next, None):
        assert each["header"] == {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": "map"}
    assert marker_bench.marker_server.outgoing.next() is None
