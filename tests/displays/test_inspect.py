"""Details of a display that does not know of selections."""

from __future__ import annotations

import math

from inspecting import Benches

from webviz import Context, Display, Frames
from webviz.api.nodes import Lines
from webviz.engine.commands import NodePicks
from webviz.shell.testing import check_details

NAN = math.nan


class Unaware(Display):
    """A display that does not know of selections."""

    def draw_all(self, samples: object, ctx: Context) -> None:
        rows = [[(0, 0, 0), (1, 0, 0)], [(NAN, 0, 0), (1, 0, 0)], [(0, 1, 0), (1, 1, 0)]]
        ctx.lines("lines", rows, (0, 0, 0))


def test_an_item_of_a_display_that_does_not_know_has_its_number(bench: Benches) -> None:
    """The second in the browser, which does not get the one that is not finite."""
    at = bench(Unaware())
    at.turn()
    (name,) = at.scene.groups
    assert isinstance(at.nodes()["lines"], Lines)
    hits = at.runner.find(NodePicks(name, "lines", ((1, 1, (0.0, 1.0, 0.0), None),)))
    details = at.runner.inspect(hits[1], Frames(at.buffer, "map", 0))
    assert details is not None
    check_details(details, "Line 2", {})
