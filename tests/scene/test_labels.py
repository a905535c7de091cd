"""Places and looks of texts, as a real browser draws them."""

from __future__ import annotations

import numpy as np

from tests.scene.conftest import View
from webviz.api.nodes import Instances, Labels

CENTER = np.zeros((1, 3), np.float32)
GREEN = (0, 255, 0)


def light(view: View) -> np.ndarray:
    """Rows and columns of the letters, (2, N)."""
    view.wait_for(lambda: (view.pixels() > 200).all(axis=2).any())
    return np.array(np.nonzero((view.pixels() > 200).all(axis=2)))


def test_a_text_below_its_position_stays_below_from_any_side(view: View) -> None:
    for below in (False, True, False):
        view.scene.upsert("tf", "names", Labels(CENTER, ("HHH",), 2.0, below))
        for position in ((0.0, -0.01, 10.0), (10.0, 0.0, 0.0)):
            view.look(position, (0.0, 0.0, 0.0))
            rows, _ = light(view)
            row, _ = view.row_column((0.0, 0.0, 0.0))
            assert rows.max() > row
            assert (rows.min() >= row) == below


def test_a_text_is_centred_and_its_capitals_are_0_6_of_the_height_of_a_line(view: View) -> None:
    view.scene.upsert("tf", "names", Labels(CENTER, ("HHH",), 4.0))
    view.show()
    rows, columns = light(view)
    top, _ = view.row_column((0.0, 2.0, 0.0))
    bottom, middle = view.row_column((0.0, -2.0, 0.0))
    assert 0.56 < (np.ptp(rows) + 1) / (bottom - top) < 0.64  # fonts differ
    assert abs((columns.min() + columns.max()) / 2 - middle) < 2


def test_letters_have_a_dark_outline_and_leave_the_scene_around_them_alone(view: View) -> None:
    below, size = np.array([(0, 0, -1)], np.float32), np.array([(20, 20, 0.1)], np.float32)
    floor = Instances(below, size, GREEN)
    view.scene.upsert("map", "floor", floor)
    view.scene.upsert("tf", "names", Labels(CENTER, ("HHH",), 4.0))
    view.show()
    rows, columns = light(view)
    box = view.pixels()[rows.min() : rows.max(), columns.min() : columns.max()].astype(int)
    is_dark, is_light = (box < 60).all(axis=2), (box > 200).all(axis=2)
    is_floor = box[..., 1] - box[..., 0] > 100
    assert 0.02 < is_dark.mean() < 0.2
    assert 0.2 < is_light.mean() < 0.4
    assert is_floor.mean() > 0.4
