"""Default allow-list of a viewer whose config has none."""

from __future__ import annotations

import functools
from collections.abc import Iterator, Sequence

from webviz.api.capabilities import ProtocolClient, capability
from webviz.api.declared import make
from webviz.api.display import Display
from webviz.api.panel import Panel
from webviz.api.registry import plugin_types
from webviz.api.tool import Tool, outputs
from webviz.engine.error_boundary import ErrorBoundary
from webviz.files.config import Branch, Config, Item
from webviz.sources import Rights

Plugin = Tool | Panel | Display

PATTERN = frozenset("*?[")
"""Characters that match others in a list of what may be published."""


def rights_of(
    config: Config, may_publish: bool, also: Sequence[str], boundary: ErrorBoundary
) -> Rights:
    """Return the rights of a viewer; see `Rights`.

    Args:
        config: with which it is started.
        may_publish: whether anything may be sent.
        also: names that are allowed besides.
        boundary: around calls of plug-ins; one that fails adds no name.
    """
    addable = functools.cache(lambda: _names_of_displays(boundary))
    own = _names_of_config(config, boundary)
    return Rights(may_publish, config.settings.publish, own, tuple(also), addable)


def own_names(config: Config, boundary: ErrorBoundary) -> tuple[str, ...]:
    """Return the names of a config's own topics, services and actions, sorted.

    They are those of its tools, displays and panels, and those of installed displays and panels
    with default properties, since pages may add these. What is changed later adds no name, or
    pages that may change a property could publish anywhere. Nor does a pattern that is entered
    as a property: patterns are for the list `publish`, and for plug-ins.

    Args:
        config: with which a viewer is started.
        boundary: around calls of plug-ins; one that fails adds no name.
    """
    return tuple(sorted({*_names_of_config(config, boundary), *_names_of_displays(boundary)}))


def _names_of_config(config: Config, boundary: ErrorBoundary) -> tuple[str, ...]:
    """Return the own names of a config, without those that only displays have that it lacks."""
    names: set[str] = set()
    for item in [*config.tools, *config.panels, *_flat(config.displays)]:
        if isinstance(item, Plugin):
            names |= boundary.attempt(item.name, set[str](), _names_of, item)
    names = {name for name in names if PATTERN.isdisjoint(name)}
    return tuple(sorted((names | _names_of_types(Panel, boundary)) - {""}))


def _names_of_displays(boundary: ErrorBoundary) -> tuple[str, ...]:
    """Return the names that installed displays have with default properties; imports them all."""
    return tuple(sorted(_names_of_types(Display, boundary) - {""}))


def _names_of_types(base: type[Panel] | type[Display], boundary: ErrorBoundary) -> set[str]:
    names: set[str] = set()
    for name, cls in plugin_types(base).items():
        names |= boundary.attempt(name, set[str](), lambda cls=cls: _names_of(make(cls, {})))
    return names


def _names_of(plugin: Plugin) -> set[str]:
    user = capability(plugin, ProtocolClient) if isinstance(plugin, Display) else plugin
    names = set(user.uses if user else ())
    if isinstance(plugin, Tool):
        names |= {topic.name for _, _, topic in outputs(plugin)}
        if (vehicle := plugin.vehicle) is not None:
            names.add(vehicle.topic.name)
    elif isinstance(plugin, Panel):
        names |= plugin.publications().keys()
    return names


def _flat(items: Sequence[Item]) -> Iterator[Item]:
    for item in items:
        if isinstance(item, Branch):
            yield from _flat(item.displays)
        else:
            yield item
