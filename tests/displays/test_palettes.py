"""The colours of cells, against RViz's palettes written out by hand."""

import numpy as np
import pytest

from webviz_displays.map.palettes import lookup_table

# Cell value as int8 -> RGBA, as palette_builder.cpp fills its tables.
COMMON = {
    101: (0, 255, 0, 255),
    127: (0, 255, 0, 255),
    -128: (255, 0, 0, 255),
    -127: (255, 2, 0, 255),
    -65: (255, 127, 0, 255),
    -2: (255, 255, 0, 255),
    -1: (112, 137, 134, 255),
}
MAP = COMMON | {
    0: (255, 255, 255, 255),
    1: (253, 253, 253, 255),
    33: (171, 171, 171, 255),
    50: (128, 128, 128, 255),
    98: (6, 6, 6, 255),
    99: (3, 3, 3, 255),
    100: (0, 0, 0, 255),
}
COSTMAP = COMMON | {
    0: (0, 0, 0, 0),
    1: (2, 0, 253, 255),
    50: (127, 0, 128, 255),
    98: (249, 0, 6, 255),
    99: (0, 255, 255, 255),
    100: (255, 0, 255, 255),
}
RAW = {
    0: (0, 0, 0, 255),
    1: (1, 1, 1, 255),
    99: (99, 99, 99, 255),
    100: (100, 100, 100, 255),
    127: (127, 127, 127, 255),
    -128: (128, 128, 128, 255),
    -1: (255, 255, 255, 255),
}


@pytest.mark.parametrize(("scheme", "colors"), [("map", MAP), ("costmap", COSTMAP), ("raw", RAW)])
def test_every_scheme_has_the_bytes_of_rviz(
    scheme: str, colors: dict[int, tuple[int, int, int, int]]
) -> None:
    cells = np.array([list(colors)], np.int8)
    colored = lookup_table(scheme)[cells.view(np.uint8)]
    assert colored.tolist() == [[list(c) for c in colors.values()]]


def test_the_grey_of_a_map_never_gets_lighter_with_the_value() -> None:
    greys = lookup_table("map")[:101, 0].astype(int)
    assert (np.diff(greys) < 0).all()


@pytest.mark.parametrize(
    ("scheme", "below", "above"),
    [
        ("map", (255, 255, 255), (0, 0, 0)),
        ("costmap", (0, 0, 255), (255, 0, 0)),
        ("raw", (0, 0, 0), (255, 255, 255)),
    ],
)
def test_a_threshold_leaves_two_colours_of_legal_values_both_opaque(
    scheme: str, below: tuple[int, int, int], above: tuple[int, int, int]
) -> None:
    table = lookup_table(scheme, binary_threshold=40)
    assert (table[:40] == (*below, 255)).all()
    assert (table[40:101] == (*above, 255)).all()


@pytest.mark.parametrize("scheme", ["map", "costmap"])
def test_a_threshold_leaves_unknown_and_illegal_values_as_they_are(scheme: str) -> None:
    table = lookup_table(scheme, binary_threshold=40)
    assert (table[101:] == lookup_table(scheme)[101:]).all()


def test_a_threshold_splits_all_values_of_the_raw_scheme() -> None:
    assert (lookup_table("raw", binary_threshold=40)[101:] == 255).all()


def test_alpha_multiplies_the_alpha_of_the_palette() -> None:
    table = lookup_table("costmap", alpha=0.7)
    assert table[0, 3] == 0
    assert (table[1:, 3] == round(0.7 * 255)).all()


def test_a_free_cell_of_a_costmap_is_transparent_at_full_alpha_too() -> None:
    assert lookup_table("costmap", alpha=1.0)[0, 3] == 0
