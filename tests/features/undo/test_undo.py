"""Undo and redo: every change of displays, settings and saved views comes back as it was."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import pytest
from bench import Bench, Benches

from webviz.api.views import Orbit
from webviz.commands import (
    AddDisplay,
    DuplicateDisplay,
    Load,
    MoveDisplay,
    Open,
    Pause,
    Redo,
    Refresh,
    RemoveDisplay,
    RemoveView,
    RenameView,
    SaveView,
    SetBackground,
    SetFixedFrame,
    SetFrameRate,
    SetProperty,
    SetToolProperty,
    StartWithView,
    Undo,
)
from webviz.engine.commands import Command, Sender
from webviz.engine.parts.snapshots import Snapshot
from webviz.features.undo import MAX_STEPS, SAME_S
from webviz.features.undo.diff import UndoSnapshot, difference
from webviz.files.config import dump
from webviz_displays.axes import Axes

CONFIG = """\
version: 1
views:
  top: {type: TopDownOrtho}
displays:
- {type: Grid}
- type: Group
  name: Robot
  displays:
  - {type: TF}
  - {type: Axes, length: 2.0}
- {type: Path}
- {type: Nonsense}
tools:
- {type: GoalPose}
"""


@pytest.fixture
def b(bench: Benches) -> Bench:
    b = bench()
    b.do(Load(CONFIG, "x.yaml"))
    return b


def ids(b: Bench) -> dict[str, str]:
    return {row.name: row.id for row in b.do(Refresh()).rows}


def labels(b: Bench) -> list[str]:
    """Return the undoable steps, newest first, without the opening of the config."""
    return [step.label for step in b.do(Refresh()).history.undo][:-1]


CHANGES: Sequence[tuple[str, Callable[[dict[str, str]], Command]]] = (
    ("Change Length (m) of Axes", lambda at: SetProperty(at["Axes"], "length", 3.0)),
    ("Change Topic of Path", lambda at: SetProperty(at["Path"], "topic.depth", 9)),
    ("Hide TF", lambda at: SetProperty(at["TF"], "enabled", False)),
    ("Hide Robot", lambda at: SetProperty(at["Robot"], "enabled", False)),
    ("Rename to Floor", lambda at: SetProperty(at["Grid"], "name", "Floor")),
    ("Add Map", lambda at: AddDisplay("Map")),
    ("Add Map", lambda at: AddDisplay("Map", group=at["Robot"])),
    ("Add Robot 2", lambda at: DuplicateDisplay(at["Robot"])),
    ("Remove Robot", lambda at: RemoveDisplay(at["Robot"])),
    ("Remove Nonsense", lambda at: RemoveDisplay(at["Nonsense"])),
    ("Move Grid", lambda at: MoveDisplay(at["Grid"])),
    ("Move Path", lambda at: MoveDisplay(at["Path"], before=at["Grid"])),
    ("Move Axes", lambda at: MoveDisplay(at["Axes"], before=at["TF"], group=at["Robot"])),
    ("Move Grid", lambda at: MoveDisplay(at["Grid"], group=at["Robot"])),
    ("Fixed frame odom", lambda at: SetFixedFrame("odom")),
    ("Change background", lambda at: SetBackground((1, 2, 3))),
    ("Change frame rate", lambda at: SetFrameRate(20.0)),
    ("Save view mine", lambda at: SaveView("mine", view=Orbit(distance=3.0))),
    ("Save view top", lambda at: SaveView("top", view=Orbit(distance=3.0))),
    ("Rename view top", lambda at: RenameView("top", "above")),
    ("Remove view top", lambda at: RemoveView("top")),
    ("Change the view to start", lambda at: StartWithView(view="top")),
    ("Change Topic of 2D Goal Pose", lambda at: SetToolProperty("2D Goal Pose", "topic", "/g")),
)


@pytest.mark.parametrize(("label", "command"), CHANGES)
def test_a_change_is_undone_and_redone(
    b: Bench, label: str, command: Callable[[dict[str, str]], Command]
) -> None:
    before, at = dump(b.viewer.config()), ids(b)
    b.do(command(at))
    after = dump(b.viewer.config())
    assert after != before
    assert labels(b) == [label]
    removed = label.removeprefix("Remove ") if label.startswith("Remove ") else ""
    assert b.viewer.state().history.undo[0].removed == removed
    b.do(Undo())
    assert dump(b.viewer.config()) == before
    assert ids(b) == at
    assert labels(b) == []
    b.do(Redo())
    assert dump(b.viewer.config()) == after
    assert labels(b) == [label]


def test_all_changes_are_undone_one_after_the_other(b: Bench) -> None:
    configs = [dump(b.viewer.config())]
    for _, command in CHANGES[:8]:
        b.do(command(ids(b)))
        configs.append(dump(b.viewer.config()))
    for expected in reversed(configs[:-1]):
        b.do(Undo())
        assert dump(b.viewer.config()) == expected
    for expected in configs[1:]:
        b.do(Redo())
        assert dump(b.viewer.config()) == expected
    b.do(Undo(len(configs) - 1))
    assert dump(b.viewer.config()) == configs[0]


def test_commands_without_a_change_add_no_step(b: Bench) -> None:
    b.do(Pause())
    b.do(SetProperty(ids(b)["Axes"], "length", 2.0))
    assert labels(b) == []


def test_a_new_change_clears_redo(b: Bench) -> None:
    b.do(SetFixedFrame("odom"))
    b.do(Undo())
    b.do(SetFixedFrame("base"))
    assert b.do(Refresh()).history.redo == ()
    assert b.refusal(Redo()) == "There is nothing to redo."


def test_dragging_a_property_is_one_step_and_another_browser_begins_another(b: Bench) -> None:
    axes = ids(b)["Axes"]
    for length in (3.0, 4.0, 5.0):
        b.do(SetProperty(axes, "length", length), Sender(1))
    b.do(SetProperty(axes, "length", 6.0), Sender(2))
    b.clock += 2 * SAME_S
    b.do(SetProperty(axes, "length", 7.0), Sender(2))
    assert [step.browser for step in b.do(Refresh()).history.undo][:-1] == [2, 2, 1]


def test_commands_of_one_step_are_undone_together(b: Bench) -> None:
    before = dump(b.viewer.config())
    first, *_, last = (row.id for row in b.states[-1].rows)
    ids: list[str] = []
    b.do(AddDisplay("Group", made=ids.append), Sender(1, step=7))
    for id in (first, last):
        b.do(MoveDisplay(id, ids[0]), Sender(1, step=7))
    b.do(RemoveDisplay(first), Sender(1, step=8))
    b.do(RemoveDisplay(last), Sender(1, step=8))
    labels = [step.label for step in b.states[-1].history.undo[:2]]
    assert labels == ["Remove 2 displays", "Add Group"]
    b.do(Undo(2))
    assert dump(b.viewer.config()) == before
    b.do(Redo(1))
    assert [row.name for row in b.states[-1].rows][-2:] == ["Grid", "Nonsense"]


def test_the_oldest_steps_are_forgotten(b: Bench) -> None:
    for number in range(MAX_STEPS + 10):
        b.do(SetFixedFrame(f"frame{number}"))
    assert len(b.do(Refresh()).history.undo) == MAX_STEPS


def test_opening_a_file_is_undone_with_the_name_of_the_file(b: Bench, tmp_path: Path) -> None:
    other = tmp_path / "other.yaml"
    other.write_text("version: 1\nfixed_frame: odom\ndisplays: []\n")
    before = dump(b.viewer.config())
    b.do(Open(str(other)))
    assert labels(b) == ["Open other.yaml"]
    state = b.do(Undo())
    assert dump(b.viewer.config()) == before
    assert (state.file.path, state.file.is_changed) == ("", True)
    assert b.do(Redo()).file.path == str(other)


def test_undoing_a_removal_draws_the_display_again(b: Bench) -> None:
    axes = ids(b)["Axes"]
    b.do(SetProperty(ids(b)["Grid"], "enabled", False))
    count = len(list(b.scene.visible()))
    assert count > 0
    b.do(RemoveDisplay(axes))
    assert list(b.scene.visible()) == []
    b.do(Undo())
    b.turn()
    assert len(list(b.scene.visible())) == count


MINE, THEIRS = Sender(1), Sender(2)


def test_each_browser_undoes_its_own_steps(b: Bench) -> None:
    at = ids(b)
    b.do(SetProperty(at["Axes"], "length", 3.0), MINE)
    b.do(SetProperty(at["Axes"], "radius", 0.5), THEIRS)
    b.do(SetFixedFrame("odom"), THEIRS)
    b.do(Undo(own=True), MINE)
    b.do(Refresh())
    axes = b.display(Axes)
    assert (axes.length, axes.radius) == (2.0, 0.5)
    assert labels(b) == ["Fixed frame odom", "Change Radius (m) of Axes"]
    b.do(SetProperty(at["Grid"], "name", "Floor"), THEIRS)
    state = b.do(Redo(own=True), MINE)
    axes = b.display(Axes)
    assert (axes.length, axes.radius, state.fixed_frame) == (3.0, 0.5, "odom")


def test_a_browser_without_steps_undoes_the_newest_step(b: Bench) -> None:
    b.do(SetFixedFrame("odom"), THEIRS)
    assert b.do(Undo(own=True), MINE).fixed_frame == "map"


OTHERS = ("Hide TF", "Add Robot 2", "Remove Nonsense", "Move Grid", "Fixed frame odom")


@pytest.mark.parametrize("other", OTHERS)
@pytest.mark.parametrize(("label", "command"), CHANGES)
def test_two_changes_are_taken_back_in_the_other_order(
    b: Bench, label: str, command: Callable[[dict[str, str]], Command], other: str
) -> None:
    at, before = ids(b), dump(b.viewer.config())
    b.do(command(at), MINE)
    mine = dump(b.viewer.config())
    later = b.viewer.enqueue(dict(CHANGES)[other](at), THEIRS)
    b.until_done(later)
    has_changed = dump(b.viewer.config()) != mine
    b.do(Undo(own=True), MINE)
    if has_changed:
        b.do(Undo(own=True), THEIRS)
    assert set(ids(b).values()) == set(at.values())
    if label != other and not label.startswith("Move"):
        assert dump(b.viewer.config()) == before


@pytest.mark.parametrize(
    ("before", "after", "name"),
    [("ab", "ba", "b"), ("dcba", "cbad", "d"), ("abcd", "dabc", "d"), ("abcde", "edcba", "e")],
)
def test_the_display_that_was_moved_is_named(before: str, after: str, name: str) -> None:
    old, new = (
        UndoSnapshot(displays={id: Snapshot(Axes, {"name": id}) for id in order})
        for order in (before, after)
    )
    assert difference(old, new).label == f"Move {name}"


def test_at_least_one_step_is_undone(b: Bench) -> None:
    before = dump(b.viewer.config())
    b.do(SetFixedFrame("odom"))
    b.do(Undo(steps=0))
    assert dump(b.viewer.config()) == before


def test_undoing_a_change_of_a_removed_display_changes_nothing_else(b: Bench) -> None:
    at = ids(b)
    b.do(SetProperty(at["Axes"], "length", 3.0), MINE)
    b.do(RemoveDisplay(at["Robot"]), THEIRS)
    assert "Axes" not in {row.name for row in b.do(Undo(own=True), MINE).rows}
    assert set(ids(b)) == {"Grid", "Path", "Nonsense"}
    b.do(Undo(own=True), THEIRS)
    assert ids(b) == at
