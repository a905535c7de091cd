"""Interactive markers over DDS: the protocol, with a server that follows its rules."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator
from typing import Any

import pytest
import trimesh

from webviz import Level
from webviz.api.handles import Drag, Handle
from webviz.commands import DragHandle
from webviz.engine.commands import Sender
from webviz.shell.testing import LiveViewer
from webviz_displays.interactive_markers import InteractiveMarkers

pytest.importorskip("rclpy", reason="a live viewer needs rclpy")

from basic_controls import Control, add, basic_controls, box, marker
from geometry_msgs.msg import Pose
from marker_server import Feedback, MarkerServer
from several import several
from visualization_msgs.msg import InteractiveMarkerPose, InteractiveMarkerUpdate, MenuEntry

NAN = math.nan
Viewers = Callable[..., LiveViewer]
Serve = Callable[..., MarkerServer]


@pytest.fixture
def serve(webviz_domain: int) -> Iterator[Serve]:
    """Start servers; those that run at the end are closed."""

    def serve(namespace: str = "/arm", *markers: Any) -> MarkerServer:
        return MarkerServer(namespace, webviz_domain, markers)

    with several(serve) as served:
        yield served


def handles(viewer: LiveViewer) -> dict[str, Handle]:
    """Return the handles by the name of their marker."""
    return {handle.name: handle for handle, _ in viewer.viewer.snapshot().handles.values()}


def position(viewer: LiveViewer, key: str) -> list[float]:
    """Return where the box of a marker is, nothing while it is hidden; keys count all markers."""
    nodes = viewer.nodes().get(f"c0/{key}/box")
    return list(nodes[0].position) if nodes else []


def boxed(name: str, x: float = 0.0, frame: str = "map") -> Any:
    interactive_marker = marker(name, x, 0.0, frame)
    add(interactive_marker, Control.MOVE_PLANE, shapes=True)
    return interactive_marker


def status(viewer: LiveViewer, key: str = "Server") -> str:
    rows = viewer.viewer.snapshot().rows
    result = rows[0].statuses.get(key)
    return result.text if result else ""


def connected(viewer: LiveViewer, count: int) -> None:
    viewer.wait_for(
        lambda: f", {count} marker" in status(viewer) and len(handles(viewer)) == count,
        lambda: status(viewer),
    )


def test_updates_are_applied_in_order_and_gaps_ask_again(
    webviz_viewer: Viewers, serve: Serve
) -> None:
    viewer = webviz_viewer(InteractiveMarkers(interactive_markers_namespace="/arm/"))
    viewer.wait_for(lambda: "No interactive marker server at /arm" in status(viewer))
    server = serve("/arm", boxed("a"), boxed("b", 1.0))
    connected(viewer, 2)
    assert server.requests == 1

    pose = Pose()
    pose.position.y = 2.0
    server.set_pose("a", pose)
    server.insert(boxed("c", 3.0))
    server.erase("b")
    server.apply()
    viewer.wait_for(lambda: handles(viewer).keys() == {"a", "c"}, lambda: str(handles(viewer)))
    viewer.wait_for(lambda: position(viewer, "m1")[:2] == [0.0, 2.0], "the new pose")

    server.erase("c")
    server.apply(dropped=True)
    pose = Pose()
    pose.position.y = 5.0
    server.set_pose("a", pose)
    server.apply()
    viewer.wait_for(lambda: handles(viewer).keys() == {"a"}, lambda: status(viewer))
    assert server.requests == 2
    viewer.wait_for(lambda: position(viewer, "m1")[:2] == [0.0, 5.0], "the newest pose")
    viewer.wait_for(lambda: "after 1 gap" in status(viewer), lambda: status(viewer))

    server.close()  # and started again at once, so that its publisher is never missing
    server = serve("/arm", boxed("a"), boxed("x"))
    viewer.wait_for(lambda: handles(viewer).keys() == {"a", "x"}, lambda: status(viewer))
    server.close()
    viewer.wait_for(lambda: "No interactive marker server" in status(viewer))
    viewer.wait_for(lambda: not handles(viewer), "no markers")
    again = serve("/arm", boxed("d"))
    connected(viewer, 1)
    other = serve("/arm")
    viewer.wait_for(lambda: "2 servers share /arm" in status(viewer), lambda: status(viewer))
    for each in (again, other):
        each.close()
    serve("/leg", boxed("e"), boxed("f"))
    viewer.set("interactive_markers_namespace", "/leg")
    connected(viewer, 2)


def test_thousands_of_markers_are_drawn_while_the_frame_loop_goes_on(
    webviz_viewer: Viewers, serve: Serve
) -> None:
    """Each status is one that the loop shows between two turns."""
    count = 3_000
    viewer = webviz_viewer(InteractiveMarkers(interactive_markers_namespace="/arm"))
    server = serve("/arm", *(boxed(f"n{n}", float(n)) for n in range(count)))
    viewer.wait_for(lambda: "Loading the markers" in status(viewer), lambda: status(viewer))
    server.insert(boxed("n8", -8.0))
    server.erase("n7")
    server.apply()
    viewer.wait_for(lambda: "more marker" in status(viewer, "Drawing"), lambda: status(viewer), 120)
    viewer.set("show_visual_aids", True)
    viewer.wait_for(lambda: not status(viewer, "Drawing"), lambda: status(viewer, "Drawing"), 120)
    connected(viewer, count - 1)
    keys = [key.split("/")[1] for key in viewer.nodes() if key.startswith("c0/")]
    assert len(keys) == count - 1
    assert [position(viewer, f"m{n}")[0] for n in (1, 9, count)] == [0.0, -8.0, count - 1.0]


def test_faulty_servers_are_reported_and_the_rest_is_shown(
    webviz_viewer: Viewers, serve: Serve
) -> None:
    viewer = webviz_viewer(InteractiveMarkers(interactive_markers_namespace="/arm"))
    bad, unplaced = boxed("bad"), boxed("lost", frame="nowhere")
    bad.pose.position.x = NAN
    server = serve("/arm", boxed("good"), bad, unplaced, marker("empty", 0.0, 0.0, "map"))
    connected(viewer, 3)
    assert status(viewer, "good") == "Locked to frame map."
    assert "not finite" in status(viewer, "bad")
    assert "nowhere" in status(viewer, "lost")
    assert "no controls" in status(viewer, "empty")
    server.sequence += 1
    unknown = InteractiveMarkerPose(name="ghost")
    server.send(InteractiveMarkerUpdate(seq_num=1, type=1, poses=[unknown], erases=["ghost2"]))
    viewer.wait_for(lambda: "unknown marker" in status(viewer, "ghost"), "the status")
    assert viewer.viewer.snapshot().rows[0].level is Level.ERROR
    server.transform("map", "nowhere", 1.0, 2.0, 3.0)
    viewer.wait_for(lambda: position(viewer, "m2") == [1.0, 2.0, 3.0], "the marker")
    pinned = boxed("pinned", 4.0)
    pinned.controls[0].markers = [box(1.0)]
    pinned.controls[0].markers[0].header.frame_id = "nowhere"
    server.insert(pinned)
    server.apply()
    viewer.wait_for(lambda: "pinned" in handles(viewer), "the marker")
    viewer.wait_for(lambda: position(viewer, "m4")[:2] == [4.0, 0.0], "its group")

    mesh, broken = boxed("mesh"), boxed("broken")
    for interactive_marker, data in (
        (mesh, trimesh.creation.box().export(file_type="stl")),
        (broken, b"no"),
    ):
        (shape,) = interactive_marker.controls[0].markers
        shape.type, shape.mesh_resource = 10, "embedded://file.stl"
        shape.mesh_file.filename, shape.mesh_file.data = "file.stl", data
        server.insert(interactive_marker)
    server.apply()
    viewer.wait_for(lambda: "file.stl" in status(viewer, "broken"), lambda: status(viewer))
    viewer.wait_for(lambda: any(key.startswith("c0/m5/") for key in viewer.nodes()), "the mesh")
    assert status(viewer, "mesh") == "Locked to frame map."
    assert not any(key.startswith("c0/m6/") for key in viewer.nodes())


def test_hostile_updates_leave_a_status_and_the_markers_of_the_server(
    webviz_viewer: Viewers, serve: Serve
) -> None:
    viewer = webviz_viewer(InteractiveMarkers(interactive_markers_namespace="/arm"))
    round_menu = boxed("menu")
    round_menu.menu_entries = [MenuEntry(id=1, parent_id=2), MenuEntry(id=2, parent_id=1)]
    server = serve("/arm", boxed("a"), round_menu)
    server.markers["a again"] = boxed("a", 3.0)
    for number in (0, 7, 2**64 - 1):  # before it has been asked, or a gap if they are late
        server.send(InteractiveMarkerUpdate(seq_num=number, type=1, erases=["a"]))
    connected(viewer, 2)
    assert "2 markers of a message have this name" in status(viewer, "a")
    assert "Menu entry 1 precedes its parent 2" in status(viewer, "menu")
    assert position(viewer, "m1")[0] == 3.0

    server.send(b"\0\1\0\0\7")
    viewer.wait_for(lambda: "An update cannot be read" in status(viewer), lambda: status(viewer))

    def gaps() -> int:
        match = re.search(r"after (\d+) gap", status(viewer))
        return int(match[1]) if match else 0

    def breaks(at: int, number: int) -> None:
        before, requests, server.sequence = gaps(), server.requests, at
        server.send(InteractiveMarkerUpdate(seq_num=number, type=1, erases=["a", "a", "ghost"]))
        viewer.wait_for(lambda: server.requests > requests, lambda: status(viewer))
        viewer.wait_for(lambda: gaps() > before, lambda: status(viewer))
        connected(viewer, 2)

    breaks(5, 9)
    breaks(5, 2)
    breaks(2**64 - 1, 0)
    server.sequence = 0
    server.send(InteractiveMarkerUpdate(seq_num=200, type=1))
    server.close()  # while it is asked, and another one takes its place
    serve("/arm", boxed("b"))
    connected(viewer, 1)


def test_feedback_is_that_of_rviz_and_poses_of_the_server_wait_for_the_release(
    webviz_viewer: Viewers, serve: Serve
) -> None:
    from webviz import Pose as At

    viewer = webviz_viewer(InteractiveMarkers(interactive_markers_namespace="/arm"))
    viewer.transform("map", "hand", (10.0, 0.0, 0.0))
    stamped = boxed("stamped", frame="hand")
    stamped.header.stamp.sec = 1
    server = serve("/arm", boxed("moved", 1.0, "hand"), stamped)
    connected(viewer, 2)
    display = viewer.viewer.snapshot().rows[0].id

    def drag(key: str, kind: Any, browser: int = 1, **more: Any) -> Any:
        command = DragHandle(display, Drag(key, 0, kind, **more))
        return viewer.viewer.enqueue(command, Sender(browser))

    def received(count: int) -> list[Feedback]:
        viewer.wait_for(
            lambda: len(server.feedback) == count,
            lambda: str([each.event_type for each in server.feedback]),
        )
        return server.feedback

    drag("m1", "press", point=(1.0, 0.0, 0.2)).result(30)
    back = Pose()
    back.position.x = 7.0
    server.set_pose("moved", back)
    server.apply()
    with pytest.raises(Exception, match="in use by browser 1"):
        drag("m1", "press", browser=2).result(30)
    drag("m1", "move", pose=At((2.0, 0.0, 0.0))).result(30)
    viewer.wait_for(lambda: position(viewer, "m1")[0] == 12.0, "the drag")
    received(3)
    drag("m1", "release", pose=At((3.0, 0.0, 0.0))).result(30)
    feedback = received(5)
    assert [each.event_type for each in feedback] == [1, 4, 1, 1, 5]
    assert [each.pose.position.x for each in feedback] == [1.0, 1.0, 2.0, 3.0, 3.0]
    assert [each.mouse_point_valid for each in feedback] == [False, True, False, False, False]
    assert {each.header.frame_id for each in feedback} == {"hand"}

    drag("m2", "press")
    drag("m2", "release", pose=At((11.0, 5.0, 0.0)))
    last = received(9)[-1]
    assert (last.header.frame_id, last.header.stamp.sec) == ("map", 0)
    assert (last.pose.position.x, last.pose.position.y) == (11.0, 5.0)
    for wrong in (math.inf, NAN, 1e300):
        drag("m1", "press").result(30)
        with pytest.raises(Exception, match="not finite"):
            drag("m1", "move", pose=At((wrong, 0.0, 0.0))).result(30)
        drag("m1", "release").result(30)
    with pytest.raises(Exception, match="no longer exists"):
        drag("m9", "press").result(30)


def test_the_scene_of_the_tutorials_is_shown_as_a_whole(
    webviz_viewer: Viewers, serve: Serve
) -> None:
    viewer = webviz_viewer(
        InteractiveMarkers(interactive_markers_namespace="/basic"), fixed_frame="base_link"
    )
    server = serve("/basic", *basic_controls())
    server.transform("base_link", "moving_frame", 0.5, 0.0, 0.0)
    connected(viewer, 13)
    modes = {control.mode for handle in handles(viewer).values() for control in handle.controls}
    assert len(modes) == 10
    viewer.wait_for(lambda: status(viewer, "moving") == "Locked to frame moving_frame.", "moving")
    viewer.wait_for(lambda: viewer.viewer.snapshot().rows[0].level is Level.OK, "every status OK")
