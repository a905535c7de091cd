"""Map as people see it."""

from __future__ import annotations

from collections.abc import Callable

import building
import numpy as np
from scipy.ndimage import distance_transform_edt

from webviz.api.views import Orbit
from webviz.shell.testing import Harness, turned
from webviz_displays.grid import Grid
from webviz_displays.map import Map

Stages = Callable[..., Harness]

GRID = "nav_msgs/msg/OccupancyGrid"
VIEW = Orbit(distance=12.5, yaw=-1.5708, pitch=1.1, focal_point=(0.0, -0.2, 0.0))


def costs() -> np.ndarray:
    """A costmap of the building, as nav2's inflation layer makes it: int8 (height, width)."""
    occupied = building.WORLD.occupied
    distance = np.asarray(distance_transform_edt(~occupied)) * building.WORLD.resolution
    inflated = np.where(distance < 0.2, 99, 98 * np.exp(-5.0 * (distance - 0.2)))
    inflated[distance > 0.8] = 0
    inflated[occupied] = 100
    inflated[building.WORLD.cells < 0] = -1
    return inflated.astype(np.int8)


def test_a_map_has_schemes_alpha_and_updates(webviz_harness: Stages) -> None:
    harness = webviz_harness(Map(), Grid(), view=VIEW)
    harness.transform("map", "elsewhere")
    harness.publish("/map", GRID, building.grid(), frame="map")
    harness.turn()
    harness.check_picture("map/default")
    harness.set("alpha", 1.0)
    harness.check_picture("map/alpha_1")
    harness.set("color_scheme", "raw")
    harness.check_picture("map/raw")
    harness.set("color_scheme", "costmap")
    harness.set("binary_representation", True)
    harness.check_picture("map/costmap_binary")
    harness.set("binary_representation", False)
    harness.set("color_scheme", "map")
    cells = np.tile(np.arange(-1, 101, 3, dtype=np.int8), (40, 1))
    update = {"x": 90, "y": 70, "width": cells.shape[1], "height": 40, "data": cells.ravel()}
    harness.publish("/map_updates", "map_msgs/msg/OccupancyGridUpdate", update, frame="map")
    harness.turn()
    harness.check_picture("map/update_of_40_rows")


def test_cells_are_sharp_and_the_origin_may_be_turned(webviz_harness: Stages) -> None:
    harness = webviz_harness(
        Map(alpha=1.0),
        Grid(),
        view=Orbit(distance=4.0, yaw=-1.2, pitch=1.0, focal_point=(0.5, 0.0, 0.0)),
    )
    harness.transform("map", "room", (0.5, 0.0, 0.0), turned(yaw=0.3))
    origin = {"position": {"x": -1.0, "y": -1.0}, "orientation": {"z": 0.2474, "w": 0.9689}}
    info = {"resolution": 0.25, "width": 8, "height": 6, "origin": origin}
    data = [0, 100, 50, -1, 10, 25, 75, 99] * 3 + [100, 0, 0, 0, 0, 0, 0, 100] * 3
    harness.publish("/map", GRID, {"info": info, "data": data}, frame="room")
    harness.turn()
    harness.check_picture("map/turned_origin_in_a_turned_frame")


def test_maps_stack_by_their_place_in_the_list(webviz_harness: Stages) -> None:
    costmap = Map(name="Costmap", color_scheme="costmap", alpha=0.6)
    costmap.topic = type(costmap.topic)("/costmap")
    harness = webviz_harness(Map(alpha=1.0), costmap, view=VIEW)
    harness.transform("map", "elsewhere")
    harness.publish("/map", GRID, building.grid(), frame="map")
    half = costs()
    half[:, 124:] = 0  # free cells of a costmap are transparent
    harness.publish("/costmap", GRID, building.grid(half), frame="map")
    harness.turn()
    harness.check_picture("map/costmap_over_map")
    harness.set("alpha", 1.0, display="Costmap")
    harness.set("draw_behind", True, display="Costmap")
    # Behind what is opaque there is nothing to see of it.
    harness.check_picture("map/costmap_behind_map", each_display=False)
    harness.set("alpha", 0.4)
    harness.check_picture("map/costmap_behind_map_of_alpha_0.4")
