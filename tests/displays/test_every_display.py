"""Every built-in display has checks; what is invisible or switched off says so."""

from __future__ import annotations

import pytest
from built_in_checks import built_in_checks
from inspecting import Benches
from moveit_scenes import settle

from webviz.api.registry import display_types

CHECKS = built_in_checks()
DISPLAYS = {
    name: cls for name, cls in display_types().items() if cls.__module__.startswith("webviz_")
}


def test_every_display_has_checks_in_its_own_test_file() -> None:
    assert {cls.__name__ for cls in DISPLAYS.values()} == CHECKS.keys()


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
def test_alpha_0_hides_with_a_warning(bench: Benches, name: str, path: str, status: str) -> None:
    at_work = bench(CHECKS[name].display())
    CHECKS[name].publish(at_work)
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
def test_a_part_switched_off_warns_with_a_remedy(
    bench: Benches, name: str, off: dict[str, object], status: str
) -> None:
    at_work = bench(CHECKS[name].display())
    CHECKS[name].publish(at_work)
    for path, value in off.items():
        at_work.set(path, value)
    settle(at_work)
    assert at_work.statuses()[status][0] == "WARN"
    remedy = at_work.remedy(status)
    assert remedy is not None
    at_work.set(remedy.path, remedy.value)
    settle(at_work)
    assert at_work.statuses().get(status, ("OK", ""))[0] == "OK"
