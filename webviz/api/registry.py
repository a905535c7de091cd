"""The registry of plug-ins by their names in config files.

Displays, tools and panels are registered in the same way. Packages, webviz among them, declare
theirs as entry points of the group `webviz.displays`, `webviz.tools` or `webviz.panels`;
`webviz.engine.pipeline.plugins` registers those of files at run time.
"""

from __future__ import annotations

import functools
import importlib.metadata
from collections.abc import Mapping

from webviz.api.declared import Declared, P
from webviz.api.display import Display, inputs_of
from webviz.api.entry_points import installed
from webviz.api.modules import module_texts

_registered: dict[str, dict[str, type[Declared]]] = {}
"""Classes of every kind by owner and name."""


def entry_point_group(kind: str) -> str:
    """Return the entry point group of a kind of plug-in."""
    return f"webviz.{kind}s"


def plugin_types(base: type[P]) -> dict[str, type[P]]:
    """All classes of a kind by their names in config files.

    Args:
        base: the base class of the kind: `Display`, `Tool` or `Panel`.
    """
    types = dict(_installed(base.kind)[0])
    for registered in list(_registered.values()):  # another thread may register
        types |= {name: cls for name, cls in registered.items() if cls.kind == base.kind}
    return types  # pyright: ignore[reportReturnType]  # each kind has one base class


def plugin_type(base: type[P], name: str) -> type[P] | None:
    """Return the class of a name in config files; None if there is none, or it cannot be loaded.

    Others are not imported: a viewer starts a twentieth sooner without those its config lacks.

    Args:
        base: the base class of the kind: `Display`, `Tool` or `Panel`.
        name: of the class.
    """
    for registered in list(_registered.values()):  # another thread may register
        if (cls := registered.get(name)) is not None and cls.kind == base.kind:
            return cls  # pyright: ignore[reportReturnType]
    point = _points(base.kind).get(name)
    loaded = _loaded(point) if point else None
    return loaded if isinstance(loaded, type) else None  # pyright: ignore[reportReturnType]


def registered_types() -> Mapping[str, Mapping[str, type[Declared]]]:
    """Return the classes of every kind that files have registered, by owner and name."""
    return dict(_registered)


def broken_types(base: type[Declared]) -> dict[str, str]:
    """Installed plug-ins of a kind that cannot be loaded, with the reason."""
    return _installed(base.kind)[1]


def display_types() -> dict[str, type[Display]]:
    """All display classes by their names in config files."""
    return plugin_types(Display)


def type_name(cls: type[Declared]) -> str:
    """Return the name of a class in config files."""
    if plugin_type(cls, cls.__name__) is cls:
        return cls.__name__
    types = plugin_types(cls)
    return next((name for name, each in types.items() if each is cls), cls.__name__)


def register(owner: str, types: Mapping[str, type[Declared]]) -> None:
    """Register plug-ins of any kind by name, replacing all previous ones of the same owner.

    Raises:
        ValueError: a name is taken by another plug-in of that kind; nothing was changed.
    """
    for name, cls in types.items():
        if name in _points(cls.kind):
            raise ValueError(f"an installed package has a {cls.kind} named {name}")
        for other, registered in _registered.items():
            if other != owner and name in registered and registered[name].kind == cls.kind:
                raise ValueError(f"{other} has a {cls.kind} named {name}")
    _registered[owner] = dict(types)


@functools.cache
def _installed(kind: str) -> tuple[dict[str, type[Declared]], dict[str, str]]:
    types: dict[str, type[Declared]] = {}
    broken: dict[str, str] = {}
    for name, point in _points(kind).items():
        loaded = _loaded(point)
        if isinstance(loaded, str):
            broken[name] = loaded
        else:
            types[name] = loaded
    return types, broken


@functools.cache
def _points(kind: str) -> dict[str, importlib.metadata.EntryPoint]:
    """Entry points of a kind by name, sorted."""
    points = sorted(installed(entry_point_group(kind)), key=lambda point: point.name)
    return {point.name: point for point in points}


@functools.cache
def _loaded(point: importlib.metadata.EntryPoint) -> type[Declared] | str:
    """Return the class of an entry point, or the reason why it cannot be loaded."""
    try:
        cls = point.load()
        if issubclass(cls, Display):
            inputs_of(cls)
        module_texts(cls)
    except Exception as error:  # plug-ins may raise anything
        return f"{point.value} does not load: {type(error).__name__}: {error}"
    return cls
