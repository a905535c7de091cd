import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from webviz_displays.shared.colors import RAINBOW, bounds, faded, fractions, ramp


@pytest.mark.parametrize(
    ("where", "color"),
    [
        (0.0, (255, 0, 0)),  # red
        (0.1, (255, 128, 0)),  # half way to yellow
        (0.2, (255, 255, 0)),
        (0.4, (0, 255, 0)),
        (0.6, (0, 255, 255)),
        (0.8, (0, 0, 255)),
        (0.9, (128, 0, 255)),
        (1.0, (255, 0, 255)),  # magenta
    ],
)
def test_the_rainbow_runs_from_red_over_green_to_magenta(
    where: float, color: tuple[int, int, int]
) -> None:
    assert tuple(ramp([where], 0.0, 1.0)[0].tolist()) == color
    assert tuple(ramp([1.0 - where], 0.0, 1.0, RAINBOW[::-1])[0].tolist()) == color


def test_a_ramp_mixes_its_two_colours() -> None:
    colors = ramp([-2.0, -1.75, -1.0], -2.0, -1.0, ((0, 0, 0), (255, 100, 8)))
    assert colors.tolist() == [[0, 0, 0], [64, 25, 2], [255, 100, 8]]


def test_long_ramps_are_as_short_ones() -> None:
    values = np.linspace(-1.0, 1.0, 40_001)
    colors = ramp(values, -1.0, 1.0)
    assert len(colors) == len(values)
    for i in (0, 1, 16_383, 16_384, 16_385, 32_768, 40_000):
        assert colors[i].tolist() == ramp(values[i : i + 1], -1.0, 1.0)[0].tolist()


def test_fractions_are_clamped_between_the_bounds() -> None:
    values = [-5.0, 2.0, 3.0, 4.0, 99.0, np.nan, np.inf, -np.inf]
    assert fractions(values, 2.0, 4.0).tolist() == [0, 0, 0.5, 1, 1, 0, 1, 0]


@pytest.mark.parametrize("high", [2.0, 1.0, np.nan])
def test_without_a_span_everything_is_low(high: float) -> None:
    assert fractions([1.0, 2.0, 3.0], 2.0, high).tolist() == [0, 0, 0]


@given(
    st.lists(st.floats(), max_size=5),
    st.floats(allow_nan=False, allow_infinity=False),
    st.floats(allow_nan=False, allow_infinity=False),
)
def test_fractions_lie_between_0_and_1_whatever_comes(
    values: list[float], low: float, high: float
) -> None:
    where = fractions(values, low, high)
    assert ((where >= 0) & (where <= 1)).all()


def test_bounds_ignore_what_is_not_finite() -> None:
    assert bounds([np.nan, 3.0, -1.0, np.inf]) == (-1.0, 3.0)
    assert bounds([np.nan]) == (0.0, 0.0)
    assert bounds([5.0, 5.0], least_span=0.5) == (5.0, 5.5)


def test_alpha_fades_towards_the_background_of_rviz() -> None:
    assert faded(np.array([[160, 160, 164]], np.uint8), 0.5).tolist() == [[104, 104, 106]]
    assert faded(np.array([[248, 48, 0]], np.uint8), 0.25).tolist() == [[98, 48, 36]]
    assert faded(np.array([[255, 25, 0]], np.uint8), 0.0).tolist() == [[48, 48, 48]]
