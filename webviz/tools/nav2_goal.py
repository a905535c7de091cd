"""The tool that lets Nav2 drive the robot, by its actions."""

from __future__ import annotations

import functools
from typing import Annotated, Any

from webviz.api.declared import Prop
from webviz.api.tool import Confirm, Gesture, Tool, ToolContext

THROUGH, EACH = "Drive through", "Stop at each"

ERRORS = {
    100: "unknown error of the controller",
    101: "invalid controller",
    102: "missing transform",
    103: "invalid path",
    104: "the controller lost patience",
    105: "the robot makes no progress",
    106: "the controller finds no valid command",
    107: "the controller took too long",
    200: "unknown error of the planner",
    201: "invalid planner",
    202: "missing transform",
    203: "the robot is outside the map",
    204: "the goal is outside the map",
    205: "the robot is in an obstacle",
    206: "the goal is in an obstacle",
    207: "the planner took too long",
    208: "no valid path",
    600: "unknown error of the waypoint follower",
    601: "the task at a waypoint failed",
    602: "no valid waypoints",
    603: "a waypoint was missed",
}
"""Error codes of Nav2 in words."""
EARTH_M = 4e7
"""Circumference of the earth; no robot drives farther."""
FOREVER_S = 2**31 - 1
"""The longest builtin_interfaces/Duration, which servers send for an unknown one."""


class Nav2Goal(Tool):
    """Let Nav2 drive the robot to a pose: press at the position, drag towards the heading.

    All pages show the progress, and every operator can cancel it. With Shift held, or after a click
    on Waypoints, poses are collected and then sent together, to drive through them or to stop at
    each. With Ctrl held, moving the pointer up lifts a pose.
    """

    title = "Nav2 Goal"
    rviz = "nav2_rviz_plugins/GoalTool"
    shortcut = "g"
    order = 4
    icon = "flag"
    gesture = "pose"
    several = (THROUGH, EACH)

    navigate_to_pose: Annotated[str, Prop(help="Action for one pose (NavigateToPose).")] = (
        "/navigate_to_pose"
    )
    navigate_through_poses: Annotated[
        str, Prop(help="Action to drive through poses (NavigateThroughPoses).")
    ] = "/navigate_through_poses"
    follow_waypoints: Annotated[
        str, Prop(help="Action to stop at each pose (FollowWaypoints).")
    ] = "/follow_waypoints"
    behavior_tree: Annotated[
        str, Prop(help="File of the behavior tree on the robot; empty for Nav2's default.")
    ] = ""
    confirm: Confirm = False

    @property
    def uses(self) -> tuple[str, ...]:
        """Its actions."""
        return self.navigate_to_pose, self.navigate_through_poses, self.follow_waypoints

    def done(self, gesture: Gesture, ctx: ToolContext) -> None:
        """Send the goal in the fixed frame. Like RViz's, its stamp is 0: the newest transform."""
        poses = [{"header": {"frame_id": ctx.fixed_frame}, "pose": p} for p in gesture.poses]
        x, y = (round(value, 2) + 0.0 for value in gesture.position[:2])  # no -0.00
        label = f"{len(poses)} waypoints" if gesture.several else f"x {x:.2f} y {y:.2f} m"
        send = functools.partial(
            ctx.send_goal, label=label, gesture=gesture, feedback=progress, fault=_fault
        )
        if gesture.several == EACH:
            send(
                self.follow_waypoints,
                "nav2_msgs/action/FollowWaypoints",
                {"poses": poses},
                feedback=functools.partial(at_waypoint, len(poses)),
                success=f"Stopped at all {len(poses)} waypoints.",
                remedy=_remedy("waypoint_follower"),
            )
        elif gesture.several == THROUGH:
            send(
                self.navigate_through_poses,
                "nav2_msgs/action/NavigateThroughPoses",
                {"poses": poses, "behavior_tree": self.behavior_tree},
                success=f"Drove through all {len(poses)} waypoints.",
                remedy=_remedy("bt_navigator"),
            )
        else:
            send(
                self.navigate_to_pose,
                "nav2_msgs/action/NavigateToPose",
                {"pose": poses[0], "behavior_tree": self.behavior_tree},
                success="Reached the goal.",
                remedy=_remedy("bt_navigator"),
            )


def _remedy(node: str) -> str:
    return f"Start Nav2's {node}, or choose another action in the properties of the tool."


def progress(feedback: Any) -> dict[str, str]:
    """Return the progress in the feedback of NavigateToPose and NavigateThroughPoses."""
    left = feedback.distance_remaining
    values = {
        "Distance left": f"{left:.1f} m" if 0.0 <= left <= EARTH_M else "unknown",
        "Time left": _time(feedback.estimated_time_remaining),
        "Time taken": _time(feedback.navigation_time),
        "Recoveries": str(feedback.number_of_recoveries),
    }
    poses_left = getattr(feedback, "number_of_poses_remaining", None)
    return values if poses_left is None else {"Waypoints left": str(poses_left), **values}


def at_waypoint(count: int, feedback: Any) -> dict[str, str]:
    """Return the progress in the feedback of FollowWaypoints."""
    return {"Waypoint": f"{feedback.current_waypoint + 1} of {count}"}


def _time(duration: Any) -> str:
    if not 0 <= duration.sec < FOREVER_S:
        return "unknown"
    minutes, seconds = divmod(duration.sec, 60)
    hours, minutes = divmod(minutes, 60)
    if hours:
        return f"{hours} h {minutes:02} min"
    return f"{minutes} min {seconds:02} s" if minutes else f"{seconds} s"


def _fault(result: Any) -> str:
    """Return the fault in a result; "" for none."""
    missed = getattr(result, "missed_waypoints", ())
    if len(missed):
        numbers = ", ".join(str(each.index + 1) for each in missed[:10])
        numbers += ", ..." if len(missed) > 10 else ""
        reasons = " and ".join(dict.fromkeys(_error(each.error_code) for each in missed[:10]))
        return f"Missed {'waypoint' if len(missed) == 1 else 'waypoints'} {numbers}: {reasons}."
    code = result.error_code
    if result.error_msg:
        return f"Error {code}: {result.error_msg}"
    return f"Error {code}: {ERRORS.get(code, 'without a reason')}." if code else ""


def _error(code: int) -> str:
    return f"{ERRORS.get(code, 'error')} ({code})"
