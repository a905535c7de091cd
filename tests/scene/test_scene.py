"""The scene sends what changed, all of it, and nothing else."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from several import Make

from webviz.api.nodes import (
    U8,
    Arrows,
    Axes,
    Image,
    Labels,
    Lines,
    Mesh,
    Node,
    Points,
    Pose,
)
from webviz.scene import ViserScene

RED = (255, 0, 0)
SEGMENTS = np.arange(12, dtype=np.float32).reshape(2, 2, 3)
XYZ = np.arange(6, dtype=np.float32).reshape(2, 3)


def image(rgba: U8 | None = None) -> Image:
    return Image(np.zeros((3, 4, 4), np.uint8) if rgba is None else rgba, 4.0, 3.0)


NODES: dict[str, Callable[[], Node]] = {
    "points": lambda: Points(XYZ.copy(), np.zeros((2, 3), np.uint8), 0.1),
    "lines": lambda: Lines(SEGMENTS.copy(), RED, 2.0),
    "arrows": lambda: Arrows(SEGMENTS.copy(), RED, 0.1, 0.2, 0.3),
    "axes": lambda: Axes(XYZ.copy(), np.eye(4, dtype=np.float32)[:2], 1.0, 0.1),
    "labels": lambda: Labels(XYZ.copy(), ("a", "b"), 0.1),
    "mesh": lambda: Mesh(np.eye(3, dtype=np.float32), np.array([[0, 1, 2]], np.uint32), RED),
    "image": image,
}


@pytest.fixture
def message_count(scene: ViserScene) -> Callable[[], int]:
    """Flushes and counts the messages that this took, late ones too."""

    def message_count() -> int:
        before = scene.link.queued_messages
        scene.flush()
        scene.link.deferred.finish(10.0)
        return scene.link.queued_messages - before

    return message_count


@pytest.mark.parametrize("make", NODES.values(), ids=NODES)
def test_an_equal_node_sends_nothing(
    make: Callable[[], Node], scene: ViserScene, message_count: Callable[[], int]
) -> None:
    scene.upsert("base_link", "it", make())
    assert message_count() > 0
    scene.upsert("base_link", "it", make())
    assert message_count() == 0


@pytest.mark.parametrize("make", NODES.values(), ids=NODES)
def test_removing_a_node_leaves_a_joining_browser_without_it(
    make: Callable[[], Node], scene: ViserScene, call: Make
) -> None:
    scene.flush()
    before = len(call().replay())
    scene.upsert("base_link", "it", make())
    scene.flush()
    scene.remove_group("base_link")
    scene.flush()
    assert len(call().replay()) == before


def test_an_update_is_one_message_with_all_changed_properties(
    scene: ViserScene, call: Make
) -> None:
    scene.upsert("laser", "hits", Points(XYZ, np.zeros((2, 3), np.uint8), 0.1))
    scene.flush()
    peer = call()
    peer.replay()
    scene.upsert("laser", "hits", Points(XYZ[:1], np.zeros((1, 3), np.uint8), 0.1))
    scene.flush()
    (message,) = peer.receive()
    assert message["type"] == "SceneNodeUpdateMessage"
    assert set(message["updates"]) == {"points", "colors", "cloud", "plane"}


def test_a_new_look_does_not_send_the_data_again(scene: ViserScene, call: Make) -> None:
    scene.upsert("laser", "hits", Points(XYZ, RED, 0.1))
    scene.flush()
    peer = call()
    peer.replay()
    scene.upsert("laser", "hits", Points(XYZ, RED, 0.2))
    scene.flush()
    (message,) = peer.receive()
    assert set(message["updates"]) == {"point_size", "point_shape"}


def test_poses_and_data_of_a_tick_arrive_in_one_frame(scene: ViserScene, call: Make) -> None:
    for index in range(200):
        scene.upsert(f"link{index}", "body", Points(XYZ, RED, 0.1))
    scene.flush()
    peer = call()
    peer.replay()
    for index in range(200):
        scene.set_pose(f"link{index}", Pose((1.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0)))
        scene.upsert(f"link{index}", "body", Points(XYZ + 1, RED, 0.1))
    scene.flush()
    assert len(peer.receive()) == 600


def test_nothing_is_sent_before_the_flush(scene: ViserScene) -> None:
    before = scene.link.queued_messages
    scene.set_pose("a", Pose((1.0, 2.0, 3.0)))
    scene.upsert("a", "it", image())
    scene.remove_group("a")
    assert scene.link.queued_messages == before


def test_a_node_that_comes_and_goes_within_a_tick_is_never_sent(
    scene: ViserScene, message_count: Callable[[], int]
) -> None:
    scene.upsert("a", "it", image())
    assert message_count() > 0
    scene.upsert("a", "other", image())
    scene.remove("a", "other")
    scene.remove("a", "it")
    scene.upsert("a", "it", image())
    assert message_count() == 0


@pytest.mark.parametrize("step", [1e-3, 3.0, 1e-9])
def test_the_smallest_move_far_out_is_sent(step: float, scene: ViserScene, call: Make) -> None:
    scene.set_pose("utm", Pose((500_000.0, 0.0, 0.0)))
    scene.flush()
    scene.set_pose("utm", Pose((500_000.0 + step, 0.0, 0.0)))
    scene.flush()
    moves = [m for m in call().replay() if m["type"] == "SetPositionMessage"]
    assert moves[-1]["position"] == [500_000.0 + step, 0.0, 0.0]


def test_an_equal_pose_is_not_sent_again(
    scene: ViserScene, message_count: Callable[[], int]
) -> None:
    scene.set_pose("a", Pose((1.0, 2.0, 3.0)))
    message_count()
    scene.set_pose("a", Pose((1.0, 2.0, 3.0)))
    assert message_count() == 0
    scene.set_pose("a", Pose((9.0, 2.0, 3.0)))
    scene.set_pose("a", Pose((1.0, 2.0, 3.0)))
    assert message_count() == 0


def test_a_group_that_only_turns_sends_only_that(
    scene: ViserScene, message_count: Callable[[], int]
) -> None:
    scene.set_pose("a", Pose((1.0, 2.0, 3.0)))
    message_count()
    scene.set_pose("a", Pose((1.0, 2.0, 3.0), (0.0, 1.0, 0.0, 0.0)))
    assert message_count() == 1


@pytest.mark.parametrize("bad", [float("nan"), float("inf")])
def test_a_pose_that_is_not_finite_is_refused_with_the_groups_name(
    bad: float, scene: ViserScene
) -> None:
    with pytest.raises(ValueError, match="'base_link' is not finite"):
        scene.set_pose("base_link", Pose((bad, 0.0, 0.0)))
    with pytest.raises(ValueError, match="'base_link' is not finite"):
        scene.set_pose("base_link", Pose(wxyz=(1.0, bad, 0.0, 0.0)))


def test_a_hidden_group_is_hidden_and_goes_on_changing(
    scene: ViserScene, message_count: Callable[[], int], call: Make
) -> None:
    scene.upsert("a", "it", image())
    message_count()
    scene.set_visible("a", False)
    assert message_count() == 1
    scene.set_visible("a", False)
    assert message_count() == 0
    scene.upsert("a", "it", image(np.ones((3, 4, 4), np.uint8)))
    assert message_count() == 1
    visible = {
        m["name"]: m["visible"]
        for m in call().replay()
        if m["type"] == "SetSceneNodeVisibilityMessage"
    }
    assert visible["/webviz/a"] is False


def test_another_kind_of_node_replaces_the_one_of_that_key(scene: ViserScene, call: Make) -> None:
    scene.upsert("a", "it", Points(XYZ, RED, 0.1))
    scene.flush()
    scene.upsert("a", "it", Lines(SEGMENTS, RED))
    scene.flush()
    of_it = [m for m in call().replay() if m.get("name") == "/webviz/a/it"]
    assert {m["type"] for m in of_it} == {
        "LineSegmentsMessage",
        "SceneNodeUpdateMessage",
        "SetSceneNodeVisibilityMessage",
    }


def test_removing_a_missing_node_is_ignored(
    scene: ViserScene, message_count: Callable[[], int]
) -> None:
    scene.remove("nobody", "nothing")
    scene.remove_group("nobody")
    scene.upsert("a", "it", image())
    scene.remove("a", "nothing")
    scene.clear()
    assert message_count() == 0


def test_a_label_that_stays_sends_nothing_when_another_moves(
    scene: ViserScene, message_count: Callable[[], int]
) -> None:
    scene.upsert("tf", "names", Labels(XYZ, ("odom", "map"), 0.1))
    message_count()
    scene.upsert(
        "tf", "names", Labels(XYZ + np.array([[0, 0, 0], [1, 0, 0]], "f4"), ("odom", "map"), 0.1)
    )
    assert message_count() == 1


def test_only_the_tiles_of_a_picture_that_changed_are_sent(
    scene: ViserScene, message_count: Callable[[], int]
) -> None:
    rgba = np.zeros((1500, 2500, 4), np.uint8)
    scene.upsert("map", "grid", image(rgba))
    message_count()
    rgba = rgba.copy()
    rgba[1400, 2400] = 255
    scene.upsert("map", "grid", image(rgba))
    assert message_count() == 1


def test_names_of_groups_may_be_anything(scene: ViserScene, call: Make) -> None:
    groups = ["", "/", "a/b", "a%2Fb", "基座", "\udcff", "__proto__", " ", "."]
    for group in groups:
        scene.upsert(group, group, Points(XYZ, RED, 0.1))
    scene.flush()
    clouds = [m for m in call().replay() if m["type"] == "PointCloudMessage"]
    assert len([m for m in clouds if m["name"].count("/") == 3]) == len(groups)


def test_a_malformed_node_is_named_once_and_the_rest_is_sent(
    scene: ViserScene, message_count: Callable[[], int]
) -> None:
    scene.upsert("a", "worse", Mesh(None, None, RED))  # pyright: ignore[reportArgumentType]
    scene.upsert("a", "good", image())
    with pytest.raises(TypeError) as excinfo:
        scene.flush()
    assert excinfo.value.__notes__ == ["while drawing 'worse' of 'a'"]
    assert message_count() > 0
    assert message_count() == 0


def test_a_text_with_surrogates_is_sent_with_question_marks(scene: ViserScene, call: Make) -> None:
    scene.upsert("tf", "names", Labels(XYZ, ("caf\udce9", "基座"), 0.1))
    scene.flush()
    labels = [m for m in call().replay() if m["type"] == "LabelMessage"]
    assert [m["props"]["text"] for m in labels] == ["caf?", "基座"]


def test_a_node_has_a_pose_in_its_group_and_only_changes_are_sent(scene: ViserScene) -> None:
    mesh = Mesh(np.eye(3, dtype=np.float32), np.array([[0, 1, 2]], np.uint32), (1, 2, 3))
    glb_pose = Pose((1.0, 2.0, 3.0), (0.0, 1.0, 0.0, 0.0))
    scene.upsert("robot", "link", mesh, glb_pose)
    scene.flush()
    count = scene.link.queued_messages
    scene.upsert("robot", "link", mesh, glb_pose)
    scene.flush()
    assert scene.link.queued_messages == count
    scene.upsert("robot", "link", mesh, Pose((1.0, 2.0, 4.0), glb_pose.wxyz))
    scene.flush()
    assert 0 < scene.link.queued_messages - count <= 2
