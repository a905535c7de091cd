"""Ageing of frames that are no longer published."""

import numpy as np
import pytest

from webviz_displays.tf.frame_marks import Ages, fade

SECOND = 1_000_000_000


# RViz: colours to a third of the timeout, grey at two thirds, gone at the whole.
@pytest.mark.parametrize(
    ("age", "greyness", "opacity"),
    [(0, 0, 1), (5, 0, 1), (7.5, 0.5, 1), (10, 1, 1), (12.5, 1, 0.5), (15, 1, 0), (99, 1, 0)],
)
def test_frames_turn_grey_and_then_transparent(age: float, greyness: float, opacity: float) -> None:
    grey, opaque = fade(np.array([float(age)]), 15.0)
    assert (grey[0], opaque[0]) == (pytest.approx(greyness), pytest.approx(opacity))


def test_frames_that_move_stay_young_though_their_stamps_are_of_another_day() -> None:
    ages, day = Ages(), 86_400 * SECOND
    ages.update(np.array([SECOND]), day, dict)
    assert ages.update(np.array([2 * SECOND]), day + SECOND, dict).tolist() == [0.0]
    assert ages.update(np.array([2 * SECOND]), day + 4 * SECOND, dict).tolist() == [3.0]


def test_a_frame_first_seen_late_is_as_old_as_the_reception_of_its_transform() -> None:
    ages, day = Ages(), 86_400 * SECOND
    ages.update(np.array([8 * SECOND]), day, lambda: {8 * SECOND: day})
    stamps = np.array([8 * SECOND, 3 * SECOND])
    result = ages.update(stamps, day + 2 * SECOND, lambda: {3 * SECOND: day - 5 * SECOND})
    assert result.tolist() == [2.0, 7.0]


def test_a_frame_that_stopped_while_nothing_was_drawn_is_as_old_as_its_transform() -> None:
    ages = Ages()
    ages.update(np.array([SECOND]), 2 * SECOND, dict)
    ages.update(np.array([2 * SECOND]), 10 * SECOND, dict)  # noticed late
    ages_s = ages.update(np.array([2 * SECOND]), 12 * SECOND, lambda: {2 * SECOND: 3 * SECOND})
    assert ages_s.tolist() == [9.0]


def test_a_frame_with_a_stamp_in_the_future_is_not_younger_than_new() -> None:
    ages = Ages()
    assert ages.update(np.array([9 * SECOND]), 5 * SECOND, dict).tolist() == [0.0]
    assert ages.update(np.array([9 * SECOND]), 6 * SECOND, dict).tolist() == [1.0]
