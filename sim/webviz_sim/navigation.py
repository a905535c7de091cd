"""Nav2's actions for the simulated robot: navigate_to_pose and two for several poses."""

import functools
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from rclpy.node import Node
from std_srvs.srv import Trigger

from webviz.data.messages import decode, interfaces
from webviz.ros.types import service_class, to_cdr
from webviz_sim import messages
from webviz_sim.action_server import ActionServer, ServerGoal, response_of
from webviz_sim.messages import stamp, to_map_pose
from webviz_sim.pose import Pose2D
from webviz_sim.simulation import Simulation

MANAGE = "nav2_msgs/srv/ManageLifecycleNodes"
MANAGER = "lifecycle_manager_navigation"
STARTUP, PAUSE, RESUME, RESET, SHUTDOWN, CONFIGURE, CLEANUP = range(7)
"""Commands of `MANAGE`."""
_STEPS = {
    ("unconfigured", STARTUP): "active",
    ("unconfigured", CONFIGURE): "inactive",
    ("inactive", STARTUP): "active",
    ("inactive", RESUME): "active",
    ("inactive", CLEANUP): "unconfigured",
    ("inactive", RESET): "unconfigured",
    ("active", PAUSE): "inactive",
    ("active", RESET): "unconfigured",
}


class Lifecycle:
    """Lifecycle of the navigation, as clients decide; it starts active.

    Args:
        node: The node that offers the services.
        left: Called when it stops being active.
    """

    def __init__(self, node: Node, left: Callable[[], None]) -> None:
        self._state = "active"
        self._left = left
        manage = service_class(MANAGE)
        node.create_service(Trigger, f"{MANAGER}/is_active", self._answer)
        node.create_service(manage, f"{MANAGER}/manage_nodes", self._manage)

    @property
    def is_active(self) -> bool:
        """Return whether goals are accepted."""
        return self._state == "active"

    def _answer(self, request: Any, response: Any) -> Any:
        response.success = self.is_active
        return response

    def _manage(self, request: Any, response: Any) -> Any:
        parts = interfaces.service(MANAGE)
        is_done = self._step(decode(parts.request, to_cdr(request)).command)
        return response_of(parts.response, {"success": is_done}, type(response))

    def _step(self, command: int) -> bool:
        """Carry out a command, if the state allows it."""
        step = _STEPS.get((self._state, command))
        if command == SHUTDOWN and self._state != "finalized":
            step = "finalized"
        if step is None:
            return False
        was_active, self._state = self.is_active, step
        if was_active:
            self._left()
        return True


TO_POSE, THROUGH_POSES, WAYPOINTS = "navigate_to_pose", "navigate_through_poses", "follow_waypoints"
ACTIONS = {
    TO_POSE: "nav2_msgs/action/NavigateToPose",
    THROUGH_POSES: "nav2_msgs/action/NavigateThroughPoses",
    WAYPOINTS: "nav2_msgs/action/FollowWaypoints",
}

# Nav2's error codes.
STUCK, TF_ERROR, OUTSIDE, OCCUPIED, NO_PATH = 105, 202, 204, 206, 208


@dataclass
class _Task:
    """Task of the robot for a goal of a client."""

    action: str
    goal: ServerGoal
    poses: list[Any]
    began: float
    """Simulated time."""
    at: int = 0
    """The pose that it drives to."""
    target: Pose2D | None = None
    """The same in the map; None before it sets out."""
    missed: list[dict[str, Any]] = field(default_factory=list)


class Navigation:
    """Serves Nav2's actions with the goals of a simulation, one at a time.

    As in Nav2, a new goal of the same action replaces the active one, which is aborted, and a goal
    of another action is rejected meanwhile, as all are while the lifecycle manager has the
    navigation inactive. Loops of waypoints are ignored.

    Args:
        node: The node that serves them.
        simulation: Drives the robot.
    """

    def __init__(self, node: Node, simulation: Simulation) -> None:
        self._simulation = simulation
        self._task: _Task | None = None
        self._lifecycle = Lifecycle(node, self._stop)
        for name, type in ACTIONS.items():
            accept = functools.partial(self._accept, name)
            ActionServer(node, name, type, accept, functools.partial(self._begin, name))

    def step(self) -> None:
        """Advances the goal after a step of the simulation."""
        task, simulation = self._task, self._simulation
        if task is None:
            return
        if task.goal.is_canceling:
            simulation.stop()
            self._task = None
            task.goal.cancel({})
        elif task.target is None:
            self._set_out(task)
        elif simulation.goal is task.target:
            task.goal.report(self._feedback(task))
        elif simulation.reached is task.target:
            self._next(task)
        else:
            self._fail(task, STUCK, "The robot makes no progress, or something else moves it.")

    def _accept(self, action: str, request: Any) -> bool:
        is_free = self._task is None or self._task.action == action
        return self._lifecycle.is_active and is_free and bool(len(_poses(action, request)))

    def _begin(self, action: str, goal: ServerGoal) -> None:
        if self._task is not None:
            self._task.goal.abort({})
        poses = list(_poses(action, goal.request))
        self._task = _Task(action, goal, poses, self._simulation.time)

    def _stop(self) -> None:
        """End the goal: the navigation is not active any more."""
        if self._task is not None:
            self._simulation.stop()
            self._task.goal.abort({})
            self._task = None

    def _set_out(self, task: _Task) -> None:
        pose = task.poses[task.at]
        target = to_map_pose(pose.header, pose.pose)
        if isinstance(target, str):
            self._fail(task, TF_ERROR, f"A pose {target}.")
        elif (is_free := self._is_free(target)) is None:
            self._fail(task, OUTSIDE, "The goal is outside the map.")
        elif not is_free:
            self._fail(task, OCCUPIED, "The goal is in an obstacle or in unknown space.")
        elif self._simulation.go_to(target, turn=_stops(task)):
            task.target = target
        else:
            self._fail(task, NO_PATH, "No path to the goal.")

    def _is_free(self, pose: Pose2D) -> bool | None:
        """Return whether a pose is in known free space, None outside the map."""
        free = self._simulation.world.traversable
        x, y, _ = self._simulation.world.to_grid(pose)
        height, width = free.shape
        return bool(free[int(y), int(x)]) if 0 <= x < width and 0 <= y < height else None

    def _next(self, task: _Task) -> None:
        task.at, task.target = task.at + 1, None
        if task.at == len(task.poses):
            self._task = None
            task.goal.succeed({"missed_waypoints": task.missed} if task.missed else {})

    def _fail(self, task: _Task, code: int, reason: str) -> None:
        """Aborts the goal; waypoints are skipped instead, and reported at the end."""
        if task.action == WAYPOINTS and task.at < len(task.poses):
            missed = {"index": task.at, "goal": task.poses[task.at], "error_code": code}
            task.missed.append(missed)
            return self._next(task)
        self._task = None
        task.goal.abort({"error_code": code, "error_msg": reason})
        return None

    def _feedback(self, task: _Task) -> dict[str, Any]:
        if task.action == WAYPOINTS:
            return {"current_waypoint": task.at}
        simulation = self._simulation
        later = [pose.pose.position for pose in task.poses[task.at + 1 :]]
        points = np.array([*simulation.path, *((point.x, point.y) for point in later)])
        distance = float(np.hypot(*np.diff(points, axis=0).T).sum())
        now = round(simulation.time * 1e9)
        here = messages.planar("map", "base_link", now, simulation.robot.pose)
        values = {
            "current_pose": {
                "header": {"stamp": stamp(now), "frame_id": "map"},
                "pose": {"position": here.translation, "orientation": here.rotation},
            },
            "navigation_time": stamp(round((simulation.time - task.began) * 1e9)),
            "estimated_time_remaining": stamp(
                round(distance / simulation.settings.tour_speed * 1e9)
            ),
            "distance_remaining": distance,
        }
        if task.action == THROUGH_POSES:
            values["number_of_poses_remaining"] = len(task.poses) - task.at
        return values


def _poses(action: str, request: Any) -> Any:
    return [request.pose] if action == TO_POSE else request.poses


def _stops(task: _Task) -> bool:
    """Return whether it takes the heading of the pose that it drives to, too."""
    return task.action != THROUGH_POSES or task.at == len(task.poses) - 1
