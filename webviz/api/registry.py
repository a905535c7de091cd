"""The display types there are, by the name each has in config files.

Packages name theirs as entry points of the group "webviz.displays", the built-in displays among
them; those of `webviz.engine.plugins` are registered while the program runs.
"""

from __future__ import annotations

import functools
import importlib.metadata
from collections.abc import Mapping

from webviz.api.declared import default_name
from webviz.api.display import Display

ENTRY_POINT_GROUP = "webviz.displays"

_registered: dict[str, dict[str, type[Display]]] = {}
"""Display classes by owner and name."""


def display_types() -> dict[str, type[Display]]:
    """Every display class by the name it has in config files."""
    types = dict(_installed()[0])
    for registered in list(_registered.values()):  # another thread may read a config meanwhile
        types |= registered
    return types


def broken_display_types() -> dict[str, str]:
    """Installed display types that cannot be loaded, with the reason."""
    return _installed()[1]


def type_name(cls: type[Display]) -> str:
    """The name a display class has in config files."""
    return next((name for name, each in display_types().items() if each is cls), default_name(cls))


def register(owner: str, types: Mapping[str, type[Display]]) -> None:
    """Offer display classes by name, in place of all that the same owner offered before.

    Raises:
        ValueError: a name belongs to somebody else's display; nothing was changed.
    """
    installed, broken = _installed()
    for name in types:
        if name in installed or name in broken:
            raise ValueError(f"an installed package has a display named {name}")
        for other, registered in _registered.items():
            if other != owner and name in registered:
                raise ValueError(f"{other} has a display named {name}")
    _registered[owner] = dict(types)


@functools.cache
def _installed() -> tuple[dict[str, type[Display]], dict[str, str]]:
    types: dict[str, type[Display]] = {}
    broken: dict[str, str] = {}
    points = importlib.metadata.entry_points(group=ENTRY_POINT_GROUP)
    for point in sorted(points, key=lambda p: p.name):
        try:
            types[point.name] = point.load()
        except Exception as error:  # somebody else's module may raise anything
            broken[point.name] = f"{point.value} does not load: {type(error).__name__}: {error}"
    return types, broken
