"""Where a display can go in the list."""

from __future__ import annotations

from webviz.edges.gui.moves import Moves, Place, moves_of
from webviz.engine.commands import MoveDisplay

LIST = (
    Place("grid", 0, "Grid"),
    Place("robot", 0, "Group"),
    Place("model", 1, "RobotModel"),
    Place("sensors", 1, "Group"),
    Place("scan", 2, "LaserScan"),
    Place("tf", 1, "TF"),
    Place("map", 0, "Map"),
)


def test_up_and_down_pass_over_whole_groups() -> None:
    assert moves_of("map", LIST).up == MoveDisplay("map", "", "robot")
    assert moves_of("grid", LIST).down == MoveDisplay("grid", "", "map")
    assert moves_of("robot", LIST).down == MoveDisplay("robot", "", "")
    assert moves_of("tf", LIST).up == MoveDisplay("tf", "robot", "sensors")
    assert moves_of("model", LIST).down == MoveDisplay("model", "robot", "tf")


def test_the_first_cannot_go_up_nor_the_last_down() -> None:
    assert moves_of("grid", LIST).up is None
    assert moves_of("map", LIST).down is None
    assert moves_of("model", LIST).up is None
    assert moves_of("tf", LIST).down is None


def test_into_is_the_nearest_group_above_or_else_below() -> None:
    assert moves_of("map", LIST).into == MoveDisplay("map", "robot")
    assert moves_of("grid", LIST).into == MoveDisplay("grid", "robot")
    assert moves_of("tf", LIST).into == MoveDisplay("tf", "sensors")
    assert moves_of("scan", LIST).into is None
    assert moves_of("robot", LIST).into is None


def test_out_is_right_behind_the_group() -> None:
    assert moves_of("scan", LIST).out == MoveDisplay("scan", "robot", "tf")
    assert moves_of("model", LIST).out == MoveDisplay("model", "", "map")
    assert moves_of("map", LIST).out is None
    assert moves_of("b", (Place("a", 0, "Group"), Place("b", 1, "Grid"))).out == MoveDisplay("b")


def test_what_is_not_in_the_list_goes_nowhere() -> None:
    assert moves_of("gone", LIST) == Moves()
