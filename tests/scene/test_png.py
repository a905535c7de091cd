"""Pictures as PNG."""

from __future__ import annotations

import io

import numpy as np
import PIL.Image
import pytest

from webviz.scene.png import encode_png

RNG = np.random.default_rng(0)


def decoded(png: bytes) -> np.ndarray:
    """RGBA as an independent decoder reads it."""
    return np.asarray(PIL.Image.open(io.BytesIO(png)).convert("RGBA"))


@pytest.mark.parametrize("shape", [(1, 1), (3, 5), (512, 300)])
def test_colours_arrive_as_they_were(shape: tuple[int, int]) -> None:
    rgba = RNG.integers(0, 256, (*shape, 4), np.uint8)
    assert (decoded(encode_png(rgba)) == rgba).all()


@pytest.mark.parametrize("shape", [(1, 1), (3, 5), (512, 300)])
def test_rows_of_a_palette_arrive_as_their_colours(shape: tuple[int, int]) -> None:
    palette = RNG.integers(0, 256, (256, 4), np.uint8)
    cells = RNG.integers(0, 256, shape, np.uint8)
    assert (decoded(encode_png(cells, palette)) == palette[cells]).all()


def test_a_part_of_a_larger_picture_needs_no_copy_before() -> None:
    palette = RNG.integers(0, 256, (256, 4), np.uint8)
    cells = RNG.integers(0, 256, (20, 30), np.uint8)
    assert (decoded(encode_png(cells[3:9, 4:20], palette)) == palette[cells[3:9, 4:20]]).all()
