"""Interactive markers: the protocol over DDS, and what is filled in."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
import trimesh

from webviz import Level
from webviz.api.handles import Grip, Handle
from webviz.data.messages import decode, encode
from webviz.engine.commands import GripHandle, Sender
from webviz.shell.testing import LiveViewer
from webviz_displays.interactive_markers import InteractiveMarkers
from webviz_displays.interactive_markers.completion import Completed, completed, unique_names
from webviz_displays.interactive_markers.menus import can_choose, menu_of

pytest.importorskip("rclpy", reason="a live viewer needs rclpy")

from basic_controls import Control, add, basic_controls, box, marker
from geometry_msgs.msg import Pose
from marker_server import Feedback, MarkerServer
from visualization_msgs.msg import InteractiveMarkerPose, InteractiveMarkerUpdate

MARKER = "visualization_msgs/msg/InteractiveMarker"
NAN = math.nan


def made(**values: Any) -> Completed | str:
    """A marker as its message is completed."""
    return completed(decode(MARKER, encode(MARKER, values)))


def part(**control: Any) -> Any:
    result = made(scale=2.0, controls=[control])
    assert isinstance(result, Completed)
    return result.parts[0]


def test_controls_without_markers_get_handles_in_the_size_and_colour_of_ros() -> None:
    arrows = part(interaction_mode=Control.MOVE_AXIS).shapes
    assert [each.tolist() for each in (arrows.contents[0].points, arrows.contents[1].points)] == [
        [[1.0, 0.0, 0.0], [1.8, 0.0, 0.0]],
        [[-1.0, 0.0, 0.0], [-1.8, 0.0, 0.0]],
    ]
    np.testing.assert_allclose(arrows.scales[0], (0.3, 0.5, 0.4))
    np.testing.assert_allclose(arrows.colors[0], (1.0, 0.0, 0.0, 0.5))

    up = {"w": math.sqrt(0.5), "y": math.sqrt(0.5)}
    ring = part(interaction_mode=Control.ROTATE_AXIS, orientation=up).shapes
    content = ring.contents[0]
    assert (content.points.shape, content.colors.shape) == ((216, 3), (72, 4))
    np.testing.assert_allclose(ring.scales[0], 2.0)
    radii = np.hypot(content.points[:, 1], content.points[:, 2])
    assert sorted(set(radii.round(6).tolist())) == [0.5, 0.65]
    assert not content.points[:, 0].any()
    np.testing.assert_allclose(
        content.colors[[0, 2]], [(0, 0, 0.6, 0.5), (0, 0, 1, 0.5)], atol=1e-6
    )

    title = part(interaction_mode=Control.MENU, description="Options")
    assert (title.control.facing, title.shapes.contents[0].text) == ("view_facing", "Options")
    np.testing.assert_allclose(title.shapes.positions[0], (-0.05, 0.0, 2.35))
    for mode in (0, 2, 7, 8, 9):
        assert len(part(interaction_mode=mode).shapes) == 0


def test_what_messages_leave_out_is_filled_in() -> None:
    result = made(controls=[{"orientation": {"w": 0.0}, "markers": [{"type": 1}]}, {}, {}])
    assert isinstance(result, Completed)
    assert (result.scale, result.parts[0].control.wxyz) == (1.0, (1.0, 0.0, 0.0, 0.0))
    assert [each.control.name for each in result.parts] == ["", "_u0", "_u1"]
    assert result.parts[0].shapes.scales.tolist() == [[1.0, 1.0, 1.0]]
    arrow = {"type": 0, "scale": {"x": 0.1}, "points": [{}, {"x": 1.0}]}
    assert part(markers=[arrow]).shapes.scales.tolist() == [[0.1, 1.0, 0.0]]
    assert list(unique_names(["a", "a", "a_u0", "a"])) == ["a", "a_u0", "a_u0_u1", "a_u2"]


def test_invalid_markers_and_controls_say_what_is_wrong() -> None:
    for values in ({"scale": NAN}, {"pose": {"position": {"x": math.inf}}}):
        assert made(**values) == "Its pose or scale is not finite. Correct the server."
    bad = [
        ({"interaction_mode": 10}, "unknown interaction mode, 10"),
        ({"orientation_mode": 3}, "unknown orientation mode, 3"),
        ({"orientation": {"x": NAN}}, "not finite"),
        ({"markers": [{}] * 2001}, "the limit is 2000"),
    ]
    for control, problem in bad:
        result = made(controls=[{}, control])
        assert isinstance(result, Completed)
        assert len(result.parts) == 1
        assert problem in result.problems[0]


def entries(*rows: tuple[int, int, str, int]) -> list[Any]:
    values = [
        {"id": id, "parent_id": parent, "title": title, "command_type": kind}
        for id, parent, title, kind in rows
    ]
    return decode(MARKER, encode(MARKER, {"menu_entries": values})).menu_entries


def test_menus_are_nested_checked_and_free_of_shell_commands() -> None:
    menu, problems = menu_of(
        entries((1, 0, "[x]On", 0), (2, 0, "More", 1), (3, 2, "[ ] Off", 0), (4, 0, "rm", 1))
    )
    assert [(each.title, each.is_checked) for each in menu] == [
        ("On", True),
        ("More", None),
        ("rm", None),
    ]
    assert [(each.title, each.is_checked) for each in menu[1].entries] == [("Off", False)]
    assert not problems
    assert [can_choose(menu, id) for id in (1, 2, 3, 4, 5)] == [True, False, True, False, False]

    menu, problems = menu_of(entries((2, 3, "early", 0), (3, 0, "late", 0), (3, 0, "twice", 0)))
    assert [each.id for each in menu] == [3]
    assert [text.split(".")[0] for text in problems] == [
        "Menu entry 2 precedes its parent 3",
        "The menu has an invalid or repeated id, 3",
    ]
    menu, problems = menu_of(entries(*((n, n - 1, "", 0) for n in range(1, 2000))))
    assert "1000 of its 1999" in problems[0]


@pytest.fixture
def serve(webviz_domain: int) -> Iterator[Callable[..., MarkerServer]]:
    """Start servers; those that run at the end are closed."""
    servers: list[MarkerServer] = []

    def serve(namespace: str = "/arm", *markers: Any) -> MarkerServer:
        servers.append(MarkerServer(namespace, webviz_domain, markers))
        return servers[-1]

    yield serve
    for server in servers:
        server.close()


def handles(viewer: LiveViewer) -> dict[str, Handle]:
    """By the name of their marker."""
    return {handle.name: handle for handle, _ in viewer.viewer.snapshot().handles.values()}


def position(viewer: LiveViewer, key: str) -> list[float]:
    """Where the box of a marker is, nothing while it is hidden; keys count all markers."""
    found = viewer.nodes().get(f"c0/{key}/box")
    return list(found[0].position) if found else []


def boxed(name: str, x: float = 0.0, frame: str = "map") -> Any:
    made = marker(name, x, 0.0, frame)
    add(made, Control.MOVE_PLANE, shapes=True)
    return made


def status(viewer: LiveViewer, key: str = "Server") -> str:
    rows = viewer.viewer.snapshot().rows
    found = rows[0].statuses.get(key)
    return found.text if found else ""


def connected(viewer: LiveViewer, count: int) -> None:
    viewer.wait_for(
        lambda: f", {count} marker" in status(viewer) and len(handles(viewer)) == count,
        lambda: status(viewer),
    )


def test_updates_are_applied_in_order_and_gaps_ask_again(
    webviz_viewer: Callable[..., LiveViewer], serve: Callable[..., MarkerServer]
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
    server.apply(lost=True)
    pose = Pose()
    pose.position.y = 5.0
    server.set_pose("a", pose)
    server.apply()
    viewer.wait_for(lambda: handles(viewer).keys() == {"a"}, lambda: status(viewer))
    assert server.requests == 2
    viewer.wait_for(lambda: position(viewer, "m1")[:2] == [0.0, 5.0], "the newest pose")
    viewer.wait_for(lambda: "after 1 gap" in status(viewer), lambda: status(viewer))

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


def test_faulty_servers_are_reported_and_the_rest_is_shown(
    webviz_viewer: Callable[..., LiveViewer], serve: Callable[..., MarkerServer]
) -> None:
    viewer = webviz_viewer(InteractiveMarkers(interactive_markers_namespace="/arm"))
    bad, lost = boxed("bad"), boxed("lost", frame="nowhere")
    bad.pose.position.x = NAN
    server = serve("/arm", boxed("good"), bad, lost, marker("empty", 0.0, 0.0, "map"))
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
    for made, data in ((mesh, trimesh.creation.box().export(file_type="stl")), (broken, b"no")):
        (shape,) = made.controls[0].markers
        shape.type, shape.mesh_resource = 10, "embedded://file.stl"
        shape.mesh_file.filename, shape.mesh_file.data = "file.stl", data
        server.insert(made)
    server.apply()
    viewer.wait_for(lambda: "file.stl" in status(viewer, "broken"), lambda: status(viewer))
    viewer.wait_for(lambda: any(key.startswith("c0/m5/") for key in viewer.nodes()), "the mesh")
    assert status(viewer, "mesh") == "Locked to frame map."
    assert not any(key.startswith("c0/m6/") for key in viewer.nodes())


def test_feedback_is_that_of_rviz_and_poses_of_the_server_wait_for_the_release(
    webviz_viewer: Callable[..., LiveViewer], serve: Callable[..., MarkerServer]
) -> None:
    from webviz import Pose as At

    viewer = webviz_viewer(InteractiveMarkers(interactive_markers_namespace="/arm"))
    viewer.transform("map", "hand", (10.0, 0.0, 0.0))
    stamped = boxed("stamped", frame="hand")
    stamped.header.stamp.sec = 1
    server = serve("/arm", boxed("moved", 1.0, "hand"), stamped)
    connected(viewer, 2)
    display = viewer.viewer.snapshot().rows[0].id

    def grip(key: str, kind: Any, browser: int = 1, **more: Any) -> Any:
        command = GripHandle(display, Grip(key, 0, kind, **more))
        return viewer.viewer.enqueue(command, Sender(browser))

    def received(count: int) -> list[Feedback]:
        viewer.wait_for(
            lambda: len(server.feedback) == count,
            lambda: str([each.event_type for each in server.feedback]),
        )
        return server.feedback

    grip("m1", "press", point=(1.0, 0.0, 0.2)).result(30)
    back = Pose()
    back.position.x = 7.0
    server.set_pose("moved", back)
    server.apply()
    with pytest.raises(Exception, match="browser 1 holds it"):
        grip("m1", "press", browser=2).result(30)
    grip("m1", "move", pose=At((2.0, 0.0, 0.0))).result(30)
    viewer.wait_for(lambda: position(viewer, "m1")[0] == 12.0, "the drag")
    received(3)
    grip("m1", "release", pose=At((3.0, 0.0, 0.0))).result(30)
    feedback = received(5)
    assert [each.event_type for each in feedback] == [1, 4, 1, 1, 5]
    assert [each.pose.position.x for each in feedback] == [1.0, 1.0, 2.0, 3.0, 3.0]
    assert [each.mouse_point_valid for each in feedback] == [False, True, False, False, False]
    assert {each.header.frame_id for each in feedback} == {"hand"}

    grip("m2", "press")
    grip("m2", "release", pose=At((11.0, 5.0, 0.0)))
    last = received(9)[-1]
    assert (last.header.frame_id, last.header.stamp.sec) == ("map", 0)
    assert (last.pose.position.x, last.pose.position.y) == (11.0, 5.0)
    for wrong in (math.inf, NAN, 1e300):
        grip("m1", "press").result(30)
        with pytest.raises(Exception, match="not finite"):
            grip("m1", "move", pose=At((wrong, 0.0, 0.0))).result(30)
        grip("m1", "release").result(30)
    with pytest.raises(Exception, match="does not exist"):
        grip("m9", "press").result(30)


def test_the_scene_of_the_tutorials_is_shown_as_a_whole(
    webviz_viewer: Callable[..., LiveViewer], serve: Callable[..., MarkerServer]
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
    assert viewer.viewer.snapshot().rows[0].level is Level.OK
