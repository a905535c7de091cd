"""Ageing of frames that are no longer published."""

import numpy as np
import pytest

from webviz_displays.tf.fading import Ages, fade

SECOND = 1_000_000_000


# RViz: colours to a third of the timeout, grey at two thirds, gone at the whole.
@pytest.mark.parametrize(
    ("age", "greyness", "opacity"),
    [(0, 0, 1), (5, 0, 1), (7.5, 0.5, 1), (10, 1, 1), (12.5, 1, 0.5), (15, 1, 0), (99, 1, 0)],
)
def test_frames_turn_grey_and_then_transparent(age, greyness, opacity) -> None:
    grey, opaque = fade(np.array([float(age)]), 15.0)
    assert (grey[0], opaque[0]) == (pytest.approx(greyness), pytest.approx(opacity))


def test_frames_that_move_stay_young_though_their_stamps_are_of_another_day() -> None:
    ages, day = Ages(), 86_400 * SECOND
    ages.update(np.array([SECOND]), day)
    assert ages.update(np.array([2 * SECOND]), day + SECOND).tolist() == [0.0]
    assert ages.update(np.array([2 * SECOND]), day + 4 * SECOND).tolist() == [3.0]


def test_a_frame_first_seen_late_is_as_old_as_its_stamp() -> None:
    ages = Ages()
    ages.update(np.array([8 * SECOND]), 8 * SECOND)
    assert ages.update(np.array([8 * SECOND, 3 * SECOND]), 10 * SECOND).tolist() == [2.0, 7.0]


def test_a_frame_with_a_stamp_in_the_future_is_not_younger_than_new() -> None:
    ages = Ages()
    assert ages.update(np.array([9 * SECOND]), 5 * SECOND).tolist() == [0.0]
    assert ages.update(np.array([9 * SECOND]), 6 * SECOND).tolist() == [1.0]
