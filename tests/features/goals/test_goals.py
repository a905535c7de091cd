"""Goals of tools, from sending to their outcome, at a server that a test plays."""

from __future__ import annotations

import math
from typing import Any

import pytest
from bench import Bench, Benches

from webviz.api.status import Level, Status
from webviz.commands import CancelGoal, DismissGoal, Refresh, UseTool
from webviz.data.messages import encode
from webviz.features.goals import MAX_ACTIVE, SHOWN_S, GoalsFeature, Route
from webviz.features.goals.running import ANSWER_S, SILENCE_S, GoalProgress
from webviz.shell.testing.remembering_graph import RememberingGraph, SentGoal
from webviz.sources import Missing

TO_POSE = "nav2_msgs/action/NavigateToPose"
THROUGH = "nav2_msgs/action/NavigateThroughPoses"
EACH = "nav2_msgs/action/FollowWaypoints"
SUCCEEDED, CANCELED, ABORTED = 4, 5, 6
NAN = math.nan


class GoalServers:
    """A viewer, and the action servers that its goals go to."""

    def __init__(self, bench: Bench) -> None:
        self.bench = bench
        self.graph = bench.source.graph = RememberingGraph()
        self.statuses: list[Status] = []

    def drag(self, x: float = 1.0) -> SentGoal:
        """Send one pose; the goal at the server."""
        assert self.use(((x, 2.0, 0.0),)) == ""
        return self.graph.goals[-1]

    def use(self, points: Any, **gesture: Any) -> str:
        """Return why a gesture is refused, "" if it is not."""
        command = UseTool("Nav2 Goal", points, 0.5, **gesture, report=self.statuses.append)
        answer = self.bench.viewer.enqueue(command)
        self.bench.until_done(answer)
        return str(answer.exception(0) or "")

    def goals(self) -> list[GoalProgress]:
        """Return the goals that pages show now."""
        return list(self.bench.do(Refresh()).goals)

    def only(self) -> GoalProgress:
        (goal,) = self.goals()
        return goal

    def accept(self, goal: SentGoal) -> None:
        goal.accepted.set_result(True)
        self.goals()

    def outcome(self) -> tuple[Level, str]:
        goal = self.only()
        assert goal.phase == "ended"
        assert goal.status
        return goal.status.level, goal.status.text


@pytest.fixture
def robot(bench: Benches) -> GoalServers:
    return GoalServers(bench())


def end(goal: SentGoal, status: int, type: str = TO_POSE, **result: Any) -> None:
    values = {"status": status, "result": result}
    goal.result.set_result((status, encode(f"{type}_GetResult_Response", values)))


def feedback(goal: SentGoal, type: str = TO_POSE, **values: Any) -> None:
    goal.feedback(encode(f"{type}_FeedbackMessage", {"feedback": values}))


def test_a_pose_is_sent_to_nav2_in_the_fixed_frame_with_a_stamp_of_zero(robot: GoalServers) -> None:
    goal = robot.drag()
    assert (goal.action, goal.type) == ("/navigate_to_pose", TO_POSE)
    pose = goal.values.pose
    assert (pose.header.frame_id, pose.header.stamp.sec, goal.values.behavior_tree) == (
        "map",
        0,
        "",
    )
    assert (pose.pose.position.x, pose.pose.position.y) == (1.0, 2.0)
    assert pose.pose.orientation.z == pytest.approx(math.sin(0.25))
    progress = robot.only()
    assert (progress.phase, progress.title, progress.label) == (
        "sending",
        "Nav2 Goal",
        "x 1.00 y 2.00 m",
    )
    assert progress.poses == [(1.0, 2.0, 0.0, 0.5)]
    robot.accept(goal)
    assert robot.statuses == [Status(Level.OK, "/navigate_to_pose accepted the goal.")]
    assert robot.only().phase == "active"
    feature = robot.bench.viewer.get(GoalsFeature)
    assert list(feature.routes("").routes.values()) == [Route("map", [(1.0, 2.0, 0.0, 0.5)])]
    end(goal, SUCCEEDED)
    assert robot.outcome() == (Level.OK, "Reached the goal.")
    assert feature.routes("").routes == {}
    robot.bench.clock += SHOWN_S
    assert robot.goals() == []


def test_the_newest_of_many_feedbacks_is_shown_and_invalid_values_are_unknown(
    robot: GoalServers,
) -> None:
    goal = robot.drag()
    robot.accept(goal)
    for index in range(1000):
        feedback(
            goal,
            navigation_time={"sec": 65},
            estimated_time_remaining={"sec": 7500},
            distance_remaining=index / 100,
            number_of_recoveries=2,
        )
    values = {"Distance left": "10.0 m", "Time left": "2 h 05 min", "Time taken": "1 min 05 s"}
    assert robot.only().values == {**values, "Recoveries": "2"}
    feedback(goal, distance_remaining=NAN, estimated_time_remaining={"sec": -1})
    values = {
        "Distance left": "unknown",
        "Time left": "unknown",
        "Time taken": "0 s",
        "Recoveries": "0",
    }
    assert robot.only().values == values
    feedback(goal, distance_remaining=3e38, estimated_time_remaining={"sec": 2**31 - 1})
    assert robot.only().values == values
    robot.bench.clock += SILENCE_S + 1.0
    status = robot.only().status
    assert status == Status(Level.WARN, "No feedback for 6 s. Check /navigate_to_pose.")


@pytest.mark.parametrize(
    ("result", "expected"),
    [
        ({}, "/navigate_to_pose aborted the goal without a reason."),
        ({"error_code": 208}, "Aborted. Error 208: no valid path."),
        ({"error_code": 5, "error_msg": "No battery."}, "Aborted. Error 5: No battery."),
    ],
)
def test_an_aborted_goal_shows_its_reason_until_dismissed(
    robot: GoalServers, result: dict[str, Any], expected: str
) -> None:
    goal = robot.drag()
    robot.accept(goal)
    assert "Cancel it first" in robot.bench.refusal(DismissGoal(robot.only().id))
    end(goal, ABORTED, **result)
    assert robot.outcome() == (Level.ERROR, expected)
    robot.bench.clock += SHOWN_S
    robot.bench.do(DismissGoal(robot.only().id))
    assert robot.goals() == []


def test_a_goal_that_is_not_accepted_is_reported_to_its_sender_alone(robot: GoalServers) -> None:
    robot.drag().accepted.set_result(False)
    assert robot.goals() == []
    robot.drag().accepted.set_exception(Missing("No node offers /navigate_to_pose."))
    assert robot.goals() == []
    assert [status.text for status in robot.statuses] == [
        "/navigate_to_pose rejected the goal.",
        "No node offers /navigate_to_pose. Start Nav2's bt_navigator, or choose another action in "
        "the properties of the tool.",
    ]


def test_a_bag_refuses_goals_with_the_reason(bench: Benches) -> None:
    b, statuses = bench(), list[Status]()
    b.do(UseTool("Nav2 Goal", ((1.0, 2.0, 0.0),), report=statuses.append))
    assert statuses == [Status(Level.ERROR, "This source can only be read.")]
    assert b.do(Refresh()).goals == ()


def test_a_cancellation_is_requested_once_and_its_refusal_shown(robot: GoalServers) -> None:
    goal = robot.drag()
    for _ in range(2):
        robot.bench.do(CancelGoal(robot.only().id))
    assert goal.cancels == []  # not before it is accepted
    robot.accept(goal)
    assert robot.only().phase == "canceling"
    (canceled,) = goal.cancels
    canceled.set_result(1)
    assert robot.only().phase == "active"
    status = Status(Level.WARN, "/navigate_to_pose refuses to cancel the goal.")
    assert robot.only().status == status
    robot.bench.do(CancelGoal(robot.only().id))
    goal.cancels[-1].set_result(0)
    end(goal, CANCELED)
    assert robot.outcome() == (Level.OK, "Cancelled.")
    assert robot.bench.refusal(CancelGoal("goal99")) == "This goal has ended."


def test_a_goal_that_the_server_has_forgotten_ends_when_it_is_cancelled(robot: GoalServers) -> None:
    goal = robot.drag()
    robot.accept(goal)
    robot.bench.do(CancelGoal(robot.only().id))
    goal.cancels[-1].set_result(2)
    assert robot.only().phase == "canceling"
    robot.bench.clock += ANSWER_S + 0.1
    text = "/navigate_to_pose no longer knows this goal. Send it again."
    assert robot.outcome() == (Level.WARN, text)


def test_a_new_goal_replaces_the_previous_one_once_it_is_accepted(robot: GoalServers) -> None:
    first = robot.drag()
    robot.accept(first)
    rejected = robot.drag(2.0)
    assert [goal.phase for goal in robot.goals()] == ["active", "sending"]
    rejected.accepted.set_result(False)
    assert robot.only().label == "x 1.00 y 2.00 m"
    second = robot.drag(3.0)
    robot.accept(second)
    assert robot.only().label == "x 3.00 y 2.00 m"
    assert first.cancels == []  # the server preempts it
    end(second, SUCCEEDED)
    end(first, ABORTED)
    assert robot.outcome() == (Level.OK, "Reached the goal.")
    third = robot.drag()
    robot.accept(third)
    fourth = robot.drag()
    end(third, ABORTED)  # which arrives before the answer of the server
    assert [goal.phase for goal in robot.goals()] == ["sending"]
    robot.accept(fourth)
    assert robot.only().phase == "active"
    for _ in range(MAX_ACTIVE - 1):
        robot.drag()
    assert robot.use(((1.0, 2.0, 0.0),)) == "20 goals are active. Cancel one first."


def test_waypoints_go_to_the_action_of_their_button_after_the_previous_goal(
    robot: GoalServers,
) -> None:
    first = robot.drag()
    robot.accept(first)
    gesture = {"points": ((1.0, 0.0, 0.0), (2.0, 0.0, 0.5)), "yaws": (0.0, math.pi)}
    assert robot.use(**gesture, several="Drive through") == ""
    # At another action the previous goal has to end first.
    assert [goal.phase for goal in robot.goals()] == ["canceling", "sending"]
    assert len(first.cancels) == 1
    end(first, CANCELED)
    assert robot.only().label == "2 waypoints"
    through = robot.graph.goals[-1]
    assert through.action == "/navigate_through_poses"
    one, two = through.values.poses
    assert (two.header.frame_id, two.pose.position.z) == ("map", 0.5)
    assert (one.pose.orientation.w, two.pose.orientation.z) == pytest.approx((1.0, 1.0))
    robot.accept(through)
    feedback(through, THROUGH, number_of_poses_remaining=2)
    assert robot.only().values["Waypoints left"] == "2"
    end(through, SUCCEEDED, THROUGH)
    assert robot.outcome() == (Level.OK, "Drove through all 2 waypoints.")
    assert robot.use(**gesture, several="Stop at each") == ""
    each = robot.graph.goals[-1]
    robot.accept(each)
    feedback(each, EACH, current_waypoint=1)
    assert robot.only().values == {"Waypoint": "2 of 2"}
    end(each, SUCCEEDED, EACH, missed_waypoints=[{"index": 1, "error_code": 206}])
    text = "Succeeded. Missed waypoint 2: the goal is in an obstacle (206)."
    assert robot.outcome() == (Level.WARN, text)


def test_a_goal_that_succeeded_is_not_called_aborted(robot: GoalServers) -> None:
    goal = robot.drag()
    robot.accept(goal)
    end(goal, SUCCEEDED, error_code=208)
    assert robot.outcome() == (Level.WARN, "Succeeded. Error 208: no valid path.")


def test_malformed_answers_end_a_goal_or_are_its_status(robot: GoalServers) -> None:
    goal = robot.drag()
    robot.accept(goal)
    goal.feedback(b"no message")
    status = robot.only().status
    assert status
    assert status.text.startswith("The feedback of /navigate_to_pose cannot be read: ")
    robot.bench.do(CancelGoal(robot.only().id))
    goal.feedback(b"no message")
    goal.cancels[-1].set_exception(ValueError("Malformed."))
    goal.feedback(b"no message")
    assert robot.only().status == Status(Level.WARN, "Malformed.")
    goal.feedback(b"no message")
    goal.result.set_result((SUCCEEDED, b"\0\1\0\0"))
    level, text = robot.outcome()
    assert level is Level.ERROR
    assert text.startswith("The result of /navigate_to_pose cannot be read: ")
    robot.bench.do(DismissGoal(robot.only().id))
    robot.drag().accepted.set_exception(ValueError("Malformed."))
    assert robot.goals() == []
    assert robot.statuses[-1] == Status(Level.ERROR, "Malformed.")


def test_replaced_goals_do_not_count_and_are_cancelled_if_the_server_does_not_end_them(
    robot: GoalServers,
) -> None:
    goals = []
    for _ in range(MAX_ACTIVE + 2):
        goals.append(robot.drag())
        robot.accept(goals[-1])
    *replaced, last = goals
    assert not any(goal.cancels for goal in goals)
    robot.bench.clock += SILENCE_S + 0.1
    for _ in range(3):
        robot.goals()
        for goal in replaced:  # one that refuses is not asked in every turn
            if not goal.cancels[0].done():
                goal.cancels[0].set_result(1)
    assert [len(goal.cancels) for goal in goals] == [1] * len(replaced) + [0]
    robot.bench.clock += SILENCE_S + 0.1
    robot.goals()
    assert all(goal.result.cancelled() for goal in replaced)
    assert not last.result.cancelled()
    assert robot.only().phase == "active"


def test_a_cancellation_is_requested_again_from_a_restarted_server(robot: GoalServers) -> None:
    goal = robot.drag()
    robot.accept(goal)
    robot.bench.do(CancelGoal(robot.only().id))
    for code in (0, 3):  # TERMINATED also says that it is being cancelled
        goal.cancels[-1].set_result(code)
        robot.goals()
        robot.bench.clock += ANSWER_S + 0.1
        assert robot.only().phase == "canceling"
    assert len(goal.cancels) == 3
    goal.cancels[-1].set_result(2)
    robot.goals()
    robot.bench.clock += ANSWER_S + 0.1
    assert "no longer knows this goal" in robot.outcome()[1]
    assert goal.result.cancelled()


@pytest.mark.parametrize("code", [0, 1])
def test_a_goal_that_the_server_never_ends_can_be_dismissed(robot: GoalServers, code: int) -> None:
    goal = robot.drag()
    robot.accept(goal)
    id = robot.only().id
    robot.bench.do(CancelGoal(id))
    goal.cancels[-1].set_result(code)
    robot.bench.clock += SILENCE_S - 0.1
    assert not robot.only().can_dismiss
    assert "Cancel it first" in robot.bench.refusal(DismissGoal(id))
    robot.bench.clock += 0.2
    progress = robot.only()
    assert progress.can_dismiss
    assert progress.status
    assert ("does not end" if code == 0 else "refuses to cancel") in progress.status.text
    robot.bench.do(DismissGoal(id))
    assert robot.goals() == []
    assert goal.result.cancelled()


@pytest.mark.parametrize(
    ("points", "gesture"),
    [
        (((1e308, 0.0, 0.0),), {}),
        (((NAN, 0.0, 0.0),), {}),
        (((0.0, 0.0, 0.0),) * 1001, {"yaws": (0.0,) * 1001, "several": "Drive through"}),
        (((0.0, 0.0, 0.0),), {"yaws": (NAN,), "several": "Drive through"}),
        (((0.0, 0.0, 0.0),), {"yaws": (0.0, 1.0), "several": "Drive through"}),
        (((0.0, 0.0, 0.0),), {"yaws": (0.0,), "several": "Fly"}),
    ],
)
def test_poses_that_are_not_valid_are_refused(
    robot: GoalServers, points: Any, gesture: dict[str, Any]
) -> None:
    assert robot.use(points, **gesture).startswith("Nav2 Goal: ")
    assert robot.graph.goals == []
    assert robot.goals() == []
