"""Reuse of unchanged rows of the list of displays."""

from __future__ import annotations

from bench import Benches

from webviz.commands import Pause, Refresh, RemoveDisplay, SetProperty, Undo
from webviz_displays.grid import Grid


def test_only_a_row_that_has_changed_is_a_new_object(bench: Benches) -> None:
    viewer = bench(Grid(name="a"), Grid(name="b"))
    before = viewer.do(Refresh())
    now = viewer.do(Pause(True))
    assert now.rows is before.rows

    # The display is the same object before and after: the row has to tell.
    changed = viewer.do(SetProperty(now.rows[0].id, "cell_size", 2.0))
    assert changed.rows[0] is not now.rows[0]
    assert changed.rows[1] is now.rows[1]

    viewer.viewer.enqueue(RemoveDisplay(now.rows[0].id))
    again = viewer.do(Undo())
    viewer.do(SetProperty(now.rows[0].id, "cell_size", 3.0))
    assert again.rows[0].display is viewer.states[-1].rows[0].display is not now.rows[0].display
