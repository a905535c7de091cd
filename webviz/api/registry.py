"""The plug-ins there are, by the name each has in config files.

A kind of plug-in is a base class with a `kind`: displays, tools and panels are found, named and
registered in one way. Packages name theirs as entry points of the group `webviz.displays`,
`webviz.tools` or `webviz.panels`, webviz's own among them; those of `webviz.engine.plugins` are
registered while the program runs.
"""

from __future__ import annotations

import functools
import importlib.metadata
from collections.abc import Mapping

from webviz.api.declared import Declared, P
from webviz.api.display import Display, inputs_of

_registered: dict[str, dict[str, type[Declared]]] = {}
"""Classes of every kind by owner and name."""


def entry_point_group(kind: str) -> str:
    """The group of entry points under which packages name their plug-ins of a kind."""
    return f"webviz.{kind}s"


def plugin_types(base: type[P]) -> dict[str, type[P]]:
    """Every class of a kind by the name it has in config files.

    Args:
        base: the base class of the kind: `Display`, `Tool` or `Panel`.
    """
    types = dict(_installed(base.kind)[0])
    for registered in list(_registered.values()):  # another thread may read a config meanwhile
        types |= {name: cls for name, cls in registered.items() if cls.kind == base.kind}
    return types  # pyright: ignore[reportReturnType]  # a kind has one base class


def broken_types(base: type[Declared]) -> dict[str, str]:
    """Installed plug-ins of a kind that cannot be loaded, with the reason."""
    return _installed(base.kind)[1]


def display_types() -> dict[str, type[Display]]:
    """Every display class by the name it has in config files."""
    return plugin_types(Display)


def type_name(cls: type[Declared]) -> str:
    """The name a class has in config files."""
    types = plugin_types(cls)
    return next((name for name, each in types.items() if each is cls), cls.__name__)


def register(owner: str, types: Mapping[str, type[Declared]]) -> None:
    """Offer plug-ins of any kind by name, in place of all that the same owner offered before.

    Raises:
        ValueError: a name belongs to another plug-in of that kind; nothing was changed.
    """
    for name, cls in types.items():
        installed, broken = _installed(cls.kind)
        if name in installed or name in broken:
            raise ValueError(f"an installed package has a {cls.kind} named {name}")
        for other, registered in _registered.items():
            if other != owner and name in registered and registered[name].kind == cls.kind:
                raise ValueError(f"{other} has a {cls.kind} named {name}")
    _registered[owner] = dict(types)


@functools.cache
def _installed(kind: str) -> tuple[dict[str, type[Declared]], dict[str, str]]:
    types: dict[str, type[Declared]] = {}
    broken: dict[str, str] = {}
    points = importlib.metadata.entry_points(group=entry_point_group(kind))
    for point in sorted(points, key=lambda p: p.name):
        try:
            cls = point.load()
            if issubclass(cls, Display):
                inputs_of(cls)
            types[point.name] = cls
        except Exception as error:  # somebody else's module may raise anything
            broken[point.name] = f"{point.value} does not load: {type(error).__name__}: {error}"
    return types, broken
