"""Cameras and depths in the scene as people see them."""

from __future__ import annotations

from collections.abc import Callable

import photos

from webviz.api.views import Orbit
from webviz.shell.testing import Harness
from webviz_displays.axes import Axes
from webviz_displays.camera import Camera
from webviz_displays.camera_info import CameraInfo
from webviz_displays.depth_cloud import DepthCloud
from webviz_displays.grid import Grid
from webviz_displays.image_plane import ImagePlane

Stages = Callable[..., Harness]

VIEW = Orbit(distance=5.5, yaw=-2.2, pitch=0.5, focal_point=(1.5, 0.0, 0.5))
FACING_X = (-0.5, 0.5, -0.5, 0.5)


def test_a_camera_has_a_pyramid_with_its_image(webviz_harness: Stages) -> None:
    camera = CameraInfo(far_clip=2.0, show_image=True, edge_color=(85, 255, 255))
    harness = webviz_harness(camera, Grid(plane_cell_count=6), view=VIEW)
    harness.transform("map", "camera", (0.0, 0.0, 0.6), FACING_X)
    harness.publish(camera.topic.name, photos.INFO, photos.info(), frame="camera")
    values = photos.raw(photos.room()[0], "rgb8")
    harness.publish(camera.image_topic.name, photos.RAW, values, frame="camera")
    harness.turn()
    harness.check_picture("camera_info/default")


def test_an_image_stands_at_its_frame(webviz_harness: Stages) -> None:
    plane = ImagePlane(width=2.4, alpha=0.9)
    harness = webviz_harness(
        plane, Grid(plane_cell_count=6), Axes(reference_frame="camera"), view=VIEW
    )
    harness.transform("map", "camera", (1.5, 0.0, 1.0), FACING_X)
    harness.publish(
        plane.topic.name, photos.COMPRESSED, photos.jpeg(photos.room()[0]), frame="camera"
    )
    harness.turn()
    harness.check_picture("image_plane/default")


def test_the_scene_is_over_the_image_of_its_camera(webviz_harness: Stages) -> None:
    camera = Camera(overlay_alpha=0.2, zoom_factor=0.9)
    frame = Axes(reference_frame="box", length=0.5, radius=0.03)
    harness = webviz_harness(
        CameraInfo(show_polygons=False), camera, frame, Grid(plane_cell_count=6), view=VIEW
    )
    harness.transform("map", "camera", (0.0, 0.0, 0.6), FACING_X)
    harness.transform("map", "box", (2.0, -0.4, 0.0))
    bend = {"distortion_model": "plumb_bob", "d": [-0.3, 0.1, 0.0, 0.0, 0.0]}
    values = photos.info(640, 480, **bend)
    harness.publish("/camera/camera_info", photos.INFO, values, frame="camera")
    image = photos.jpeg(photos.room(640, 480)[0])
    harness.publish(camera.topic.name, photos.COMPRESSED, image, frame="camera")
    harness.turn()
    harness.check_picture("camera/default")


def test_depths_are_points_in_color(webviz_harness: Stages) -> None:
    cloud = DepthCloud()
    harness = webviz_harness(cloud, Grid(plane_cell_count=6), view=VIEW)
    harness.transform("map", "camera", (0.0, 0.0, 0.6), FACING_X)
    harness.publish("/camera/depth/camera_info", photos.INFO, photos.info(), frame="camera")
    _, depths = photos.room()
    harness.publish(cloud.topic.name, photos.RAW, photos.raw(depths, "32FC1"), frame="camera")
    harness.turn()
    harness.check_picture("depth_cloud/default")
