"""The plug-ins for classes of RViz."""

from __future__ import annotations

import functools

from webviz.api.declared import P
from webviz.api.registry import plugin_types


def counterpart(base: type[P], cls: str) -> type[P] | None:
    """The type of display or tool for RViz's class, also by its name in ROS 1."""
    return _classes(tuple(plugin_types(base).values())).get(cls)


@functools.lru_cache(maxsize=8)
def _classes(types: tuple[type[P], ...]) -> dict[str, type[P]]:
    found = {cls.rviz: cls for cls in types if cls.rviz}
    return {f"rviz/{name.partition('/')[2]}": cls for name, cls in found.items()} | found
