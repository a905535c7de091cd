"""Messages for the displays of MoveIt, in which every property has something to change."""

from __future__ import annotations

import time
from typing import Any

from octrees import full, octree
from waiting import until

from webviz.shell.testing import DisplayBench

URDF = """
<robot name="rail">
  <link name="base">
    <visual><geometry><box size="1 1 1"/></geometry></visual>
    <collision><geometry><sphere radius="1"/></geometry></collision>
  </link>
  <link name="rider"><visual><geometry><box size="1 1 1"/></geometry></visual></link>
  <link name="hand"><visual><geometry><box size="1 1 1"/></geometry></visual></link>
  <joint name="slide" type="prismatic">
    <parent link="base"/><child link="rider"/><limit lower="0" upper="9" effort="1" velocity="1"/>
  </joint>
  <joint name="grip" type="fixed"><parent link="rider"/><child link="hand"/></joint>
</robot>
"""
UNTURNED = {"w": 1.0}


def at(x: float) -> dict[str, Any]:
    return {"position": {"x": x}, "orientation": UNTURNED}


def state(position: float, *objects: dict[str, Any]) -> dict[str, Any]:
    joints = {"header": {"frame_id": "base"}, "name": ["slide"], "position": [position]}
    return {"joint_state": joints, "attached_collision_objects": [*objects]}


def box(name: str, x: float, frame: str = "base") -> dict[str, Any]:
    cube = {"type": 1, "dimensions": [0.2, 0.2, 0.2]}
    return {"id": name, "header": {"frame_id": frame}, "pose": at(x), "primitives": [cube]}


ROOT = octree([(0, 0, 0), (3, 0, 5)])
ROOT.place((9, 0, 0), log_odds=-2.0)
TREE = full(ROOT)
ATTACHED_CUP = {"link_name": "rider", "object": box("cup", 0.5, "rider")}
SCENE = {
    "name": "cell",
    "robot_state": state(1.0, ATTACHED_CUP),
    "world": {
        "collision_objects": [box("table", 2.0), box("door", 3.0)],
        "octomap": {"header": {"frame_id": "base"}, "octomap": TREE},
    },
    "object_colors": [{"id": "door", "color": {"g": 1.0, "a": 0.5}}],
}
PATH = {
    "trajectory_start": state(1.0, ATTACHED_CUP),
    "trajectory": [
        {
            "joint_trajectory": {
                "joint_names": ["slide"],
                "points": [
                    {"positions": [place], "time_from_start": {"sec": 1000 * number}}
                    for number, place in enumerate((1.0, 1.5, 2.0, 12.0))
                ],
            }
        }
    ],
}
HINT = {
    "header": {"frame_id": "base"},
    "ns": "goal",
    "type": 1,
    "pose": at(4.0),
    "scale": {"x": 0.1, "y": 0.1, "z": 0.1},
    "color": {"r": 1.0, "a": 1.0},
}
SOLUTION = {
    "task_id": "robot_1",
    "start_scene": SCENE,
    "sub_solution": [{"info": {"id": 7, "cost": 1.5, "stage_id": 1}}],
    "sub_trajectory": [
        {
            "info": {"id": 5, "stage_id": 2, "markers": [HINT]},
            "trajectory": PATH["trajectory"][0],
            "scene_diff": {
                "is_diff": True,
                "robot_state": {"is_diff": True},
                "world": {"collision_objects": [{"id": "door", "operation": 1}]},
            },
        },
        {
            "info": {"id": 6, "stage_id": 3, "markers": [HINT | {"ns": "far", "pose": at(9.0)}]},
            "trajectory": PATH["trajectory"][0],
            "scene_diff": {"is_diff": True, "robot_state": {"is_diff": True}},
        },
    ],
}
TASK = {
    "task_id": "robot_1",
    "stages": [
        {"id": 1, "name": "pick"},
        {"id": 2, "parent_id": 1, "name": "approach"},
        {"id": 3, "parent_id": 1, "name": "grasp"},
    ],
}
NUMBERS = {
    "task_id": "robot_1",
    "stages": [
        {"id": 1, "solved": [7, 8]},
        {"id": 2, "solved": [5], "failed": [4], "total_compute_time": 0.5},
        {"id": 3, "num_failed": 9},
    ],
}
DISPLAY_STATE = {
    "state": state(1.0, ATTACHED_CUP),
    "highlight_links": [{"id": "base", "color": {"r": 1.0, "a": 0.5}}],
}

MOVEIT_MESSAGES: dict[str, dict[str, Any]] = {
    "moveit_msgs/msg/PlanningScene": SCENE,
    "moveit_msgs/msg/DisplayTrajectory": PATH,
    "moveit_msgs/msg/DisplayRobotState": DISPLAY_STATE,
    "moveit_msgs/msg/RobotState": state(1.0),
    "moveit_task_constructor_msgs/msg/Solution": SOLUTION,
    "moveit_task_constructor_msgs/msg/TaskDescription": TASK,
    "moveit_task_constructor_msgs/msg/TaskStatistics": NUMBERS,
}
"""A message of each type that draws something."""


def moveit(bench: DisplayBench) -> None:
    """All that MoveIt sends about a robot; a path of 1000 s at the default speed, twice."""
    bench.transform("map", "base", (1.0, 0.0, 0.0))
    whole = {"scene": {"world": {"collision_objects": [box("wall", 5.0)]}}}
    bench.serve("/robot/get_planning_scene", "moveit_msgs/srv/GetPlanningScene", whole)
    bench.send("std_msgs/msg/String", {"data": URDF}, topic="robot_description")
    settle(bench)
    scene = SCENE | {"is_diff": True}
    topics = {
        "/monitored_planning_scene": ("moveit_msgs/msg/PlanningScene", scene),
        "/display_planned_path": ("moveit_msgs/msg/DisplayTrajectory", PATH),
        "display_robot_state": ("moveit_msgs/msg/DisplayRobotState", DISPLAY_STATE),
    }
    for topic, (type_name, values) in topics.items():
        bench.send(type_name, values, topic=topic)
    # The link that leaves a trail moves.
    for x in (1.0, 1.5, 2.0):
        bench.transform("map", "base", (x, 0.0, 0.0))
        bench.turn(100.0)
    bench.send("moveit_msgs/msg/DisplayTrajectory", PATH, topic="/display_planned_path")
    diff = {"robot_state": state(4.0) | {"is_diff": True}, "is_diff": True}
    bench.send("moveit_msgs/msg/PlanningScene", diff, topic="/monitored_planning_scene")
    for seconds in (0.0, 900.0, 400.0):
        bench.turn(seconds)
    after = time.monotonic() + 0.02  # of which half is the time that a scene stays
    while time.monotonic() < after:
        time.sleep(0.002)
        bench.turn()
    settle(bench)


def plan_task(bench: DisplayBench) -> None:
    """A task with two solutions; in simulated time, another one while the newest is played."""
    bench.transform("map", "base", (1.0, 0.0, 0.0))
    other = SOLUTION | {"sub_trajectory": SOLUTION["sub_trajectory"][1:]}
    service = "moveit_task_constructor_msgs/srv/GetSolution"
    bench.serve("/get_solution_robot_1", service, {"solution": other})
    bench.send("std_msgs/msg/String", {"data": URDF}, topic="robot_description")
    settle(bench)
    for topic, type_name, values in (
        ("/description", "TaskDescription", TASK),
        ("/statistics", "TaskStatistics", NUMBERS),
        ("/solution", "Solution", SOLUTION),
    ):
        bench.send(f"moveit_task_constructor_msgs/msg/{type_name}", values, topic=topic)
    for x in (1.0, 1.5, 2.0):  # of the link that leaves a trail
        bench.transform("map", "base", (x, 0.0, 0.0))
        bench.turn(100.0)
    display: Any = bench.display
    if display.use_sim_time:
        bench.send("moveit_task_constructor_msgs/msg/Solution", SOLUTION, topic="/solution")
    for seconds in (0.0, 2100.0, 400.0):
        bench.turn(seconds)
    settle(bench)
    if display.state_display_time == "0.05 s" and not (
        display.use_sim_time or display.paused or display.loop_animation
    ):
        while "Point 8 of 8" not in bench.statuses()["Path"][1]:  # in 0.4 s
            time.sleep(0.01)
            bench.turn()


def settle(bench: DisplayBench) -> None:
    """Let slow work finish."""
    bench.turn()
    until(
        lambda: "Loading" not in bench.statuses() and not bench.runner.is_busy(),
        bench.statuses,
        turn=bench.turn,
    )
