"""Configs from YAML text."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import msgspec

from webviz.api.declared import P, make
from webviz.api.display import Display
from webviz.api.group import DisplayGroup
from webviz.api.panel import Panel
from webviz.api.registry import broken_types, plugin_type, plugin_types
from webviz.api.robots import robots_of
from webviz.api.tool import Tool
from webviz.api.views import with_type
from webviz.files.config.errors import ConfigError, nearest, unknown_key
from webviz.files.config.explain import explain, mistakes, sentences
from webviz.files.config.model import (
    VERSION,
    Branch,
    Config,
    Item,
    PanelItem,
    Settings,
    ToolItem,
    Unreadable,
)
from webviz.files.config.robots import Repetition, Template, filled, repeated
from webviz.files.config.source import Location, YamlDocument
from webviz.files.config.writing import entry_of

NO_TYPE = "a {} needs a `type`, such as `type: {}`."
EXAMPLES = {"display": "Grid", "tool": "GoalPose", "panel": "QuietTopics"}
NO_LIST = "expected a list, each entry with a `type`."
MAX_DISPLAYS = 500
"""Largest number of displays of a config, including groups. Real ones have fewer than 100; with
1000 the page hangs."""
MAX_PLUGINS = 100
"""Tools, or panels, per config."""
_LISTS = ("displays", "tools", "panels")
_KEYS = (*Settings.__struct_fields__, *_LISTS)
_TELLING = frozenset(_KEYS) - {"version", "rviz"}
"""Keys that only webviz's configs have."""


def read(text: str, where: str) -> Config:
    """Return a config from YAML text; parts kept from a .rviz file are not interpreted.

    Args:
        text: YAML.
        where: names the text in errors.

    Raises:
        ConfigError: the text is not YAML or not a config; the sentence does not quote
            the file. A single invalid display, tool or panel becomes an `Unreadable` instead.
    """
    source = YamlDocument(text, where)
    document, top = source.values(), Location(source=source)
    if document is None:
        raise ConfigError(f"{where} is empty: a config needs at least `version: {VERSION}`.")
    if not isinstance(document, Mapping):
        raise ConfigError(f"{where} contains no settings such as `fixed_frame: map`.")
    if "Visualization Manager" in document:
        raise ConfigError(f"{where} is RViz's config: its name must end with .rviz.")
    _refuse_other_files(document, where, top)
    version = document.get("version", VERSION)
    if isinstance(version, int) and version > VERSION:
        raise ConfigError(
            f"{where} has version {version}, this webviz reads up to {VERSION}: update webviz."
        )
    rest = {str(key): value for key, value in document.items() if key not in _LISTS}
    _refuse_unknown(rest, _KEYS, top)
    rest = _typed(rest)
    try:
        settings = msgspec.convert(rest, Settings)
    except msgspec.ValidationError as error:
        path, clause = explain(error, Settings, rest)
        raise ConfigError(top.at(*path).says(clause)) from error
    names = [robot.name for robot in robots_of(settings.robots)]
    entries = repeated(_list(document, "displays", top), names)
    refuse_too_many([entry for _, entry, _ in entries], "displays", where)
    items = [read_display(filled(entry, name), top.at("displays", i)) for i, entry, name in entries]
    config = Config(settings, items, templates=_templates(entries, items))
    if "tools" in document:
        entries = repeated(_list(document, "tools", top), names)
        config.tools = _plugins(Tool, entries, where, top)
        config.templates += _templates(entries, config.tools)
    if "panels" in document:
        config.panels = _plugins(Panel, repeated(_list(document, "panels", top), ()), where, top)
    return config


def _plugins(
    base: type[P], entries: Sequence[Repetition], where: str, top: Location
) -> list[P | Unreadable]:
    """Return the list of tools or panels."""
    key = f"{base.kind}s"
    if len(entries) > MAX_PLUGINS:
        raise ConfigError(f"{where} has {len(entries)} {key}; the limit is {MAX_PLUGINS}.")
    return [_read_plugin(base, filled(entry, name), top.at(key, i)) for i, entry, name in entries]


def _templates(
    entries: Iterable[Repetition], items: Iterable[Item | ToolItem]
) -> tuple[Template, ...]:
    """Return the entries that were repeated, given what became of them."""
    by_place: dict[int, tuple[Any, list[Any]]] = {}
    for (place, entry, name), item in zip(entries, items, strict=True):
        if name:
            by_place.setdefault(place, (entry, []))[1].append(entry_of(item))
    return tuple(Template(entry, written) for entry, written in by_place.values())


def _list(document: Mapping[Any, Any], key: str, top: Location) -> list[Any]:
    entries = document.get(key) or []
    if not isinstance(entries, list):
        raise ConfigError(top.at(key).says(NO_LIST))
    return entries


def refuse_too_many(entries: Iterable[Any], key: str, where: str) -> None:
    """Refuse a list of displays that exceeds the limit.

    Args:
        entries: of the list, as in a file.
        key: of the list in the entry of a group.
        where: names the file.

    Raises:
        ConfigError: it has more than `MAX_DISPLAYS`.
    """
    waiting, count = [entries], 0
    while waiting:
        for entry in waiting.pop():
            count += 1
            inner = entry.get(key) if isinstance(entry, Mapping) else None
            if isinstance(inner, list):
                waiting.append(inner)
    if count > MAX_DISPLAYS:
        raise ConfigError(
            f"{where} has {count} displays; the limit is {MAX_DISPLAYS}. Split it into several."
        )


def _refuse_other_files(document: Mapping[Any, Any], where: str, top: Location) -> None:
    """Refuse text that is not a config; quote at most a key that resembles a valid one."""
    keys = [str(key) for key in document]
    if _TELLING.intersection(keys) or set(keys) <= set(_KEYS):
        return
    for key in keys:
        if key not in _KEYS and difflib.get_close_matches(key, _KEYS, n=1):
            _refuse_unknown([key], _KEYS, top)
    raise ConfigError(f"{where} is not a config: expected keys such as `fixed_frame: map`.")


def _typed(settings: dict[str, Any]) -> dict[str, Any]:
    """Return settings with an explicit type in every view."""
    if "view" in settings:
        settings = settings | {"view": with_type(settings["view"])}
    if isinstance(views := settings.get("views"), Mapping):
        settings = settings | {"views": {key: with_type(view) for key, view in views.items()}}
    return settings


def read_display(entry: Any, place: Location) -> Item:
    """Return a display or group from an entry at `place` of a list in a config file."""
    is_group = isinstance(entry, Mapping) and entry.get("type") == "Group"
    inner = (entry.get("displays") or []) if is_group else []
    if not isinstance(inner, list):
        return Unreadable(entry, place.at("displays").says(NO_LIST))
    display = _read_plugin(Display, entry, place, ("displays",) if is_group else ())
    if not isinstance(display, DisplayGroup):
        return display
    places = (place.at("displays", index) for index in range(len(inner)))
    return Branch(display, [read_display(e, at) for e, at in zip(inner, places, strict=True)])


def read_tool(entry: Any, place: Location) -> ToolItem:
    """Return a tool from an entry at `place` of a list in a config file."""
    return _read_plugin(Tool, entry, place)


def read_panel(entry: Any, place: Location) -> PanelItem:
    """Return a panel from an entry at `place` of a list in a config file."""
    return _read_plugin(Panel, entry, place)


def _read_plugin(
    base: type[P], entry: Any, place: Location, others: tuple[str, ...] = ()
) -> P | Unreadable:
    """Return a plug-in from an entry of a list; the keys `others` are not its properties."""
    kind = base.kind
    if not isinstance(entry, Mapping) or not isinstance(entry.get("type"), str):
        return Unreadable(entry, place.says(NO_TYPE.format(kind, EXAMPLES[kind])))
    if "rviz" in entry:
        reason = f"Unsupported {kind} class {entry['type']}."
        return Unreadable(entry, place.says(reason))
    cls = plugin_type(base, entry["type"])
    if cls is None:
        hint = nearest(entry["type"], plugin_types(base))
        reason = f"unknown {kind} type `{entry['type']}`, {hint}"
        return Unreadable(
            entry, place.at("type").says(broken_types(base).get(entry["type"], reason))
        )
    values = {str(key): value for key, value in entry.items() if key not in ("type", *others)}
    try:
        return make(cls, values)
    except msgspec.ValidationError as error:
        return Unreadable(entry, sentences(mistakes(cls, values, error, others), place))


def _refuse_unknown(values: Iterable[str], valid: Iterable[str], place: Location) -> None:
    for key in values:
        if key not in valid:
            raise ConfigError(place.at(key).says(unknown_key(key, valid)))
