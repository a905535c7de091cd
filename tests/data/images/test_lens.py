"""Lenses against OpenCV."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import lenses
import numpy as np
import pytest

from webviz.data.images import CameraModel, ImageError, Lens


def info(name: str, roi: tuple[int, int, int, int] = (0, 0, 0, 0), **changes: Any) -> Any:
    keys = ("x_offset", "y_offset", "width", "height")
    part = SimpleNamespace(**dict(zip(keys, roi, strict=True)))
    return SimpleNamespace(**lenses.info(name, **changes), roi=part, binning_x=0, binning_y=0)


@pytest.mark.parametrize("name", lenses.CAMERAS)
def test_rays_meet_the_pixels_that_opencv_computes(name: str) -> None:
    pixels = Lens.of(info(name)).project(lenses.RAYS)
    np.testing.assert_allclose(pixels, lenses.CAMERAS[name][2], atol=2e-4)
    far = Lens.of(info(name)).project(7.0 * lenses.RAYS)
    np.testing.assert_allclose(far, pixels, atol=1e-9)


def test_the_grid_has_the_place_in_the_image_of_each_rectified_place() -> None:
    camera = info("plumb_bob")
    model = CameraModel.whole(camera)
    grid = Lens.of(camera).grid(model)
    assert grid is not None
    rows, columns = grid.shape[0] - 1, grid.shape[1] - 1
    middle = model.rays(np.array([model.width / 2]), np.array([model.height / 2]))
    expected = (Lens.of(camera).project(middle)[0] + 0.5) / (model.width, model.height)
    np.testing.assert_allclose(grid[rows // 2, columns // 2], expected, atol=1e-6)
    cropped = Lens.of(info("plumb_bob", (64, 48, 320, 240))).grid(model)
    assert cropped is not None
    np.testing.assert_allclose(cropped, (grid - 0.1) * 2, atol=1e-5)


def test_an_image_that_is_rectified_already_needs_no_grid() -> None:
    camera = info("plumb_bob", d=[0.0] * 5, k=[580.0, 0, 320, 0, 580, 240, 0, 0, 1], r=[0.0] * 9)
    assert Lens.of(camera).grid(CameraModel.whole(camera)) is None


def test_rays_beyond_the_fold_of_the_polynomial_are_not_projected() -> None:
    lens = Lens.of(info("plumb_bob", d=[-0.5, 0.0, 0.0, 0.0, 0.0], r=[0.0] * 9))
    # r - 0.5 r^3 grows up to r = 0.816.
    pixels_in_view = np.isfinite(
        lens.project(np.array([(0.8, 0, 1.0), (0.9, 0, 1.0), (0.1, 0, -1.0)]))
    )
    assert pixels_in_view.all(axis=1).tolist() == [True, False, False]


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"distortion_model": "kannala"}, "Unsupported distortion model 'kannala'"),
        ({"d": [0.1] * 14}, "'plumb_bob' with 14 coefficients"),
        ({"d": [float("nan")] * 5}, "D of the camera info is invalid"),
        ({"d": [0.1] * 3}, "'plumb_bob' with 3 coefficients"),
        ({"r": [5.0] * 9}, "not a rotation"),
        ({"k": [0.0] * 9}, "invalid"),
        ({"d": [1e308] * 5}, "sees nothing"),
        ({"d": [0.1] * 4}, ""),
    ],
)
def test_invalid_lenses_are_refused(changes: dict[str, Any], sentence: str) -> None:
    camera = info("plumb_bob", **changes)
    if sentence:
        with pytest.raises(ImageError, match=sentence):
            Lens.of(camera).grid(CameraModel.whole(camera))
    else:
        Lens.of(camera).grid(CameraModel.whole(camera))
