"""Every property of every built-in display changes what is drawn or said."""

from __future__ import annotations

import importlib
import pkgutil
import time
from collections.abc import Callable, Iterator
from pathlib import Path as FilePath
from typing import Annotated, Any, Literal, get_args, get_origin, get_type_hints

import msgspec
import numpy as np
import photos
import pytest
import trimesh
from autoware_scenes import AUTOWARE_SCENES
from clouds import CLOUD, xyz_cloud
from mapping_scenes import MAPPING_SCENES
from moveit_scenes import moveit, plan_task
from perception_scenes import PERCEPTION_SCENES
from plain_scenes import PLAIN_SCENES
from rtabmap_scenes import RTABMAP_SCENES

import webviz_displays
from webviz import Display, Topic
from webviz.api.declared import set_property
from webviz.api.display import inputs
from webviz.shell.testing.messages import header
from webviz_displays.moveit.properties import SceneGeometry
from webviz_displays.robot_model.parts import JointSettings, LinkSettings

SECOND = 1_000_000_000

Benches = Callable[..., Any]


def display_classes() -> list[type[Display]]:
    modules = pkgutil.iter_modules(webviz_displays.__path__, "webviz_displays.")
    found = [
        value
        for module in modules
        for value in vars(importlib.import_module(module.name)).values()
        if isinstance(value, type) and issubclass(value, Display) and not value.__subclasses__()
    ]
    return sorted(set(found), key=lambda cls: cls.__name__)


# Scenes in which every property has something to change


def scans(bench: Any) -> None:
    """Two scans of a tilted laser that moves while it turns."""
    tilt = (0.5, 0.5, 0.5, 0.5)  # x points along y, y along z
    for i in range(10):
        stamp_ns = bench.now_ns + i * SECOND // 10
        bench.transform("map", "laser", (0.3 * i, 0.0, 0.1 * i), tilt, stamp_ns=stamp_ns)
    for _ in range(2):
        values = {
            "angle_increment": 0.7,
            "time_increment": 0.125,
            "range_max": 10.0,
            "ranges": [1.0, 2.5, 2.0, 4.0, 1.5],
            "intensities": [100.0, 900.0, 30.0, 4000.0, 5000.0],
        }
        bench.send("sensor_msgs/msg/LaserScan", values, frame="laser")
        bench.turn()


def clouds(bench: Any) -> None:
    """Two clouds of many fields and near points, of a tilted sensor."""
    bench.transform("map", "lidar", (1.0, 0.0, 0.5), (0.5, 0.5, 0.5, 0.5))
    points = [(1.0, 0.0, 0.1), (1.1, 0.2, 0.3), (40.0, 4.0, 4.4), (41.0, 4.1, 4.5)]
    extra = {"intensity": [100.0, 900.0, 30.0, 5000.0], "rgb": [1e-38, 2e-38, 3e-38, 4e-38]}
    extra |= {"r": [0.1, 0.2, 0.3, 0.4], "g": [0.5] * 4, "b": [0.6, 0.5, 0.4, 0.3]}
    for _ in range(2):
        bench.send(CLOUD, xyz_cloud(points, extra), frame="lidar")
        bench.turn()


def paths(bench: Any) -> None:
    for height in (0.0, 1.0):
        poses = [{"pose": {"position": {"x": x, "z": height}}} for x in (0.0, 1.0, 2.0)]
        bench.send("nav_msgs/msg/Path", {"poses": poses}, frame="map")
        bench.turn()


def odometries(bench: Any) -> None:
    """Small steps and turns; the last pose is uncertain in space."""
    variances = np.diag([0.1, 0.2, 0.3, 0.1, 0.2, 0.3]).ravel()
    for i in range(250):
        turn = {"z": float(np.sin(0.03 * i)), "w": float(np.cos(0.03 * i))}
        pose = {"position": {"x": 0.07 * i}, "orientation": turn}
        values = {"pose": {"pose": pose, "covariance": variances}}
        bench.send("nav_msgs/msg/Odometry", values, frame="map")
    bench.turn()


def robot_frame(bench: Any) -> None:
    """A frame to refer to, away from the fixed frame."""
    bench.transform("map", "robot", (1.0, 2.0, 0.0))
    bench.turn()


def images(bench: Any) -> None:
    """Two depth images of different ranges."""
    for depths in ([0.3, 0.6], [2.0, 5.0]):
        data = np.array(depths, np.float32).view(np.uint8)
        values = {"width": 2, "height": 1, "encoding": "32FC1", "step": 8, "data": data}
        bench.send("sensor_msgs/msg/Image", values, frame="camera")
        bench.turn()


def image_planes(bench: Any) -> None:
    """Depth images, more than their range is the median of by default."""
    bench.transform("map", "camera", (1.0, 0.0, 0.0))
    for scale in (0.1, 0.2, 0.4, 0.8, 1.6, 0.2):
        values = photos.raw(scale * photos.room(16, 12)[1], "32FC1")
        bench.send(photos.RAW, values, frame="camera")
        bench.turn()
    bench.settle()


def camera_infos(bench: Any) -> None:
    """A camera, and its image."""
    bench.transform("map", "camera", (1.0, 0.0, 0.0))
    bench.send(photos.INFO, photos.info(16, 12), frame="camera", topic="/camera/camera_info")
    values = photos.raw(photos.room(16, 12)[0], "rgb8")
    bench.send(photos.RAW, values, frame="camera", topic="/camera/image_raw")
    bench.turn()
    bench.settle()


def cameras(bench: Any) -> None:
    """Two depth images of different ranges, by a camera with distortion."""
    bench.transform("map", "camera", (1.0, 0.0, 0.0))
    bend = {"distortion_model": "plumb_bob", "d": [-0.1, 0.0, 0.0, 0.0, 0.0]}
    for topic in ("/camera/camera_info", "/info"):
        values = photos.info(16, 12, **bend)
        bench.send(photos.INFO, values, frame="camera", topic=topic)
    for scale in (0.5, 1.0):
        values = photos.raw(scale * photos.room(16, 12)[1], "32FC1")
        bench.send(photos.RAW, values, frame="camera", topic="/camera/image_raw")
        bench.turn()


def depth_clouds(bench: Any) -> None:
    """Depths with a camera info and a colour image, of a tilted camera."""
    bench.transform("map", "camera", (1.0, 0.0, 0.0), (0.5, 0.5, 0.5, 0.5))
    colors, depths = photos.room(16, 12)
    for topic in ("/camera/depth/camera_info", "/info"):
        bench.send(photos.INFO, photos.info(16, 12), frame="camera", topic=topic)
    for scale in (2.0, 1.0):  # the second hides the first
        values, topic = photos.raw(scale * depths, "32FC1"), "/camera/depth/image_rect_raw"
        bench.send(photos.RAW, values, frame="camera", topic=topic)
        bench.send(photos.RAW, photos.raw(colors, "rgb8"), frame="camera", topic="/color")
        bench.turn(0.1)
        bench.settle()


def frames(bench: Any) -> None:
    """One frame that stands still and one that moved twice in a short time, 10 s ago."""
    bench.transform("map", "robot", (1.0, 2.0, 0.0))
    for x in (1.0, 2.0):
        bench.transform("robot", "arm", (x, 0.0, 0.0), stamp_ns=bench.now_ns)
        bench.turn(0.05)
    bench.turn(10.0)


def maps(bench: Any) -> None:
    """A map of all kinds of cells, and an update, in a frame that moved on."""
    for age, x in ((1, 1.0), (0, 2.0)):
        bench.transform("map", "room", (x, 0.0, 0.0), stamp_ns=bench.now_ns - age * SECOND)
    grid = {
        "info": {"resolution": 0.5, "width": 3, "height": 2, "origin": {"orientation": {"w": 1.0}}},
        "data": [0, 30, 60, 98, 100, -1],
    }
    stamp_ns = bench.now_ns - SECOND
    bench.send("nav_msgs/msg/OccupancyGrid", grid, frame="room", stamp_ns=stamp_ns, topic="/map")
    bench.turn()
    update = {"x": 1, "width": 1, "height": 1, "data": [77]}
    type_name, topic = "map_msgs/msg/OccupancyGridUpdate", "/map_updates"
    bench.send(type_name, update, frame="room", stamp_ns=stamp_ns, topic=topic)
    bench.turn()


ROBOT = """
<robot name="one">
  <link name="base">
    <visual><geometry><box size="1 1 1"/></geometry></visual>
    <visual><geometry><mesh filename="package://somewhere/part.stl"/></geometry></visual>
    <collision><geometry><sphere radius="1"/></geometry></collision>
    <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <link name="rider"><visual><geometry><box size="1 1 1"/></geometry></visual></link>
  <joint name="slide" type="prismatic">
    <parent link="base"/><child link="rider"/><limit lower="0" upper="9" effort="1" velocity="1"/>
  </joint>
</robot>
"""


def robots(bench: Any) -> None:
    bench.transform("map", "base", (1.0, 0.0, 0.0))
    bench.send("std_msgs/msg/String", {"data": ROBOT}, topic="/robot_description")
    state = {"name": ["slide"], "position": [1.5]}
    bench.send("sensor_msgs/msg/JointState", state, topic="/joint_states")
    for place in (1.0, 2.0):
        bench.transform("base", "rider", (place, 0.0, 0.0), stamp_ns=bench.now_ns)
        settle(bench)
        bench.turn(0.1)


def markers(bench: Any) -> None:
    """Two markers, one alone and one in an array, if the display takes both."""
    for name, topic in (("Marker", ""), ("MarkerArray", "_array")):
        marker = {
            "header": header("map", bench.now_ns),
            "ns": "robot",
            "id": len(topic),
            "type": 1,
            "pose": {"position": {"x": 2.0 * len(topic)}},
            "scale": {"x": 1.0, "y": 1.0, "z": 1.0},
            "color": {"a": 1.0},
        }
        values = {"markers": [marker]} if topic else marker
        known = {each.name for _, _, each in inputs(bench.display)}
        if f"/visualization_marker{topic}" in known or "" in known:
            type_name = f"visualization_msgs/msg/{name}"
            bench.send(type_name, values, topic=f"/visualization_marker{topic}")
    bench.turn()


def interactive_markers(bench: Any) -> None:
    """A marker with an arrow, if the display has a namespace."""
    bench.transform("map", "robot")
    bench.offer("/arm/update", "visualization_msgs/msg/InteractiveMarkerUpdate")
    control = {"interaction_mode": 3, "name": "along x"}
    marker = {"header": {"frame_id": "robot"}, "description": "Hand", "controls": [control]}
    response = {"markers": [marker]}
    service = "visualization_msgs/srv/GetInteractiveMarkers"
    bench.serve("/arm/get_interactive_markers", service, response)
    for _ in range(3):
        bench.turn(0.1)


def texts(bench: Any) -> None:
    """Messages with a long array and a number of many digits, some soon after the one before."""
    for number, seconds in enumerate((0.0, 0.07, 0.13, 0.06)):
        bench.turn(seconds)
        values = {"voltage": number + 0.3456789, "cell_voltage": [3.0] * 30}
        bench.send("sensor_msgs/msg/BatteryState", values, frame="robot", topic="/any")
        bench.turn()


SCENES: dict[str, Callable[[Any], None]] = {
    "Axes": robot_frame,
    "Camera": cameras,
    "CameraInfo": camera_infos,
    "DepthCloud": depth_clouds,
    "Grid": robot_frame,
    "Image": images,
    "ImagePlane": image_planes,
    "InteractiveMarkers": interactive_markers,
    "LaserScan": scans,
    "Map": maps,
    "Marker": markers,
    "MarkerArray": markers,
    "Odometry": odometries,
    "Path": paths,
    "PointCloud2": clouds,
    "RobotModel": robots,
    "TF": frames,
    "Text": texts,
    "MotionPlanningTasks": plan_task,
    **dict.fromkeys(("MotionPlanning", "PlanningScene", "RobotState", "Trajectory"), moveit),
    **PLAIN_SCENES,
    **MAPPING_SCENES,
    **PERCEPTION_SCENES,
    **AUTOWARE_SCENES,
    **RTABMAP_SCENES,
}

PLAYERS = (("MotionPlanning", "planned_path."), ("MotionPlanningTasks", ""), ("Trajectory", ""))
ANIMATED = ("interrupt_display", "loop_animation", "state_display_time", "use_sim_time")
"""Properties that act on the animation of a path."""

# What these say, as decay_time and history_length do, shows with what comes next, not with what is
# drawn already.
OF_THE_FUTURE = {
    ("DepthCloud", "occlusion_compensation"),
    ("Camera", "median_window"),
    *(("MapCloud", f"cloud_{each}") for each in ("decimation", "from_scan")),
    ("Image", "median_window"),
    ("ImagePlane", "median_window"),
    ("OccupancyMap", "max_octree_depth"),
    ("OccupancyMapStamped", "max_octree_depth"),
    ("Odometry", "angle_tolerance"),
    ("Odometry", "keep"),
    ("Odometry", "position_tolerance"),
    *((name, prefix + each) for name, prefix in PLAYERS for each in ANIMATED),
    *((name, "move_group_namespace") for name in ("MotionPlanning", "PlanningScene")),
    *((name, "scene_geometry.scene_display_time") for name in ("MotionPlanning", "PlanningScene")),
    ("Path", "buffer_length"),
    ("PoseHistory", "buffer_size"),
    ("Range", "buffer_length"),
    ("RobotModel", "update_interval"),
    ("TF", "update_interval"),
    ("Text", "update_interval"),
}

# What the page does with the scene that a display draws (tests/page/test_images.py), and a choice
# that depends on the name of the topic (tests/displays/test_camera.py).
ELSEWHERE = {
    *(("Camera", "visibility"), ("Camera", "undistort")),
    ("DepthCloud", "occlusion_time_out"),
    *(("MapCloud", f"cloud_{each}") for each in ("min_depth", "max_depth", "voxel_size")),
    *(("MapCloud", f"filter_{each}") for each in ("floor", "ceiling")),
    *(("MapCloud", f"node_filtering_{each}") for each in ("radius", "angle")),
    ("MapCloud", "download_namespace"),
}

# Entries of properties that hold settings by name: each differs from none in one setting.
ENTRIES: dict[type, list[Any]] = {
    bool: [{"robot": False, "slide": False}],
    LinkSettings: [
        {"base": LinkSettings(enabled=False)},
        {"base": LinkSettings(alpha=0.5)},
        {"base": LinkSettings(show_axes=True)},
        {"rider": LinkSettings(show_trail=True)},
    ],
    JointSettings: [
        {"slide": JointSettings(show_axes=True)},
        {"slide": JointSettings(show_joint_axis=True)},
    ],
}

WRENCH_PROPERTIES = (
    *("alpha", "arrow_width", "force_color", "force_arrow_scale"),
    *("history_length", "torque_color", "torque_arrow_scale"),
)

# What must be set besides what `when` tells.
BESIDES: dict[tuple[str, str], dict[str, Any]] = {
    **{
        ("InteractiveMarkers", name): {"interactive_markers_namespace": "/arm"}
        for name in (
            "show_descriptions",
            "show_axes",
            "show_visual_aids",
            "enable_transparency",
            "enabled",
        )
    },
    # Images have no intensities.
    **{
        ("MapCloud", name): {"color_transformer": "Intensity", "cloud_from_scan": True}
        for name in (
            "autocompute_intensity_bounds",
            "invert_rainbow",
            *(f"{end}_{what}" for end in ("min", "max") for what in ("color", "intensity")),
        )
    },
    # Without limits at first.
    **{
        (name, path): {path: value}
        for name in ("OccupancyGrid", "ColorOccupancyGrid", "OccupancyGridStamped")
        for path, value in {"max_height": 0.3, "min_height": 0.3}.items()
    },
    **{
        ("Text", name): {"topic": Topic("/any")}
        for name in ("enabled", "topic", "fields", "digits", "array_length", "update_interval")
    },
    # With both tolerances at work the larger motion decides.
    ("Odometry", "position_tolerance"): {"angle_tolerance": 10.0},
    ("Odometry", "angle_tolerance"): {"position_tolerance": 1000.0},
    **{
        ("MotionPlanning", f"planning_request.{name}_state_{what}"): {
            f"planning_request.query_{name}_state": True
        }
        for name in ("start", "goal")
        for what in ("color", "alpha")
    },
    **{
        (name, prefix + path): {prefix + other: value}
        for name, prefix in PLAYERS
        for path, other, value in (
            ("interrupt_display", "use_sim_time", True),
            ("state_display_time", "use_sim_time", True),
            ("trail_step_size", "paused", True),
        )
    },
    **{
        (name, f"{prefix}loop_animation"): {
            f"{prefix}use_sim_time": True,
            f"{prefix}interrupt_display": True,
        }
        for name, prefix in PLAYERS
    },
    # The default is too fast for the time between two messages.
    **{
        ("MotionPlanningTasks", path): {"state_display_time": "3x", **more}
        for path, more in (
            ("interrupt_display", {"use_sim_time": True}),
            ("loop_animation", {"use_sim_time": True, "interrupt_display": True}),
            ("paused", {}),
            ("use_sim_time", {}),
        )
    },
    **{
        ("MotionPlanning", name): {"planning_request.show_workspace": True}
        for name in ("workspace_center", "workspace_size")
    },
    # Of 192 pixels.
    ("DepthCloud", "max_points"): {"max_points": 40},
    # Of four points.
    ("PointCloud", "max_points"): {"max_points": 3},
    ("PointCloud2", "max_points"): {"max_points": 3},
    # Values that are not finite are not drawn otherwise.
    **{("Wrench", path): {"accept_nan_values": True} for path in WRENCH_PROPERTIES},
}


def other_values(cls: type[Display], hint: Any, value: Any, folder: FilePath) -> list[Any]:
    """Other values of a property; each that is valid must show."""
    if value == SceneGeometry().scene_display_time:
        return [50.0]  # real time, of which the scene takes little
    if get_origin(hint) is Literal:
        return [choice for choice in get_args(hint) if choice != value]
    if isinstance(value, bool):
        return [not value]
    if isinstance(value, int):
        return [value * 3 + 1, value // 2]
    if isinstance(value, float):
        return [value * 3 + 50.0, value / 2]
    if isinstance(value, Topic):
        return [Topic("/somewhere_else")]
    if isinstance(value, tuple):
        return [tuple(255 - v for v in value)] if isinstance(value[0], int) else [(1.0, 2.0, 3.0)]
    if isinstance(value, str):
        return ["robot"]
    if isinstance(value, dict):
        return ENTRIES[get_args(hint)[1]]
    assert isinstance(value, list), "a new kind of property"
    package = folder / "somewhere"
    package.mkdir()
    (package / "package.xml").write_text("<package><name>somewhere</name></package>")
    trimesh.creation.box().export(package / "part.stl")
    return [[str(folder)]]


def properties() -> Iterator[Any]:
    for cls in display_classes():
        for path, hint, condition in leaves(cls, cls(), "", {}):
            # What the tool Select picks is tried in a browser, see tests/app/test_selection.py.
            if path not in ("name", "selectable") and (cls.__name__, path) not in ELSEWHERE:
                yield pytest.param(cls, path, hint, condition, id=f"{cls.__name__}.{path}")


def leaves(
    struct: Any, value: Any, prefix: str, condition: dict[str, Any]
) -> Iterator[tuple[str, Any, dict[str, Any]]]:
    """Path, type, and what must hold besides for each property, nested ones included."""
    hints = get_type_hints(struct, include_extras=True)
    for name in value.__struct_fields__:
        hint, current = hints[name], getattr(value, name)
        needs = dict(condition)
        add_condition(name, hints, prefix, needs)
        plain = get_args(hint)[0] if get_origin(hint) is Annotated else hint
        if isinstance(current, msgspec.Struct) and not isinstance(current, Topic):
            yield from leaves(type(current), current, f"{prefix}{name}.", needs)
        else:
            yield f"{prefix}{name}", plain, needs


def add_condition(name: str, hints: dict[str, Any], prefix: str, needs: dict[str, Any]) -> None:
    for item in getattr(hints[name], "__metadata__", ()):
        if isinstance(item, msgspec.Meta) and (when := (item.extra or {}).get("when")):
            other, wanted = when
            wanted = wanted[0] if isinstance(wanted, tuple) else wanted
            add_condition(other, hints, prefix, needs)
            inner = isinstance(wanted, bool) and not prefix and is_group(hints[other])
            needs[f"{prefix}{other}{'.value' if inner else ''}"] = wanted


def is_group(hint: Any) -> bool:
    plain = get_args(hint)[0] if get_origin(hint) is Annotated else hint
    return isinstance(plain, type) and issubclass(plain, msgspec.Struct)


def settle(bench: Any) -> None:
    """Let slow work finish."""
    deadline = time.monotonic() + 60
    bench.turn()
    while "Loading" in bench.statuses() or bench.runner.is_busy():
        assert time.monotonic() < deadline, bench.statuses()
        time.sleep(0.005)
        bench.turn()


def picture(bench: Any) -> tuple[Any, ...]:
    """Everything a user sees but counts and ages of messages."""
    said = {k: v for k, v in bench.statuses().items() if not k.startswith(("Topic", "Message"))}
    return bench.nodes(), bench.poses(), bench.runner.handles(), said


@pytest.mark.parametrize(("cls", "path", "hint", "condition"), list(properties()))
def test_every_property_changes_what_is_drawn_or_said(
    bench: Benches,
    tmp_path: FilePath,
    cls: type[Display],
    path: str,
    hint: Any,
    condition: dict[str, Any],
) -> None:
    condition = condition | BESIDES.get((cls.__name__, path), {})
    display = cls()
    for other, wanted in condition.items():
        set_property(display, other, wanted)
    before = display
    for part in path.split("."):
        before = getattr(before, part)
    at_work = bench(display)
    SCENES[cls.__name__](at_work)
    tried = 0
    for value in other_values(cls, hint, before, tmp_path):
        if value == before:
            continue
        try:
            set_property(changed := cls(), path, value)
        except msgspec.ValidationError:
            continue  # out of bounds
        tried += 1
        former = picture(at_work)
        is_of_the_future = path in ("decay_time", "history_length")
        is_of_the_future |= (cls.__name__, path) in OF_THE_FUTURE
        if is_of_the_future or "show_trail=True" in str(value):
            for other, wanted in condition.items():
                set_property(changed, other, wanted)
            again = bench(changed)
            SCENES[cls.__name__](again)
            assert picture(again) != former, f"{value} shows as {before} does"
        else:
            at_work.set(path, before)
            settle(at_work)
            assert picture(at_work) == former  # what changes by itself would prove nothing
            at_work.set(path, value)
            settle(at_work)
            assert picture(at_work) != former, f"{value} shows as {before} does"
            at_work.set(path, before)
            settle(at_work)
    assert tried


def test_every_display_is_tried() -> None:
    assert {cls.__name__ for cls in display_classes()} == SCENES.keys()


@pytest.mark.parametrize(
    ("name", "path", "status"),
    [
        ("Grid", "alpha", "Grid"),
        ("ImagePlane", "alpha", "Image"),
        ("LaserScan", "alpha", "Points"),
        ("OccupancyGrid", "voxel_alpha", "Voxels"),
        ("Odometry", "shape.alpha", "Pose"),
        ("Path", "alpha", "Path"),
        ("PointCloud2", "alpha", "Points"),
        ("Pose", "alpha", "Pose"),
        ("PoseArray", "alpha", "Poses"),
        ("Range", "alpha", "Range"),
    ],
)
def test_alpha_0_hides_and_says_so(bench: Benches, name: str, path: str, status: str) -> None:
    cls = next(cls for cls in display_classes() if cls.__name__ == name)
    at_work = bench(cls())
    SCENES[name](at_work)
    visible = set(at_work.nodes())
    at_work.set(path, 0.0)
    assert set(at_work.nodes()) < visible
    level, text = at_work.statuses()[status]
    assert level == "WARN"
    assert "nvisible: alpha is 0." in text
    remedy = at_work.remedy(status)
    assert remedy is not None
    at_work.set(remedy.path, remedy.value)
    assert visible <= set(at_work.nodes())


@pytest.mark.parametrize(
    ("name", "off", "status"),
    [
        ("GridMap", {"color_transformer": "None", "show_grid_lines": False}, "Grid map"),
        (
            "Imu",
            {
                "axes_properties.enable_axes": False,
                "acceleration_properties.enable_acceleration": False,
            },
            "Imu",
        ),
        ("RobotModel", {"visual_enabled": False}, "Shapes"),
    ],
)
def test_what_is_switched_off_says_so_and_what_would_help(
    bench: Benches, name: str, off: dict[str, object], status: str
) -> None:
    cls = next(cls for cls in display_classes() if cls.__name__ == name)
    at_work = bench(cls())
    SCENES[name](at_work)
    for path, value in off.items():
        at_work.set(path, value)
    settle(at_work)
    assert at_work.statuses()[status][0] == "WARN"
    remedy = at_work.remedy(status)
    assert remedy is not None
    at_work.set(remedy.path, remedy.value)
    settle(at_work)
    assert at_work.statuses().get(status, ("OK", ""))[0] == "OK"
