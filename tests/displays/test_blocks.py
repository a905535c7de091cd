"""The order of large clouds, of which browsers draw the first points of each block."""

from __future__ import annotations

import numpy as np
import pytest

from webviz.api.nodes import POINTS_PER_BLOCK
from webviz_displays.point_cloud2.display import in_blocks


def plane(count: int) -> np.ndarray:
    places = np.random.default_rng(0).uniform(-100, 100, (count, 3)).astype(np.float32)
    places[:, 2] = 0
    places[0] = 1e9
    return places


@pytest.mark.parametrize("count", [1, 1000, POINTS_PER_BLOCK, 3 * POINTS_PER_BLOCK + 17])
def test_every_point_has_one_place(count: int) -> None:
    xyz = plane(count + 1)[1:]
    assert (np.sort(in_blocks(xyz)) == np.arange(count)).all()


def test_blocks_are_compact_and_their_first_points_stand_for_them() -> None:
    xyz = plane(17 * POINTS_PER_BLOCK)
    blocks = xyz[in_blocks(xyz)].reshape(17, POINTS_PER_BLOCK, 3)[:, :, :2]
    blocks = np.clip(blocks, -100, 100)
    assert np.ptp(blocks[0], axis=0) == pytest.approx(200, rel=0.01), "the first is everywhere"
    extents = np.ptp(blocks[1:], axis=1)
    assert np.median(extents) < 80
    some = blocks[1:, :1000]
    assert np.abs(some.mean(axis=1) - blocks[1:].mean(axis=1)).max() < 5
    assert np.median(np.ptp(some, axis=1) / extents) > 0.98


def test_points_in_one_place_are_ordered_too() -> None:
    xyz = np.full((POINTS_PER_BLOCK + 5, 3), 7.0, np.float32)
    assert len(set(in_blocks(xyz).tolist())) == len(xyz)
