"""The RobotModel display: a description, transforms, and what is missing."""

import signal
import subprocess
import sys
import threading
import time
from collections.abc import Sequence
from pathlib import Path
from types import FrameType, SimpleNamespace
from typing import Any, ClassVar

import numpy as np
import pytest
import trimesh
from built_in_checks import BuiltInChecks
from display_scenes import OTHER_LINKS, robots
from inspecting import Benches
from processes import command_lines, send
from psutil import wait_procs
from robot_arm import ARM, describe, is_loaded, place_arm, wait
from robots import link_poses

import webviz
import webviz_urdf
from webviz.data.disk import MAX_THREADS, within
from webviz.engine.pipeline.background import Workers
from webviz.shell.testing import DisplayBench, check_details
from webviz.shell.testing.display_checks import Change
from webviz_displays.robot_model import RobotModel
from webviz_displays.robot_model import loading as disk_of_robots
from webviz_displays.robot_model.parts import JointSettings
from webviz_urdf import Loading, LoadingStopped, LoadRequest

DEMO = Path(webviz_urdf.__file__).parent / "demo" / "robot.urdf"
PACKAGES = [str(Path(webviz_urdf.__file__).parent.parent)]

MESHES = """
<robot name="meshes">
  <link name="base">
    <visual><geometry><mesh filename="package://nowhere/a.stl"/></geometry></visual>
    <visual><geometry><box size="1 1 1"/></geometry></visual>
    <collision><geometry><mesh filename="package://nowhere/b.stl"/></geometry></collision>
  </link>
</robot>
"""


@pytest.fixture
def slow_arm(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """The arm with a mesh that takes more than a second to read."""
    monkeypatch.setenv("WEBVIZ_MESH_ROOT", str(tmp_path))
    corners = np.random.default_rng(0).random((60_000, 9)).round(3)
    lines = [
        f"v {a} {b} {c}\nv {d} {e} {f}\nv {g} {h} {i}" for a, b, c, d, e, f, g, h, i in corners
    ]
    lines += [f"f {n} {n + 1} {n + 2}" for n in range(1, 3 * len(corners), 3)]
    (tmp_path / "slow.obj").write_text("\n".join(lines))
    return ARM.replace(
        '<origin xyz="0 0 2"/><geometry><box size="1 1 1"/>',
        f"<geometry><mesh filename='{tmp_path}/slow.obj'/>",
    )


def test_links_stand_where_their_transforms_say_and_shapes_where_the_links_say(
    arm: DisplayBench,
) -> None:
    assert set(arm.nodes()) == {"base visual visual_0", "tool visual grip"}
    assert arm.poses()["base visual visual_0"].position == pytest.approx((1.0, 0.0, 0.0))
    assert arm.poses()["tool visual grip"].position == pytest.approx((1.0, 3.0, -2.0))
    assert np.abs(arm.poses()["tool visual grip"].wxyz) == pytest.approx([0, 1, 0, 0])
    assert arm.nodes()["tool visual grip"].color == (0, 0, 255)
    statuses = arm.statuses()
    assert statuses["URDF"] == ("OK", "'arm': 2 links, 2 of 2 visuals loaded.")
    assert statuses["Links"] == ("OK", "2 links placed by transforms.")


def test_the_demo_robot_is_drawn_whole(bench: Benches) -> None:
    at = bench(RobotModel(package_paths=PACKAGES), fixed_frame="base_link")
    robot = webviz_urdf.load_file(DEMO, webviz_urdf.Resolver(PACKAGES))
    for joint in robot.joints.values():
        x, y, z = joint.origin.position
        w, i, j, k = joint.origin.wxyz
        at.transform(joint.parent, joint.child, (x, y, z), (i, j, k, w))
    describe(at, DEMO.read_text())
    visuals = sum(len(link.visuals) for link in robot.links.values())
    assert len(at.nodes()) == visuals
    assert at.statuses()["URDF"][0] == "OK"
    assert f"{visuals} of {visuals} visuals" in at.statuses()["URDF"][1]
    assert "Meshes" not in at.statuses()
    for link, pose in link_poses(robot).items():
        for shape in robot.links[link].visuals:
            expected = webviz.compose(pose, shape.pose)
            assert at.poses()[f"{link} visual {shape.name}"].position == pytest.approx(
                expected.position, abs=1e-9
            )


def test_until_a_description_comes_the_topic_is_named(bench: Benches) -> None:
    at = bench(RobotModel())
    at.turn()
    assert at.nodes() == {}
    assert at.statuses()["URDF"] == (
        "WARN",
        "No robot description received on /robot_description. Start robot_state_publisher.",
    )


def slow_bench(bench: Benches, slow_arm: str) -> DisplayBench:
    """The bench of a robot whose tool is still loading."""
    at = bench(RobotModel())
    place_arm(at)
    at.send("std_msgs/msg/String", {"data": slow_arm}, topic="/robot_description")
    wait(at, lambda: "tool" in at.statuses()["Loading"][1])
    return at


def test_a_robot_is_loaded_beside_the_frame_loop_with_a_status(
    bench: Benches, slow_arm: str
) -> None:
    at = slow_bench(bench, slow_arm)
    assert at.statuses()["Loading"] == ("IDLE", "Loading: 1 of 2 shapes, at link 'tool'.")
    assert at.nodes() == {}
    wait(at, lambda: is_loaded(at))
    assert len(at.nodes()) == 2


def test_the_newest_description_wins_though_one_hangs(bench: Benches, slow_arm: str) -> None:
    at = slow_bench(bench, slow_arm)
    hanging = [child for child, line in command_lines().items() if "loader" in line]
    send(signal.SIGSTOP, hanging)
    describe(at, ARM)
    assert "tool visual grip" in at.nodes()
    _, alive = wait_procs(hanging, timeout=60)
    assert not alive


def test_no_loading_outlives_the_viewer(slow_arm: str) -> None:
    workers = Workers(lambda: None)
    loading = Loading(LoadRequest(text=slow_arm))
    future = workers.submit(loading.run, stop=loading.stop)
    while loading.at[2] != "tool":
        time.sleep(0.005)
    workers.close()
    assert isinstance(future.exception(), LoadingStopped)


def test_an_identical_description_is_not_loaded_again(arm: DisplayBench) -> None:
    before = arm.nodes()
    arm.send("std_msgs/msg/String", {"data": ARM}, topic="/robot_description")
    arm.turn()
    assert "Loading" not in arm.statuses()
    after = arm.nodes()
    assert all(after[key] is before[key] for key in before)


def test_a_new_description_replaces_the_robot_and_the_old_one_stays_till_then(
    arm: DisplayBench,
) -> None:
    other = ARM.replace('name="grip"', 'name="claw"')
    arm.send("std_msgs/msg/String", {"data": other}, topic="/robot_description")
    arm.turn()
    assert {"tool visual grip", "tool visual claw"} & set(arm.nodes())
    wait(arm, lambda: "tool visual claw" in arm.nodes())
    assert "tool visual grip" not in arm.nodes()


@pytest.mark.parametrize(
    "text", ["", "no robot", "<robot name='r'><link name='a'/><link name='b'/></robot>"]
)
def test_an_invalid_description_is_an_error_and_draws_nothing(arm: DisplayBench, text: str) -> None:
    arm.send("std_msgs/msg/String", {"data": text}, topic="/robot_description")
    wait(arm, lambda: arm.statuses().get("URDF", ("",))[0] == "ERROR")
    assert arm.nodes() == {}


def test_missing_meshes_are_listed_while_the_rest_is_drawn(bench: Benches) -> None:
    at = bench(RobotModel(), fixed_frame="base")
    at.transform("base", "other")
    describe(at, MESHES)
    assert len(at.nodes()) == 1
    statuses = at.statuses()
    assert statuses["URDF"] == ("OK", "'meshes': 1 link, 1 of 2 visuals loaded.")
    level, text = statuses["Meshes"]
    assert level == "ERROR"
    assert text.startswith("1 shape missing. Link 'base': Package 'nowhere'")


def test_collision_shapes_are_read_only_when_enabled(arm: DisplayBench) -> None:
    arm.set("collision_enabled", True)
    wait(arm, lambda: "base collision collision_0" in arm.nodes())
    assert "base visual visual_0" in arm.nodes()
    arm.set("visual_enabled", False)
    assert set(arm.nodes()) == {"base collision collision_0"}
    arm.set("collision_enabled", False)
    assert arm.nodes() == {}
    assert arm.statuses()["Shapes"][0] == "WARN"


def test_disabled_collision_shapes_are_not_waited_for(arm: DisplayBench) -> None:
    arm.set("collision_enabled", True)
    arm.set("collision_enabled", False)
    assert "Loading" not in arm.statuses()


def test_missing_collision_meshes_count_only_when_enabled(bench: Benches) -> None:
    at = bench(RobotModel(collision_enabled=True), fixed_frame="base")
    at.transform("base", "other")
    describe(at, MESHES)
    wait(at, lambda: is_loaded(at) and "2 shapes missing" in at.statuses()["Meshes"][1])
    at.set("collision_enabled", False)
    assert "1 shape missing" in at.statuses()["Meshes"][1]


@pytest.fixture
def of_file(bench: Benches, tmp_path: Path) -> DisplayBench:
    """The bench of an arm that is described by a file."""
    path = tmp_path / "arm.urdf"
    path.write_text(ARM)
    at = bench(RobotModel(description_source="File", description_file=str(path)))
    place_arm(at)
    wait(at, lambda: is_loaded(at))
    return at


def test_a_file_is_drawn_without_any_topic(of_file: DisplayBench) -> None:
    assert set(of_file.nodes()) == {"base visual visual_0", "tool visual grip"}


@pytest.mark.parametrize("path", ["/tmp/a\0b.urdf", "~nobody there/a.urdf", "~\0/a", "/proc/kmsg"])
def test_a_path_of_no_file_is_refused_by_a_sentence(bench: Benches, path: str) -> None:
    at = bench(RobotModel(description_source="File", description_file=path))
    wait(at, lambda: "URDF" in at.statuses())
    level, text = at.statuses()["URDF"]
    assert level == "ERROR"
    assert "is not a usable path" in text or "cannot be read: " in text


def test_with_a_file_the_topic_is_not_subscribed_and_not_missed(of_file: DisplayBench) -> None:
    assert of_file.runner.subscriptions() == {}
    assert not [key for key in of_file.statuses() if key.startswith("Topic")]
    of_file.set("description_source", "Topic")
    assert set(of_file.runner.subscriptions()) == {"/robot_description"}


def test_description_files_that_never_respond_leave_the_disk_to_others(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Such as 40 on a dead network mount: configs are saved all the same."""
    mounted = threading.Event()

    dead = SimpleNamespace(expanduser=lambda: SimpleNamespace(stat=mounted.wait))
    monkeypatch.setattr(disk_of_robots, "Path", lambda _: dead)
    monkeypatch.setattr(disk_of_robots, "DISK_S", 0.001)
    ctx: Any = SimpleNamespace(background=lambda _, work, path: work(path))
    before = disk_of_robots.Written()
    try:
        for _ in range(MAX_THREADS + 4):
            assert disk_of_robots.last_written("/dead.urdf", before, ctx).at_ns == 0
        assert within(60.0, lambda: "saved") == "saved"
    finally:
        mounted.set()


def test_the_frame_loop_does_not_wait_for_the_disk_of_a_description_file(
    bench: Benches, tmp_path: Path
) -> None:
    """Such as a dead network mount."""
    path = tmp_path / "arm.urdf"
    path.write_text(ARM)
    calls: set[str] = set()

    def note(frame: FrameType, event: str, called: object) -> None:
        if event == "c_call" and getattr(called, "__module__", "") in ("posix", "_io", "io"):
            calls.add(getattr(called, "__name__", ""))

    at = bench(RobotModel(description_source="File", description_file=str(path)))
    place_arm(at)
    sys.setprofile(note)  # of this thread only
    try:
        # An answer that is still on its way would be about the file as it was.
        wait(at, lambda: is_loaded(at) and not at.runner.is_busy())
        path.write_text(ARM.replace("grip", "fist"))
        calls.clear()
        at.set("alpha", 0.5)
        wait(at, lambda: "tool visual fist" in at.nodes())
    finally:
        sys.setprofile(None)
    assert not calls & {"stat", "lstat", "open", "scandir", "listdir", "readlink"}


@pytest.mark.parametrize(
    ("path", "level", "sentence"),
    [("", "WARN", "No description file"), ("gone.urdf", "ERROR", "gone.urdf")],
)
def test_a_missing_file_is_reported(
    bench: Benches, tmp_path: Path, path: str, level: str, sentence: str
) -> None:
    path = path and str(tmp_path / path)
    at = bench(RobotModel(description_source="File", description_file=path))
    wait(at, lambda: "URDF" in at.statuses())
    assert at.statuses()["URDF"][0] == level
    assert sentence in at.statuses()["URDF"][1]


def test_a_robot_that_was_loaded_before_its_transforms_came_is_not_grey_with_them(
    bench: Benches,
) -> None:
    at = bench(RobotModel())
    at.turn()
    at.send("std_msgs/msg/String", {"data": ARM})
    at.turn()
    at.settle()
    place_arm(at)
    at.turn()
    assert at.nodes()["tool visual grip"].color == (0, 0, 255)


def test_mesh_readers_are_imported_only_by_the_process_that_loads_robots() -> None:
    """It takes longer than all other imports of a viewer."""
    script = (
        "import sys, webviz_displays.robot_model; "
        "assert not {'trimesh', 'yourdfpy', 'scipy', 'lxml'} & sys.modules.keys()"
    )
    subprocess.run([sys.executable, "-c", script], check=True)


class TestRobotModel(BuiltInChecks):
    display = RobotModel
    scene = robots
    later = ("update_interval",)
    values: ClassVar = {
        "links": OTHER_LINKS,
        "joints": [
            {"slide": JointSettings(show_axes=True)},
            {"slide": JointSettings(show_joint_axis=True)},
        ],
    }

    def other_values(self, changed: Change, folder: Path) -> Sequence[Any]:
        if changed.path != "package_paths":
            return super().other_values(changed, folder)
        package = folder / "somewhere"
        package.mkdir()
        (package / "package.xml").write_text("<package><name>somewhere</name></package>")
        trimesh.creation.box().export(package / "part.stl")
        return [[str(folder)]]


def test_selecting_link_of_a_robot(arm: DisplayBench) -> None:
    check_details(
        arm.pick("base visual visual_0", None, (0.5, 0.0, 0.0)),
        "Link base",
        {
            "Mass": "6 kg",
            "Visual": "a box, sphere or cylinder",
            "Robot": "arm",
            "Parent frame": "map",
        },
    )
