"""Images and texts as people see them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import photos

from webviz import Topic
from webviz.api.views import Orbit
from webviz.shell.testing import Harness
from webviz_displays.grid import Grid
from webviz_displays.image import Image
from webviz_displays.image.annotated import ANNOTATIONS, DETECTIONS
from webviz_displays.text import Text

Stages = Callable[..., Harness]


def test_images_are_beside_the_scene(webviz_harness: Stages) -> None:
    color = Image(name="Color")
    depth = Image(name="Depth", topic=Topic("/depth"), color_map="Turbo")
    view = Orbit(distance=9.0, yaw=-1.2, pitch=0.6)
    harness = webviz_harness(color, depth, Grid(plane_cell_count=6), view=view)
    colors, depths = photos.room()
    harness.publish(color.topic.name, photos.COMPRESSED, photos.jpeg(colors), frame="camera")
    harness.publish("/depth", photos.RAW, photos.raw(depths, "32FC1"), frame="camera")
    harness.turn()
    harness.check_picture("image/default")


def test_texts_are_beside_the_scene(webviz_harness: Stages) -> None:
    battery = Text(name="Battery", topic=Topic("/battery_state"))
    wheels = Text(name="Wheels", topic=Topic("/wheels"), fields=["header.stamp", "position[left]"])
    harness = webviz_harness(battery, wheels, Grid(plane_cell_count=6), view=Orbit(distance=9.0))
    cells = np.array([3.9, 4.0, 3.95], np.float32)
    charge = {"voltage": 11.85, "percentage": 0.71, "cell_voltage": cells, "location": "rear"}
    joints = {"name": ["left", "right"], "position": [1.25, -0.5]}
    for _ in range(2):  # the type is known once there is a publisher
        harness.publish("/battery_state", "sensor_msgs/msg/BatteryState", charge, frame="base_link")
        harness.publish("/wheels", "sensor_msgs/msg/JointState", joints, frame="base_link")
        harness.turn()
    harness.wait_until_drawn("Wheels")
    harness.check_picture("text/default")


def test_annotations_are_over_the_image(webviz_harness: Stages) -> None:
    camera = Image(name="Camera", annotations_topic=Topic("/found"))
    annotated = Image(name="Drawn", topic=Topic("/depth"), annotations_topic=Topic("/drawn"))
    view = Orbit(distance=9.0, yaw=-1.2, pitch=0.6)
    harness = webviz_harness(camera, annotated, Grid(plane_cell_count=6), view=view)
    colors, depths = photos.room()
    results = [{"hypothesis": {"class_id": "box", "score": 0.93}}]
    center = {"position": {"x": 96.0, "y": 72.0}}
    box = {"center": center, "size_x": 42.0, "size_y": 52.0}
    turned = {"center": {"position": {"x": 30.0, "y": 90.0}, "theta": 0.4}}
    result = [
        {"bbox": box, "results": results},
        {"bbox": {**turned, "size_x": 30.0, "size_y": 16.0}},
    ]
    yellow, red = {"r": 1.0, "g": 0.9, "a": 1.0}, {"r": 1.0, "a": 0.4}
    floor = [{"x": x, "y": y} for x, y in ((40.0, 80.0), (110.0, 100.0), (20.0, 110.0))]
    line = {"type": 2, "points": floor, "outline_color": yellow, "fill_color": red}
    place = {"x": 20.0, "y": 30.0}
    text = {"position": place, "text": "free floor", "font_size": 12.0, "text_color": yellow}
    ring = {"position": {"x": 96.0, "y": 72.0}, "diameter": 40.0, "outline_color": yellow}
    drawings = {
        "points": [{**line, "thickness": 2.0}],
        "circles": [{**ring, "thickness": 3.0}],
        "texts": [{**text, "background_color": {"a": 0.6}}],
    }
    harness.publish("/found", DETECTIONS, {"detections": result}, frame="camera")
    harness.publish("/drawn", ANNOTATIONS, drawings)
    harness.publish(camera.topic.name, photos.COMPRESSED, photos.jpeg(colors), frame="camera")
    harness.publish("/depth", photos.RAW, photos.raw(depths, "32FC1"), frame="camera")
    harness.turn()
    harness.check_picture("image/annotations")
