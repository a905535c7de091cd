"""Tasks of MoveIt Task Constructor: their stages, and the solution that is played."""

from __future__ import annotations

from typing import Any, ClassVar

import pytest
from built_in_checks import BuiltInChecks
from display_messages import MESSAGES as SCENE_MESSAGES
from display_scenes import OTHER_LINKS
from inspecting import Benches
from moveit_scenes import NUMBERS, SOLUTION, TASK, plan_task

from webviz.shell.testing import DisplayBench, check_details
from webviz_displays.moveit import MotionPlanningTasks
from webviz_displays.moveit.planning_tasks import SolutionMarkers

MESSAGES = "moveit_task_constructor_msgs/msg"


def tell(at: DisplayBench, type_name: str, values: dict[str, Any], topic: str) -> None:
    at.send(f"{MESSAGES}/{type_name}", values, topic=topic)
    at.turn()


def markers(at: DisplayBench) -> list[float]:
    """Return the positions of the solution's markers along x."""
    return sorted(
        round(float(x), 3)
        for key, node in at.nodes().items()
        if key.startswith("box in")
        for x in node.positions[:, 0] + at.poses()[key].position[0]
    )


@pytest.fixture
def planned(bench: Benches) -> DisplayBench:
    """A task with a solution of two parts of four points; the first one is shown."""
    at = bench(MotionPlanningTasks(paused=True, position=0.0))
    plan_task(at)
    return at


def test_stages_are_a_tree_with_their_numbers_of_solutions(planned: DisplayBench) -> None:
    statuses = planned.statuses()
    assert statuses["1 pick"] == ("OK", "2 solutions.")
    assert statuses["1.1 approach"] == ("OK", "1 solution, 1 failed, 0.50 s.")
    assert statuses["1.2 grasp"] == ("OK", "0 solutions, 9 failed.")
    offered = planned.runner.report().offered
    assert offered["stages"] == {"1 pick": 2, "1.1 approach": 1, "1.2 grasp": 0}
    assert offered["solution"] == {"7: pick": 7, "8: pick": 8, "5: approach": 5}


def test_each_part_of_a_solution_has_the_scene_that_the_one_before_led_to(
    planned: DisplayBench,
) -> None:
    assert planned.statuses()["Solution"] == ("OK", "Solution 7: 2 parts, cost 1.5.")
    for position, stage, x, objects, hint in (
        (0.0, "Part 1 of 2: 'approach'.", 3.0, 2, 5.0),
        (1.0, "Part 2 of 2: 'grasp'.", 14.0, 1, 11.0),
    ):
        planned.set("position", position)
        statuses = planned.statuses()
        assert statuses["Stage"] == ("OK", stage)
        assert statuses["Scene"][1].startswith(f"'cell': {objects} object")
        assert planned.poses()["path rider visual visual_0"].position[0] == x
        assert markers(planned) == [hint]


def test_markers_are_those_of_the_part_or_of_all(planned: DisplayBench) -> None:
    planned.set("markers.all_at_once", True)
    assert markers(planned) == [6.0, 11.0]
    planned.set("markers.show_markers", False)
    assert markers(planned) == []


def test_a_chosen_solution_is_requested_from_its_task(planned: DisplayBench) -> None:
    planned.set("solution", 8)
    planned.settle()
    assert planned.statuses()["Solution"] == ("OK", "Solution 7: 1 part, cost 1.5.")
    del planned.graph.responses["/get_solution_robot_1"]
    planned.set("solution", 5)
    planned.settle()
    level, text = planned.statuses()["Solution"]
    assert level == "WARN"
    assert text.startswith("Solution 5: No node offers /get_solution_robot_1.")


def test_a_task_that_begins_again_forgets_its_solution(planned: DisplayBench) -> None:
    tell(planned, "TaskDescription", {"task_id": "robot_1"}, "/description")
    statuses = planned.statuses()
    assert "1 pick" not in statuses
    assert statuses["Solution"] == (
        "WARN",
        "No solution received on /solution. Plan a task, or choose one.",
    )
    planned.set("solution", 7)
    assert statuses["Solution"][0] == "WARN"
    assert planned.statuses()["Solution"][1].startswith("No task is known that has solution 7.")


def test_stages_that_name_each_other_or_nothing_are_listed_at_most_once(bench: Benches) -> None:
    at = bench(MotionPlanningTasks(markers=SolutionMarkers()))
    stages = [
        {"id": 1, "parent_id": 2, "name": "a"},
        {"id": 2, "parent_id": 1, "name": "b"},
        {"id": 3, "parent_id": 99, "name": "c"},
        {"id": 3, "parent_id": 3, "name": "d"},
    ]
    tell(at, "TaskStatistics", NUMBERS, "/statistics")
    tell(at, "TaskDescription", TASK | {"stages": stages}, "/description")
    assert {key for key in at.statuses() if key[:1].isdigit()} == {"1 c", "2 d"}


def test_an_answer_without_a_solution_is_a_warning(planned: DisplayBench) -> None:
    service = "moveit_task_constructor_msgs/srv/GetSolution"
    planned.serve("/get_solution_robot_1", service, {"solution": SOLUTION | {"task_id": ""}})
    planned.set("solution", 5)
    planned.settle()
    text = "Solution 5: The task no longer has it. Choose another."
    assert planned.statuses()["Solution"] == ("WARN", text)


class TestMotionPlanningTasks(BuiltInChecks):
    display = MotionPlanningTasks
    scene = plan_task
    messages = SCENE_MESSAGES
    later = ("interrupt_display", "loop_animation", "state_display_time", "use_sim_time")
    needs: ClassVar = {
        "interrupt_display": {"state_display_time": "3x", "use_sim_time": True},
        "state_display_time": {"use_sim_time": True},
        "trail_step_size": {"paused": True},
        "loop_animation": {
            "state_display_time": "3x",
            "use_sim_time": True,
            "interrupt_display": True,
        },
        "paused": {"state_display_time": "3x"},
        "use_sim_time": {"state_display_time": "3x"},
    }
    values: ClassVar = {"robot.links": OTHER_LINKS}


def test_selecting_link_of_a_solution(bench: Benches) -> None:
    at = bench(MotionPlanningTasks(paused=True))
    plan_task(at)
    check_details(
        at.pick("path rider visual visual_0", None, (0.0, 0.0, 0.0)),
        "Link rider",
        {"Point": "Point 8 of 8 points, at 6000.00 s", "Robot": "rail"},
    )


def test_selecting_marker_of_a_solution(bench: Benches) -> None:
    at = bench(MotionPlanningTasks(paused=True))
    plan_task(at)
    check_details(at.pick("box in 0", 0), "Marker far/0", {"Type": "CUBE"})
