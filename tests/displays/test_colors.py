import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import ArrayLike

from webviz_displays.shared.colors import LAYERS, RAINBOW, bounds, layers, ramp


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


GREYS = ((0, 0, 0), (200, 200, 200))


def greys(values: ArrayLike, low: float, high: float) -> list[int]:
    colors = ramp(values, low, high, GREYS)
    assert (colors == colors[:, :1]).all()
    return colors[:, 0].tolist()


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_colors_are_those_of_the_bounds_beyond_them(dtype: type) -> None:
    values = np.array([-5.0, 2.0, 3.0, 4.0, 99.0, np.nan, np.inf, -np.inf], dtype)
    assert greys(values, 2.0, 4.0) == [0, 0, 100, 200, 200, 0, 200, 0]
    assert greys(np.array([0, 128, 255], np.uint8), 0, 256) == [0, 100, 199]
    most = np.finfo(dtype).max
    assert greys(np.array([-most, 0.0, most], dtype), -float(most), float(most)) == [0, 100, 200]


@pytest.mark.parametrize("high", [2.0, 1.0, np.nan])
def test_without_a_span_everything_is_low(high: float) -> None:
    assert greys([1.0, 2.0, 3.0], 2.0, high) == [0, 0, 0]


@given(
    st.lists(st.floats(), max_size=5),
    st.floats(allow_nan=False, allow_infinity=False),
    st.floats(allow_nan=False, allow_infinity=False),
    st.sampled_from([np.float32, np.float64]),
)
def test_colors_are_in_the_order_of_the_values(
    values: list[float], low: float, high: float, dtype: type
) -> None:
    with np.errstate(over="ignore"):
        finite = np.sort(np.array([each for each in values if each == each], dtype))
    result = greys(finite, low, high)
    assert result == sorted(result)
    assert all(0 <= each <= 200 for each in greys(values, low, high))


def test_bounds_ignore_non_finite_values() -> None:
    assert bounds([np.nan, 3.0, -1.0, np.inf]) == (-1.0, 3.0)
    assert bounds([np.nan]) == (0.0, 0.0)
    assert bounds([5.0, 5.0], least_span=0.5) == (5.0, 5.5)


def test_each_opacity_is_a_layer() -> None:
    results = [(level, mask.tolist()) for level, mask in layers(np.array([1.0, 0.5, 0.0, 0.5]))]
    assert results == [(0.5, [False, True, False, True]), (1.0, [True, False, False, False])]


def test_many_opacities_are_rounded_up_to_few_layers() -> None:
    results = list(layers(np.linspace(0.0, 1.0, 256)))
    assert [level for level, _ in results] == [step / LAYERS for step in range(1, LAYERS + 1)]
    assert sum(int(mask.sum()) for _, mask in results) == 255
