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
from webviz_displays.text import Text

Stages = Callable[..., Harness]


def test_images_are_beside_the_scene(webviz_harness: Stages) -> None:
    color = Image(name="Color")
    depth = Image(name="Depth", topic=Topic("/depth"), color_map="Turbo")
    view = Orbit(distance=9.0, yaw=-1.2, pitch=0.6)
    seen = webviz_harness(color, depth, Grid(plane_cell_count=6), view=view)
    colors, depths = photos.room()
    seen.publish(color.topic.name, photos.COMPRESSED, photos.jpeg(colors), frame="camera")
    seen.publish("/depth", photos.RAW, photos.raw(depths, "32FC1"), frame="camera")
    seen.turn()
    seen.check_picture("image/default")


def test_texts_are_beside_the_scene(webviz_harness: Stages) -> None:
    battery = Text(name="Battery", topic=Topic("/battery_state"))
    wheels = Text(name="Wheels", topic=Topic("/wheels"), fields=["header.stamp", "position[left]"])
    seen = webviz_harness(battery, wheels, Grid(plane_cell_count=6), view=Orbit(distance=9.0))
    cells = np.array([3.9, 4.0, 3.95], np.float32)
    charge = {"voltage": 11.85, "percentage": 0.71, "cell_voltage": cells, "location": "rear"}
    joints = {"name": ["left", "right"], "position": [1.25, -0.5]}
    for _ in range(2):  # the type is known once there is a publisher
        seen.publish("/battery_state", "sensor_msgs/msg/BatteryState", charge, frame="base_link")
        seen.publish("/wheels", "sensor_msgs/msg/JointState", joints, frame="base_link")
        seen.turn()
    seen.wait_until_drawn("Wheels")
    seen.check_picture("text/default")
