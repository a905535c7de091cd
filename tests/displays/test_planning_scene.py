"""The scenes of MoveIt."""

from __future__ import annotations

import time
from typing import Any, ClassVar

import numpy as np
import octrees
import pytest
from built_in_checks import BuiltInChecks
from display_scenes import OTHER_LINKS
from inspecting import Benches
from moveit_scenes import moveit
from robot_arm import ARM, describe, is_loaded, wait

from webviz import Topic
from webviz.api.nodes import Instances, Mesh
from webviz.data.messages import encode
from webviz.shell.testing import DisplayBench, check_details
from webviz_displays.moveit import PlanningScene
from webviz_displays.moveit.properties import SceneGeometry

SCENE = "moveit_msgs/msg/PlanningScene"
TOPIC = "/monitored_planning_scene"
NAN = float("nan")
UNTURNED = {"w": 1.0}
ADD, REMOVE, APPEND, MOVE = range(4)


def at(x: float = 0.0, y: float = 0.0, z: float = 0.0) -> dict[str, Any]:
    return {"position": {"x": x, "y": y, "z": z}, "orientation": UNTURNED}


def box(name: str, x: float = 0.0, frame: str = "map", **more: Any) -> dict[str, Any]:
    """A cube of 0.2 m."""
    cube = {"type": 1, "dimensions": [0.2, 0.2, 0.2]}
    header = {"frame_id": frame}
    return {"id": name, "header": header, "pose": at(x), "primitives": [cube]} | more


def scene(*objects: dict[str, Any], **more: Any) -> dict[str, Any]:
    return {"world": {"collision_objects": list(objects)}} | more


def state(frame: str = "map", *attached: dict[str, Any], **positions: float) -> dict[str, Any]:
    joints = {"name": list(positions), "position": list(positions.values())}
    objects = list(attached)
    return {
        "joint_state": joints | {"header": {"frame_id": frame}},
        "attached_collision_objects": objects,
        "is_diff": True,
    }


def attachment(link: str, thing: dict[str, Any]) -> dict[str, Any]:
    return {"link_name": link, "object": thing}


def tell(bench: DisplayBench, values: dict[str, Any]) -> None:
    bench.send(SCENE, values, topic=TOPIC)
    bench.turn()
    bench.turn()


@pytest.fixture
def world(bench: Benches) -> DisplayBench:
    at_once = SceneGeometry(scene_display_time=0.0001)
    return bench(
        PlanningScene(robot_description=Topic("/robot_description"), scene_geometry=at_once)
    )


@pytest.fixture
def arm(world: DisplayBench) -> DisplayBench:
    """Return a world with the robot, whose wrist is known."""
    describe(world, ARM)
    tell(world, {"name": "cell", "robot_state": state(wrist=0.0)})
    return world


def boxes(bench: DisplayBench, key: str = "object box") -> list[float]:
    """Return where boxes are along x."""
    for name, node in bench.nodes().items():
        if name.startswith(key):
            x = bench.poses()[name].position[0]
            return sorted(round(x + each, 3) for each in node.positions[:, 0].tolist())
    return []


def test_every_kind_of_shape_is_drawn(world: DisplayBench) -> None:
    shapes = [(1, [1.0, 2.0, 3.0]), (2, [0.5]), (3, [2.0, 0.25]), (4, [3.0, 0.5])]
    triangle = {"vertices": np.eye(3), "triangles": np.array([[0, 1, 2]], np.uint32)}
    thing = {
        "id": "all",
        "header": {"frame_id": "map"},
        "pose": at(1.0) | {"orientation": {"z": 0.6, "w": 0.8}},
        "primitives": [{"type": kind, "dimensions": sizes} for kind, sizes in shapes],
        "primitive_poses": [at(0.0, 1.0)],
        "meshes": [triangle, triangle],
        "mesh_poses": [at(), at(0.0, 0.0, 2.0)],
        "planes": [{"coef": [0.0, 0.0, 2.0, -2.0]}],
    }
    tell(world, scene(thing))
    nodes, poses = world.nodes(), world.poses()
    solids = {key: node for key, node in nodes.items() if isinstance(node, Instances)}
    kinds = {node.shape: node for node in solids.values()}
    np.testing.assert_allclose(kinds["box"].scales, [(1, 2, 3), (10, 10, 0.002)], rtol=1e-6)
    np.testing.assert_allclose(kinds["sphere"].scales, [(1, 1, 1)])
    np.testing.assert_allclose(kinds["cylinder"].scales, [(0.5, 0.5, 2)])
    np.testing.assert_allclose(kinds["cone"].scales, [(1, 1, 3)])
    # The object is turned by 2 atan(0.6 / 0.8) about z, so its y axis is (-0.96, 0.28, 0).
    np.testing.assert_allclose(kinds["box"].positions[0], (0.04, 0.28, 0), atol=1e-6)
    np.testing.assert_allclose(kinds["box"].positions[1], (1, 0, 1), atol=1e-6)
    [mesh] = [key for key, node in nodes.items() if isinstance(node, Mesh)]
    assert nodes[mesh].faces.tolist() == [[0, 1, 2], [3, 4, 5]]
    assert nodes[mesh].vertices[5].tolist() == [0.0, 0.0, 3.0]
    assert poses[mesh].wxyz == pytest.approx((0.8, 0, 0, 0.6))
    assert world.statuses()["Scene"] == ("OK", "1 object.")


def test_messages_with_changes_add_move_extend_and_remove_objects(world: DisplayBench) -> None:
    tell(world, scene(box("a"), box("b", 1.0)))
    assert boxes(world) == [0.0, 1.0]
    tell(world, scene(box("c", 2.0), box("a", operation=REMOVE), is_diff=True))
    assert boxes(world) == [1.0, 2.0]
    tell(world, scene({**box("b", 5.0), "primitives": [], "operation": MOVE}, is_diff=True))
    assert boxes(world) == [2.0, 5.0]
    more = box("b", operation=APPEND, primitive_poses=[at(0.5)])
    tell(world, scene(more, is_diff=True))
    assert boxes(world) == [2.0, 5.0, 5.5]
    tell(world, scene(box("d", 7.0)))
    assert boxes(world) == [7.0]
    tell(world, scene({"operation": REMOVE}, is_diff=True))
    assert boxes(world) == []
    assert world.statuses()["Scene"] == ("OK", "0 objects.")


def test_colors_of_objects_override_those_of_the_display(world: DisplayBench) -> None:
    red = {"id": "b", "color": {"r": 1.0, "a": 0.5}}
    tell(world, scene(box("a"), box("b", 1.0), object_colors=[red]))
    nodes = [node for key, node in world.nodes().items() if key.startswith("object box")]
    looks = {node.colors: node.opacity for node in nodes}
    assert looks == {
        (50, 230, 50): pytest.approx(0.9, abs=0.01),
        (255, 0, 0): pytest.approx(0.5, abs=0.01),
    }
    bad = {"id": "b", "color": {"r": NAN, "a": 1.0}}
    tell(world, {"is_diff": True, "object_colors": [bad]})
    assert "colour of object 'b'" in world.statuses()["Objects"][1]


def test_the_robot_follows_the_state_of_the_scene(arm: DisplayBench) -> None:
    arm.transform("map", "cell", (3.0, 0.0, 0.0))
    assert arm.statuses()["Joints"] == ("OK", "The positions of 1 joint are known.")
    new_state = state("cell", wrist=1.0)
    new_state["multi_dof_joint_state"] = {
        "joint_names": ["virtual_joint"],
        "transforms": [{"translation": {"x": 2.0}, "rotation": UNTURNED}],
    }
    tell(arm, {"is_diff": True, "robot_state": new_state})
    assert arm.poses()["base visual visual_0"].position == pytest.approx((5.0, 0.0, 0.0))
    assert arm.poses()["tool visual grip"].wxyz == pytest.approx((np.cos(0.5), np.sin(0.5), 0, 0))
    tell(arm, {"is_diff": True, "robot_state": state("cell", elbow=1.0)})
    level, text = arm.statuses()["Joints"]
    assert (level, "no joint 'elbow'" in text) == ("WARN", True)


def test_attached_objects_move_with_their_link(arm: DisplayBench) -> None:
    tell(arm, scene(box("cup", 4.0), is_diff=True))
    cup = box("cup", frame="tool", pose=at(0.0, 0.0, 1.0))
    tell(arm, {"is_diff": True, "robot_state": state("map", attachment("tool", cup), wrist=np.pi)})
    assert boxes(arm) == []
    [node] = [node for key, node in arm.nodes().items() if key.startswith("attached")]
    np.testing.assert_allclose(node.positions, [(0, 0, -1)], atol=1e-6)
    assert node.colors == (150, 50, 150)
    assert arm.statuses()["Scene"][1] == "'cell': 0 objects, 1 attached."
    gone = attachment("tool", {"id": "cup", "operation": REMOVE})
    tell(arm, {"is_diff": True, "robot_state": state("map", gone, wrist=np.pi)})
    assert boxes(arm) == [0.0]


def test_objects_are_placed_by_frames_of_links_objects_and_transforms(arm: DisplayBench) -> None:
    arm.transform("map", "table", (6.0, 0.0, 0.0))
    shelf = box("shelf", 1.0, subframe_names=["top"], subframe_poses=[at(0.5)])
    things = [box("on", 0.25, "shelf/top"), shelf, box("b", 0.0, "table"), box("c", 2.0, "base")]
    tell(arm, scene(*things, box("d", frame="nowhere"), is_diff=True))
    assert boxes(arm) == [1.0, 1.75, 2.0, 6.0]
    level, text = arm.statuses()["Object frames"]
    assert (level, "'d' in 'nowhere'" in text) == ("ERROR", True)
    arm.transform("map", "nowhere", (9.0, 0.0, 0.0))
    arm.turn()
    assert 9.0 in boxes(arm)
    assert "Object frames" not in arm.statuses()


def test_a_scene_without_transform_or_robot_has_a_status(world: DisplayBench) -> None:
    world.turn()
    assert world.statuses()["Scene"][1].startswith(f"No planning scene received on {TOPIC}.")
    tell(world, scene(box("a", frame="world"), robot_state=state("world")))
    assert world.statuses()["Transform"][0] == "ERROR"
    assert world.statuses()["URDF"][0] == "WARN"
    world.transform("map", "world", (1.0, 0.0, 0.0))
    world.turn()
    assert boxes(world) == [1.0]


def test_the_earlier_scene_is_requested_from_move_group(world: DisplayBench) -> None:
    tell(world, scene(box("b", 1.0), box("old", operation=REMOVE), is_diff=True))
    service = "moveit_msgs/srv/GetPlanningScene"
    whole = scene(box("a"), box("b", 9.0), box("old", 7.0), name="cell")
    world.serve("/arm/get_planning_scene", service, {"scene": whole})
    world.set("move_group_namespace", "/arm")
    world.turn()
    world.turn()
    world.settle()  # a thread reads the answer
    assert boxes(world) == [0.0, 1.0]
    assert "'cell': 2 objects" in world.statuses()["Scene"][1]
    tell(world, scene(box("c", 3.0)))
    assert boxes(world) == [3.0]


@pytest.mark.parametrize(
    ("thing", "why"),
    [
        ({"primitives": [{"type": 1, "dimensions": [1.0]}]}, "a box has invalid dimensions"),
        ({"primitives": [{"type": 2, "dimensions": [NAN]}]}, "a sphere has invalid dimensions"),
        ({"primitives": [{"type": 2, "dimensions": [1e308]}]}, "a sphere has invalid"),
        ({"primitives": [{"type": 5}]}, "prisms are not supported"),
        ({"primitives": []}, "has no shapes"),
        ({"pose": at(NAN)}, "has an invalid pose"),
        ({"pose": at(1e308)}, "has an invalid pose"),
        ({"primitive_poses": [at(NAN)]}, "1 pose cannot be drawn"),
        ({"planes": [{"coef": [0.0, 0.0, 0.0, 1.0]}]}, "1 plane without a valid normal"),
        (
            {"meshes": [{"vertices": np.eye(3), "triangles": np.array([[0, 1, 3]], np.uint32)}]},
            "1 triangle with",
        ),
        ({"operation": 77}, "unknown operation 77"),
        ({"operation": MOVE}, "cannot be moved"),
        ({"id": "x" * 1_000_000}, "has 1000000 characters"),
    ],
)
def test_invalid_objects_are_reported_and_the_rest_drawn(
    world: DisplayBench, thing: dict[str, Any], why: str
) -> None:
    tell(world, scene(box("good", 1.0), {**box("bad", 2.0), **thing}))
    world.settle()
    level, text = world.statuses()["Objects"]
    assert (level, why in text, len(text) < 500) == ("WARN", True, True)
    assert 1.0 in boxes(world)


def test_objects_without_end_are_bounded(
    world: DisplayBench, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz_displays.moveit.scene.MAX_BYTES", 5000)
    monkeypatch.setattr("webviz_displays.moveit.scene.MAX_NAMES", 10)
    for first in range(0, 40, 4):
        tell(world, scene(*(box(str(first + i), float(i)) for i in range(4)), is_diff=True))
    assert len(boxes(world)) == 4
    assert "take more than" in world.statuses()["Objects"][1]


def test_the_display_time_holds_the_robot_until_the_next_round(arm: DisplayBench) -> None:
    arm.set("scene_geometry.scene_display_time", 10.0)
    first = arm.poses()["tool visual grip"].wxyz
    arm.send(SCENE, {"is_diff": True, "robot_state": state(wrist=2.0)}, topic=TOPIC)
    for _ in range(3):
        arm.turn(3.0)
        assert arm.poses()["tool visual grip"].wxyz == first
    arm.turn(3.0)
    assert arm.poses()["tool visual grip"].wxyz[0] == pytest.approx(np.cos(1.0))


def test_the_robot_is_where_the_scene_has_it_once_time_stands_still(arm: DisplayBench) -> None:
    arm.set("scene_geometry.scene_display_time", 1e6)
    first = arm.poses()["tool visual grip"].wxyz
    arm.send(SCENE, {"is_diff": True, "robot_state": state(wrist=2.0)}, topic=TOPIC)
    arm.turn(1.0)
    assert arm.poses()["tool visual grip"].wxyz == first
    arm.turn()
    assert arm.poses()["tool visual grip"].wxyz[0] == pytest.approx(np.cos(1.0))


def test_the_octomap_is_drawn_as_boxes_where_it_is(world: DisplayBench) -> None:
    tree = octrees.full(octrees.octree([(0, 0, 0), (2, 0, 0)]), resolution=0.5)
    world.transform("map", "camera", (1.0, 0.0, 0.0))
    placed = {"header": {"frame_id": "camera"}, "origin": at(2.0), "octomap": tree}
    tell(world, {"world": {"octomap": placed}})
    world.settle()
    assert boxes(world, "octomap") == [3.25, 4.25]
    assert world.nodes()["octomap"].opacity == 0.9
    assert world.statuses()["Octomap"] == ("OK", "Showing 2 voxels of 2.")
    tell(world, scene(box("a"), is_diff=True))
    assert boxes(world, "octomap") == [3.25, 4.25]
    bad = placed | {"octomap": tree | {"data": [1, 2, 3]}}
    tell(world, {"world": {"octomap": bad}, "is_diff": True})
    world.settle()
    assert world.statuses()["Octomap"][0] == "ERROR"
    cleared = {"octomap": {"id": "cleared"}}
    tell(world, {"world": {"octomap": cleared}, "is_diff": True})
    assert boxes(world, "octomap") == []


def test_an_unreadable_urdf_is_named(world: DisplayBench) -> None:
    world.send("std_msgs/msg/String", {"data": "<robot"}, topic="/robot_description")
    wait(world, lambda: is_loaded(world))
    assert world.statuses()["URDF"][0] == "ERROR"


def test_the_frame_loop_leaves_a_large_scene_to_threads(world: DisplayBench) -> None:
    many = encode(SCENE, scene(*(box(str(n), float(n % 100)) for n in range(4000))))
    in_loop_s, everything_s = time.thread_time(), time.process_time()
    world.send_bytes(SCENE, many, TOPIC)
    world.turn()
    world.settle()
    in_loop_s, everything_s = time.thread_time() - in_loop_s, time.process_time() - everything_s
    assert len(boxes(world)) == 4000
    assert in_loop_s < everything_s / 2


def test_objects_that_follow_each_other_backwards_are_placed_at_once(world: DisplayBench) -> None:
    chain = [box(f"o{number}", 1.0, f"o{number + 1}") for number in range(3000)]
    before_s = time.thread_time()
    tell(world, scene(*chain, box("o3000")))
    world.settle()
    assert time.thread_time() - before_s < 3.0
    assert sorted(boxes(world))[-1] == 3000.0
    tell(world, scene(*chain))
    world.settle()
    assert "3000 objects in an unknown frame" in world.statuses()["Object frames"][1]


def test_a_hand_holds_a_limited_number_of_objects(
    world: DisplayBench, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz_displays.moveit.scene.MAX_HELD", 3)
    things = [attachment("base", box(str(number), frame="base")) for number in range(4)]
    tell(world, {"robot_state": state("map", *things)})
    text = world.statuses()["Objects"][1]
    assert text == "Only the first 3 attached objects are kept."
    assert "3 attached" in world.statuses()["Scene"][1]


class TestPlanningScene(BuiltInChecks):
    display = PlanningScene
    scene = moveit
    later = ("move_group_namespace",)
    elsewhere = ("scene_geometry.scene_display_time",)
    values: ClassVar = {"scene_robot.links": OTHER_LINKS}


def test_selecting_object_of_a_planning_scene(bench: Benches) -> None:
    """The coloured one, drawn by itself, as its opacity differs."""
    at = bench(PlanningScene())
    moveit(at)
    check_details(at.pick("object box 0.502", 0), "Object 'door'", {"Shapes": "1 box"})
