"""RobotModel as people see it: the demo robot, and real robots of all mesh formats."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from robots import DEMO, place_links, robots_folder

from webviz import Level
from webviz.api.views import Orbit
from webviz.shell.testing import Harness
from webviz_displays.grid import Grid
from webviz_displays.robot_model import RobotModel
from webviz_displays.robot_model.parts import LinkSettings

Stages = Callable[..., Harness]

# Each with a view of the whole of it: mirrored parts, textures, units and colours of all kinds.
ROBOTS: dict[str, tuple[str, Orbit]] = {
    # Collada: many parts of several colours each; with textures; with upper-case suffixes.
    "panda": ("panda_description/urdf/panda.urdf", Orbit(distance=1.9, focal_point=(0.1, 0, 0.45))),
    "ur5": ("ur_description/urdf/ur5_robot.urdf", Orbit(distance=1.6, focal_point=(0.4, 0.1, 0.1))),
    "anymal_b": ("anymal_b_simple_description/robots/anymal.urdf", Orbit(distance=1.7)),
    "go2": ("go2_description/urdf/go2.urdf", Orbit(distance=1.2, focal_point=(0, 0, -0.1))),
    "baxter": ("baxter_description/urdf/baxter.urdf", Orbit(distance=3.4, pitch=0.5)),
    # STL: mirrored by negative scales; colours of the URDF, some given inside a link.
    "talos": ("talos_data/robots/talos_reduced.urdf", Orbit(distance=2.4, pitch=0.3)),
    "pr2": ("pr2_description/urdf/pr2.urdf", Orbit(distance=2.8, focal_point=(0.2, 0, 0.6))),
    "allegro": ("allegro_hand_description/urdf/allegro_right_hand.urdf", Orbit(distance=0.5)),
    "g1": ("g1_description/urdf/g1_29dof_rev_1_0.urdf", Orbit(distance=1.9, pitch=0.3)),
    "tiago": (
        "tiago_description/robots/tiago.urdf",
        Orbit(distance=2.4, pitch=0.4, focal_point=(0.1, 0, 0.5)),
    ),
    # Wavefront.
    "laikago": ("laikago_description/urdf/laikago.urdf", Orbit(distance=1.5)),
}


def test_the_demo_robot_follows_its_properties(webviz_harness: Stages) -> None:
    view = Orbit(distance=1.1, yaw=0.7, pitch=0.4, focal_point=(0.0, 0.0, 0.1))
    harness = webviz_harness(RobotModel(), Grid(cell_size=0.1, plane_cell_count=8), view=view)
    place_links(harness, DEMO)
    harness.publish("/robot_description", "std_msgs/msg/String", {"data": DEMO.read_text()})
    harness.turn()
    harness.check_picture("robot_model/default")
    harness.set("alpha", 0.4)
    harness.check_picture("robot_model/alpha_0.4")
    harness.set("collision_enabled", True)
    harness.set("visual_enabled", False)
    harness.check_picture("robot_model/collision_shapes_of_alpha_0.4")
    harness.set("mass_properties.mass", True)
    harness.set("collision_enabled", False)
    harness.set("alpha", 1.0)
    harness.check_picture("robot_model/masses")
    harness.set("mass_properties.mass", False)
    harness.set("mass_properties.inertia", True)
    harness.check_picture("robot_model/inertias")
    harness.set("mass_properties.inertia", False)
    harness.set("visual_enabled", True)
    harness.set("links", {"base_link": LinkSettings(alpha=0.2, show_axes=True)})
    harness.check_picture("robot_model/one_link_of_alpha_0.2_with_axes")
    harness.set("all_links_enabled", False)
    harness.set("links", {"wheel_left_link": LinkSettings(), "base_scan": LinkSettings()})
    harness.check_picture("robot_model/two_links_only")


def test_links_without_a_transform_are_grey_where_they_were(webviz_harness: Stages) -> None:
    view = Orbit(distance=1.1, yaw=0.7, pitch=0.4, focal_point=(0.0, 0.0, 0.1))
    harness = webviz_harness(RobotModel(), Grid(cell_size=0.1, plane_cell_count=8), view=view)
    place_links(harness, DEMO)
    harness.publish("/robot_description", "std_msgs/msg/String", {"data": DEMO.read_text()})
    harness.settle()
    # The wheel's publisher now hangs it below an unconnected frame.
    harness.transform("axle", "wheel_left_link", stamp_ns=harness.source.now)
    harness.turn()
    harness.check_picture("robot_model/a_lost_wheel_is_grey")
    links = harness.statuses()["Links"]
    assert links.level is Level.ERROR
    assert "wheel_left_link" in links.text


@pytest.mark.parametrize("name", ROBOTS)
def test_real_robots_are_whole_and_coloured(webviz_harness: Stages, name: str) -> None:
    file, view = ROBOTS[name]
    path = robots_folder() / file
    robot = RobotModel(description_source="File", description_file=str(path))
    harness = webviz_harness(robot, view=view)
    place_links(harness, path)
    harness.check_picture(f"robot_model/robots/{name}")
    assert harness.statuses()["URDF"].level is Level.OK


def test_every_robot_has_a_picture_and_the_other_way_round() -> None:
    pictures = {path.stem for path in (Path(__file__).parent / "robot_model/robots").iterdir()}
    assert pictures == ROBOTS.keys()
