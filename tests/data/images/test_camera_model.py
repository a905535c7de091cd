"""Cameras against pixels worked out by hand."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import photos
import pytest

from webviz.data.images import CameraModel, ImageError, optical_problem


def info(**changes: Any) -> Any:
    nothing = {"x_offset": 0, "y_offset": 0, "width": 0, "height": 0}
    roi = SimpleNamespace(**(nothing | changes.pop("roi", {})))
    binned = {"binning_x": 0, "binning_y": 0, "roi": roi}
    return SimpleNamespace(**(photos.info(640, 480) | binned | changes))


P = [500.0, 0.0, 320.0, 0.0, 0.0, 400.0, 240.0, 0.0, 0.0, 0.0, 1.0, 0.0]


def test_a_pixel_looks_along_its_ray() -> None:
    model = CameraModel.of(info(p=P))
    # The centre of pixel (420, 40) is at 420.5, 40.5 from the corner of the image.
    ray = model.rays(np.array([420.5]), np.array([40.5]))[0]
    np.testing.assert_allclose(ray, [(420 - 320) / 500, (40 - 240) / 400, 1.0])
    depths = np.full((480, 640), 2.0, np.float32)
    np.testing.assert_allclose(model.points(depths, 1)[40, 420], [0.4, -1.0, 2.0], rtol=1e-6)
    np.testing.assert_allclose(model.points(depths[::4, ::4], 4)[10, 105], [0.4, -1.0, 2.0])


def test_the_corners_are_those_of_the_outer_pixels() -> None:
    corners = CameraModel.of(info(p=P)).corners(2.0)
    left, top = (-0.5 - 320) / 500 * 2, (-0.5 - 240) / 400 * 2
    right, bottom = (639.5 - 320) / 500 * 2, (479.5 - 240) / 400 * 2
    expected = [(left, top, 2), (right, top, 2), (right, bottom, 2), (left, bottom, 2)]
    np.testing.assert_allclose(corners, expected)


def test_a_cropped_and_binned_image_is_seen_by_the_same_rays() -> None:
    whole = CameraModel.of(info(p=P))
    roi = {"x_offset": 100, "y_offset": 40, "width": 400, "height": 200}
    part = CameraModel.of(info(p=P, roi=roi, binning_x=2, binning_y=4))
    assert (part.width, part.height) == (200, 50)
    ray = part.points(np.ones((1, 1), np.float32), 1)[0, 0]
    np.testing.assert_allclose(ray[:2], [(100 - 320) / 500, (40 - 240) / 400], rtol=1e-6)
    assert (whole.fx, part.fx, part.fy) == (500, 250, 100)


def test_the_right_camera_of_a_stereo_pair_is_beside_its_frame() -> None:
    p = [*P[:3], -60.0, *P[4:]]
    model = CameraModel.of(info(p=p))
    assert model.center == pytest.approx((0.12, 0.0))
    assert model.corners(1.0)[0, 0] == pytest.approx(0.12 + (-0.5 - 320) / 500)


def test_without_p_a_camera_has_k() -> None:
    model = CameraModel.of(info(p=[0.0] * 12))
    assert (model.fx, model.cx, model.cy) == (640, 319.5, 239.5)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"p": [0.0] * 12, "k": [0.0] * 9}, "not calibrated"),
        ({"p": [float("nan")] * 12}, "focal lengths nan"),
        ({"p": [-500.0, *P[1:]]}, "focal lengths -500"),
        ({"p": [0.0] * 12, "k": [float("inf")] * 9}, "inf of K are invalid"),
        ({"p": [*P[:2], 1e308, *P[3:]]}, "do not fit an image of 640 x 480"),
        ({"p": [1e308, *P[1:5], 1e308, *P[6:]]}, "do not fit"),
        ({"p": [5e-324, *P[1:5], 5e-324, *P[6:]]}, "do not fit"),
        ({"width": 2**32 - 1}, "do not fit"),
        ({"roi": {"x_offset": 2**32 - 1}}, "do not fit"),
        ({"p": [1e308, *P[1:3], 1e308, *P[4:5], 1e-300, *P[6:7], 1e308, *P[8:]]}, "1000 km"),
        ({"width": 0}, "0 x 480"),
    ],
)
def test_invalid_camera_infos_are_refused(changes: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ImageError) as error:
        CameraModel.of(info(**changes))
    assert sentence in str(error.value)


@pytest.mark.parametrize(
    ("frame", "is_body"),
    [("camera_link", True), ("oak/camera_frame", True), ("camera_color_optical_frame", False),
     ("camera", False), ("", False)],
)  # fmt: skip
def test_the_frame_of_a_body_is_recognized(frame: str, is_body: bool) -> None:
    assert bool(optical_problem(frame)) == is_body
    if is_body:
        assert "_optical_frame" in optical_problem(frame)
