"""Groups: displays that are switched together, in the config, the frame loop and the list."""

from __future__ import annotations

import pytest
from bench import Bench, Benches

from webviz.api.group import DisplayGroup
from webviz.commands import AddDisplay, RemoveDisplay, SetProperty
from webviz.files.config import Branch, ConfigError, Unreadable, dump
from webviz.files.opening import parse
from webviz_displays.axes import Axes

NESTED = """\
version: 1
displays:
- {type: Grid}
- type: Group
  name: Robot
  displays:
  - {type: TF}
  - type: Group
    name: Inner
    enabled: false
    displays:
    - {type: Axes, length: 2.0}
    - {type: Nonsense}
- {type: Path}
"""


def names(b: Bench) -> list[tuple[str, int]]:
    b.turn()
    return [(row.name, row.depth) for row in b.states[-1].rows]


def test_groups_come_back_from_a_file_as_they_were() -> None:
    config = parse(NESTED, "x.yaml")
    _, robot, _ = config.displays
    assert isinstance(robot, Branch)
    assert robot.group.name == "Robot"
    assert dump(parse(dump(config), "x.yaml")) == dump(config) == NESTED


def test_a_bad_entry_in_a_group_names_its_whole_path() -> None:
    robot = parse(NESTED, "x.yaml").displays[1]
    assert isinstance(robot, Branch)
    inner = robot.displays[1]
    assert isinstance(inner, Branch)
    bad = inner.displays[1]
    assert isinstance(bad, Unreadable)
    assert bad.reason.startswith("x.yaml:13: displays[1].displays[1].displays[1].type: unknown")


@pytest.mark.parametrize(
    "entry", ["{type: Group, displays: 3}", "{type: Group, colour: 3}", "{type: Group, name: 3}"]
)
def test_a_bad_group_is_kept_as_it_was_written(entry: str) -> None:
    (bad,) = parse(f"displays: [{entry}]", "x.yaml").displays
    assert isinstance(bad, Unreadable)
    assert "displays[0]" in bad.reason


def test_a_group_that_holds_itself_is_refused() -> None:
    with pytest.raises(ConfigError, match="nested deeper than 64 levels"):
        parse("displays: &a\n- {type: Group, displays: *a}\n", "x.yaml")


def test_groups_are_listed_before_their_displays(bench: Benches) -> None:
    b = bench(*parse(NESTED, "x.yaml").displays, publish=None)
    assert [depth for _, depth in names(b)] == [0, 0, 1, 1, 2, 2, 0]
    assert dump(b.viewer.config()) == NESTED


def test_a_group_switches_its_displays_which_keep_their_own_switch(bench: Benches) -> None:
    b = bench(Branch(DisplayGroup(name="Group"), [Axes(name="A"), Axes(name="B", enabled=False)]))
    b.turn()
    assert len(list(b.scene.visible())) == 1
    b.viewer.enqueue(SetProperty("display1", "enabled", False))
    b.turn()
    assert list(b.scene.visible()) == []
    assert b.states[-1].rows[1].statuses == {}
    b.viewer.enqueue(SetProperty("display1", "enabled", True))
    b.turn()
    assert len(list(b.scene.visible())) == 1


def test_a_group_is_as_well_as_the_worst_display_in_it(bench: Benches) -> None:
    b = bench(Branch(DisplayGroup(name="Group"), [Axes(name="Lost", reference_frame="nowhere")]))
    level, text = b.statuses(0)["Lost"]
    assert level == "ERROR"
    assert "nowhere" in text


def test_displays_are_added_to_groups_and_go_with_them(bench: Benches) -> None:
    b = bench(DisplayGroup(name="Robot"), Axes(name="A"))
    b.viewer.enqueue(AddDisplay("Axes", {"name": "In"}, group="display1"))
    b.viewer.enqueue(AddDisplay("Group", {"name": "Deep"}, group="display1"))
    assert names(b) == [("Robot", 0), ("In", 1), ("Deep", 1), ("A", 0)]
    b.viewer.enqueue(RemoveDisplay("display1"))
    assert names(b) == [("A", 0)]
    assert len(list(b.scene.visible())) == 1


def test_only_groups_hold_displays(bench: Benches) -> None:
    b = bench(Axes(name="A"))
    b.viewer.enqueue(AddDisplay("Axes", {"name": "B"}, group="display1"))
    assert names(b) == [("A", 0), ("B", 0)]
    assert len(b.viewer.config().displays) == 2
