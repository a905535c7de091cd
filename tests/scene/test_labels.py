"""Where texts are, as a real browser draws them."""

from __future__ import annotations

from typing import Any

import numpy as np

from webviz.nodes import Labels


def test_a_text_hangs_below_its_position_when_asked_from_wherever_one_looks(view: Any) -> None:
    place = np.zeros((1, 3), np.float32)
    for below in (False, True, False):
        view.scene.upsert("tf", "names", Labels(place, ("HHH",), 2.0, below))
        for position in ((0.0, -0.01, 10.0), (10.0, 0.0, 0.0)):
            view.look(position, (0.0, 0.0, 0.0))
            view.wait_for(lambda: (view.pixels() < 20).all(axis=2).any())
            rows, _ = np.nonzero((view.pixels() < 20).all(axis=2))
            row, _ = view.row_column((0.0, 0.0, 0.0))
            assert rows.max() > row
            assert (rows.min() >= row) == below
