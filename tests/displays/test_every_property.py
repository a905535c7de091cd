"""Every property of every built-in display changes what is drawn or said."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable, Iterator
from pathlib import Path as FilePath
from typing import Annotated, Any, Literal, get_args, get_origin, get_type_hints

import msgspec
import pytest
import trimesh
from display_scenes import SCENES
from moveit_scenes import settle

import webviz_displays
from webviz import Display, Topic
from webviz.api.declared import set_property
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
    ("Path", "buffer_length"),
    ("PoseHistory", "buffer_size"),
    ("Range", "buffer_length"),
    ("RobotModel", "update_interval"),
    ("TF", "update_interval"),
    ("Text", "update_interval"),
}

# What the page does with the scene that a display draws (tests/page/test_images.py), a choice
# that depends on the name of the topic (tests/displays/test_camera.py), and what shows only while
# time passes (tests/displays/test_planning_scene.py).
ELSEWHERE = {
    *((name, "scene_geometry.scene_display_time") for name in ("MotionPlanning", "PlanningScene")),
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
