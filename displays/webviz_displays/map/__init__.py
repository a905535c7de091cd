"""Occupancy grids: maps and costmaps."""

from __future__ import annotations

import functools
from types import SimpleNamespace
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray

from webviz import Input, Prop, Topic
from webviz_displays.map.display import Map, MapDisplay
from webviz_displays.map.palettes import Scheme, lookup_table

__all__ = ["Costmap", "Map"]

_MEANINGS = {0: "free", 253: "inscribed", 254: "lethal", 255: "unknown"}


def _occupancies() -> NDArray[np.uint8]:
    """Return the value of an occupancy grid for each cost, int8 read as uint8, as in nav2.

    The formula is that of nav2_costmap_2d's costmap_2d_publisher.cpp.
    """
    table = (1 + 97 * (np.arange(256) - 1) // 251).astype(np.uint8)
    table[[0, 253, 254, 255]] = 0, 99, 100, 255
    return table


@functools.lru_cache(maxsize=64)
def cost_table(scheme: Scheme, alpha: float, threshold: int | None) -> NDArray[np.uint8]:
    """Return the colours of costs, uint8 (256, 4), not to be written to; see `lookup_table`."""
    table = lookup_table(scheme, alpha, threshold)
    if scheme == "raw" and threshold is None:
        return table
    costs = table[_occupancies()]
    costs.flags.writeable = False
    return costs


class Costmap(MapDisplay):
    """A costmap of Nav2 with its costs from 0 to 255, as its planners see them."""

    topic: Annotated[Topic, Input("nav2_msgs/msg/Costmap"), Prop(help="Topic of the costmaps.")] = (
        Topic("/local_costmap/costmap_raw")
    )
    update_topic: Annotated[
        Topic,
        Input("nav2_msgs/msg/CostmapUpdate", suffix="_updates", optional=True),
        Prop(help="Topic of partial updates; empty means the costmap's topic + _updates."),
    ] = Topic()
    color_scheme: Annotated[
        Literal["map", "costmap", "raw"],
        Prop(
            help="costmap: blue to red, cyan for inscribed and magenta for lethal costs. "
            "map: white free, black lethal. raw: the cost as grey."
        ),
    ] = "costmap"

    def as_grid(self, name: str, message: Any) -> Any:
        """Costs stay as they are; only the fields have other names."""
        cells = message.data.view(np.int8)
        if name == "topic":
            info = message.metadata
            size = {"width": info.size_x, "height": info.size_y}
            place = {"resolution": info.resolution, "origin": info.origin}
            return SimpleNamespace(info=SimpleNamespace(**size, **place), data=cells)
        size = {"width": message.size_x, "height": message.size_y}
        return SimpleNamespace(x=message.x, y=message.y, data=cells, **size)

    def table(self, alpha: float, threshold: int | None) -> NDArray[np.uint8]:
        """Return the colours of costs."""
        return cost_table(self.color_scheme, alpha, threshold)

    def value_text(self, value: int) -> str | int:
        """Return the cost, 0 to 255."""
        cost = value & 255
        return f"{cost}, {_MEANINGS[cost]}" if cost in _MEANINGS else cost
