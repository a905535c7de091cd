"""The plug-ins for classes of RViz."""

from __future__ import annotations

import functools

from webviz.api.declared import P
from webviz.api.registry import plugin_types

ROS_1 = {
    "rviz/WrenchStamped": "rviz_default_plugins/Wrench",
    "octomap_rviz_plugin/OccupancyGrid": "octomap_rviz_plugins/OccupancyGrid",
    "octomap_rviz_plugin/ColorOccupancyGrid": "octomap_rviz_plugins/ColorOccupancyGrid",
    "octomap_rviz_plugin/OccupancyMap": "octomap_rviz_plugins/OccupancyMap",
    "rtabmap_ros/Info": "rtabmap_rviz_plugins/Info",
    "rtabmap_ros/MapCloud": "rtabmap_rviz_plugins/MapCloud",
    "rtabmap_ros/MapGraph": "rtabmap_rviz_plugins/MapGraph",
}
"""Classes of ROS 1 whose names in ROS 2 differ by more than RViz's package."""


def counterpart(base: type[P], cls: str) -> type[P] | None:
    """Return the type of display or tool for RViz's class, also by its name in ROS 1."""
    return _classes(tuple(plugin_types(base).values())).get(ROS_1.get(cls, cls))


@functools.lru_cache(maxsize=8)
def _classes(types: tuple[type[P], ...]) -> dict[str, type[P]]:
    by_name = {cls.rviz: cls for cls in types if cls.rviz}
    own = {
        name.partition("/")[2]: cls
        for name, cls in by_name.items()
        if name.startswith(("rviz_common/", "rviz_default_plugins/"))
    }
    return {f"rviz/{name}": cls for name, cls in own.items()} | by_name
