"""The displays of MoveIt as people see them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from webviz import Topic
from webviz.api.views import Orbit
from webviz.shell.testing import Harness, turned
from webviz_displays.grid import Grid
from webviz_displays.moveit import (
    MotionPlanning,
    MotionPlanningTasks,
    PlanningScene,
    RobotState,
    Trajectory,
)
from webviz_displays.moveit.properties import PlannedPath, PlanningRequest, SceneRobot

LENGTHS = (0.5, 0.4, 0.3)


def arm() -> str:
    """An arm of three joints on a foot."""
    links = [
        '<link name="foot"><visual><origin xyz="0 0 0.05"/><geometry><cylinder radius="0.15" '
        'length="0.1"/></geometry><material name="dark"><color rgba="0.2 0.2 0.25 1"/></material>'
        "</visual></link>"
    ]
    joints, height = [], 0.1
    for number, length in enumerate(LENGTHS):
        color = "0.9 0.9 0.9 1" if number % 2 else "0.95 0.5 0.1 1"
        links.append(
            f'<link name="part{number}"><visual><origin xyz="0 0 {length / 2}"/><geometry>'
            f'<cylinder radius="{0.07 - 0.015 * number}" length="{length}"/></geometry>'
            f'<material name="c{number}"><color rgba="{color}"/></material></visual></link>'
        )
        parent = f"part{number - 1}" if number else "foot"
        joints.append(
            f'<joint name="turn{number}" type="revolute"><parent link="{parent}"/>'
            f'<child link="part{number}"/><origin xyz="0 0 {height}"/><axis xyz="0 1 0"/>'
            '<limit lower="-2" upper="2" effort="1" velocity="1"/></joint>'
        )
        height = length
    return f'<robot name="arm">{"".join(links + joints)}</robot>'


NAMES = [f"turn{number}" for number in range(3)]
START, GOAL = np.array((-0.9, 0.5, 0.4)), np.array((0.7, 0.6, 0.9))
HEADER = {"frame_id": "foot"}


def at(x: float, y: float, z: float, yaw: float = 0.0) -> dict[str, Any]:
    turn = dict(zip("xyzw", turned(yaw=yaw), strict=True))
    return {"position": {"x": x, "y": y, "z": z}, "orientation": turn}


def solid(name: str, kind: int, sizes: list[float], pose: dict[str, Any]) -> dict[str, Any]:
    shape = {"type": kind, "dimensions": sizes}
    return {"id": name, "header": HEADER, "pose": pose, "primitives": [shape]}


def state(values: np.ndarray) -> dict[str, Any]:
    rod = solid("rod", 3, [0.3, 0.02], at(0.0, 0.0, 0.3)) | {"header": {"frame_id": "part2"}}
    return {
        "joint_state": {"header": HEADER, "name": NAMES, "position": values},
        "attached_collision_objects": [{"link_name": "part2", "object": rod}],
    }


PYRAMID = {
    "vertices": np.array([(1, 1, 0), (-1, 1, 0), (-1, -1, 0), (1, -1, 0), (0, 0, 2)]) * 0.15,
    "triangles": np.array([(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)], np.uint32),
}
SCENE = {
    "name": "cell",
    "robot_state": state(START),
    "world": {
        "collision_objects": [
            solid("table", 1, [0.6, 1.2, 0.05], at(0.7, 0.0, 0.3)),
            solid("ball", 2, [0.1], at(0.6, -0.3, 0.425)),
            solid("can", 3, [0.25, 0.07], at(0.8, 0.1, 0.45)),
            solid("hat", 4, [0.25, 0.1], at(0.6, 0.4, 0.45)),
            {"id": "roof", "header": HEADER, "pose": at(-0.6, 0.6, 0), "meshes": [PYRAMID]},
        ]
    },
    "object_colors": [{"id": "ball", "color": {"r": 0.9, "g": 0.2, "b": 0.2, "a": 1.0}}],
}
PATH = {
    "trajectory_start": state(START),
    "trajectory": [
        {
            "joint_trajectory": {
                "joint_names": NAMES,
                "points": [
                    {"positions": START + share * (GOAL - START)} for share in np.linspace(0, 1, 9)
                ],
            }
        }
    ],
}
SOLUTION = {
    "start_scene": SCENE,
    "sub_trajectory": [
        {
            "info": {
                "id": 1,
                "markers": [
                    {
                        "header": HEADER,
                        "type": 2,
                        "pose": at(0.35, 0.0, 0.75),
                        "scale": {"x": 0.08, "y": 0.08, "z": 0.08},
                        "color": {"r": 1.0, "g": 0.8, "b": 0.0, "a": 1.0},
                    }
                ],
            },
            "trajectory": PATH["trajectory"][0],
            "scene_diff": {"is_diff": True, "robot_state": {"is_diff": True}},
        }
    ],
}
DISPLAY_STATE = {
    "state": state(GOAL),
    "highlight_links": [{"id": "part1", "color": {"r": 1.0, "g": 0.1, "b": 0.1, "a": 1.0}}],
}
URDF = Topic("/robot_description")


def test_each_display_has_a_picture_of_its_own(webviz_harness: Callable[..., Harness]) -> None:
    displays = {
        "planning_scene": PlanningScene(),
        "trajectory": Trajectory(paused=True, position=1.0, show_trail=True, trail_step_size=2),
        "robot_state": RobotState(),
        "motion_planning_tasks": MotionPlanningTasks(paused=True, show_trail=True),
        "motion_planning": MotionPlanning(
            scene_robot=SceneRobot(robot_alpha=0.3),
            planning_request=PlanningRequest(query_start_state=True, show_workspace=True),
            planned_path=PlannedPath(paused=True, position=0.5),
        ),
    }
    for display in displays.values():
        display.enabled = False
    view = Orbit(distance=3.2, yaw=-1.1, pitch=0.45, focal_point=(0.1, 0.0, 0.45))
    harness = webviz_harness(*displays.values(), Grid(plane_cell_count=4), view=view)
    harness.transform("map", "foot")
    for picture, display in displays.items():
        name = type(display).__name__
        harness.set("enabled", True, name)
        harness.publish("/robot_description", "std_msgs/msg/String", {"data": arm()})
        harness.publish("/monitored_planning_scene", "moveit_msgs/msg/PlanningScene", SCENE)
        harness.publish("/display_planned_path", "moveit_msgs/msg/DisplayTrajectory", PATH)
        harness.publish("/display_robot_state", "moveit_msgs/msg/DisplayRobotState", DISPLAY_STATE)
        harness.publish("/solution", "moveit_task_constructor_msgs/msg/Solution", SOLUTION)
        harness.settle()
        harness.wait_until_drawn(name)
        harness.check_picture(f"{picture}/default")
        harness.set("enabled", False, name)
