"""Images as people see them."""

from __future__ import annotations

from collections.abc import Callable

import photos

from webviz import Topic
from webviz.api.views import Orbit
from webviz.shell.testing import Stage
from webviz_displays.grid import Grid
from webviz_displays.image import Image

Stages = Callable[..., Stage]


def test_images_are_beside_the_scene(webviz_stage: Stages) -> None:
    color = Image(name="Color")
    depth = Image(name="Depth", topic=Topic("/depth"), color_map="Turbo")
    view = Orbit(distance=9.0, yaw=-1.2, pitch=0.6)
    seen = webviz_stage(color, depth, Grid(plane_cell_count=6), view=view)
    colors, depths = photos.room()
    seen.publish(color.topic.name, photos.COMPRESSED, photos.jpeg(colors), frame="camera")
    seen.publish("/depth", photos.RAW, photos.raw(depths, "32FC1"), frame="camera")
    seen.turn()
    seen.check_picture("image/default")
