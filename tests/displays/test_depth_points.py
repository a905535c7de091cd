"""Pixels that the points of a depth image belong to."""

from typing import ClassVar

import numpy as np
import pytest
from built_in_checks import BuiltInChecks
from display_scenes import depth_clouds

from webviz.data.images import RawImage
from webviz.data.images.camera_model import CameraModel
from webviz_displays.depth_cloud import DepthCloud
from webviz_displays.depth_cloud.cloud import depth_points

WIDTH, HEIGHT = 6, 4


@pytest.mark.parametrize(
    ("most", "ids"), [(0, list(range(24))), (6, [0, 2, 4, 12, 14, 16])], ids=["all", "thinned"]
)
def test_points_carry_the_pixel_of_the_whole_image(most: int, ids: list[int]) -> None:
    depths = np.full((HEIGHT, WIDTH), 2.0, np.float32)
    image = RawImage(WIDTH, HEIGHT, "32FC1", 4 * WIDTH, False, depths.view(np.uint8).ravel())
    points = depth_points(image, None, CameraModel(WIDTH, HEIGHT, 2.0, 2.0, 0.0, 0.0), most)
    assert points.ids.tolist() == ids
    # x is as many metres as columns, and y as rows: 2 m away at a focal length of 2 pixels.
    rows, columns = np.divmod(points.ids, WIDTH)
    np.testing.assert_allclose(points.xyz[:, :2], np.column_stack((columns, rows)), atol=1e-6)
    assert 2.0 * points.spacing == pytest.approx(columns[1] - columns[0])


class TestDepthCloud(BuiltInChecks):
    display = DepthCloud
    messages: ClassVar = {}
    scene = depth_clouds
    later = ("decay_time", "occlusion_compensation")
    elsewhere = ("occlusion_time_out",)
    needs: ClassVar = {"max_points": {"max_points": 40}}
