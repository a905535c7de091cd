"""Configs as YAML text."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import msgspec
from ruamel.yaml.nodes import MappingNode, Node, ScalarNode, SequenceNode
from ruamel.yaml.representer import SafeRepresenter

from webviz.api.declared import Declared, to_values
from webviz.api.registry import type_name
from webviz.api.views import Orbit, View
from webviz.data import plain_yaml
from webviz.files.config.model import (
    VERSION,
    Branch,
    Config,
    Item,
    Settings,
    Unreadable,
    all_panels,
    all_tools,
)
from webviz.files.config.robots import folded

LINE = 88
"""Maximum length of a mapping or list on one line."""
_BREAKS = "\x85\u2028\u2029"
"""Line ends in older YAML, which ruamel writes unquoted and reads as spaces."""


class Representer(SafeRepresenter):
    """ruamel's representer, which also quotes text that would read back as another value."""

    def represent_str(self, data: Any) -> ScalarNode:
        """Text, double-quoted if it contains line ends."""
        style = '"' if any(mark in data for mark in _BREAKS) else None
        return self.represent_scalar("tag:yaml.org,2002:str", data, style)


Representer.add_representer(str, Representer.represent_str)


def document(config: Config) -> dict[str, Any]:
    """Return a config as the values of its file, without defaults."""
    settings = msgspec.to_builtins(config.settings)
    basis = msgspec.to_builtins(Settings())
    values: dict[str, Any] = {"version": VERSION}
    settings["view"] = _without_defaults(config.settings.view)
    settings["views"] = {
        name: _without_defaults(view) for name, view in config.settings.views.items()
    }
    basis |= {"view": {}, "views": {}}
    values |= {key: value for key, value in settings.items() if value != basis[key]}
    rviz_part = values.pop("rviz", None)
    values["displays"] = folded(list(map(entry_of, config.displays)), config.templates)
    plugins = {"tools": (config.tools, all_tools()), "panels": (config.panels, all_panels())}
    for key, (items, installed) in plugins.items():
        entries = list(map(entry_of, items))
        if entries != list(map(entry_of, installed)):
            values[key] = folded(entries, config.templates)
    if rviz_part:
        values["rviz"] = rviz_part  # last, because it is long and seldom read
    return values


def _without_defaults(view: View) -> dict[str, Any]:
    """Return a view as the values of its entry, whose type defaults to Orbit."""
    basis = msgspec.to_builtins(type(view)())
    values = msgspec.to_builtins(view)
    of_type = {} if type(view) is Orbit else {"type": values["type"]}
    return of_type | {key: value for key, value in values.items() if value != basis[key]}


def dump(config: Config) -> str:
    """Return a config as YAML text; see `document`."""
    return _text(document(config))


def dump_displays(items: Sequence[Item]) -> str:
    """Return displays as the list under the key `displays` of a config file."""
    return _text([entry_of(item) for item in items])


def _text(values: Any) -> str:
    # Short lists such as colours stay on one line. A key with a line break cannot be read back.
    return plain_yaml.write(values, representer=_Representer, is_sorted=False)


class _Representer(Representer):
    """Puts each value on its own line if one line is too short for all."""

    def represent_mapping(self, tag: Any, mapping: Any, flow_style: Any = None) -> MappingNode:
        node = super().represent_mapping(tag, mapping, flow_style)
        node.flow_style &= _fits([part for pair in node.value for part in pair])
        return node

    def represent_sequence(self, tag: Any, sequence: Any, flow_style: Any = None) -> SequenceNode:
        node = super().represent_sequence(tag, sequence, flow_style)
        node.flow_style &= _fits(node.value)
        return node


def _fits(nodes: Sequence[Node]) -> bool:
    # ruamel does not quote words that are plain in lines but not within braces: {:0: ?1}.
    is_short = sum(len(node.value) + len(", ") for node in nodes) <= LINE
    return is_short and not any(mark in node.value for node in nodes for mark in ":?")


def entry_of(item: Item | Declared) -> Any:
    """Return a display, tool or panel as the entry of a list, without defaults."""
    if isinstance(item, Unreadable):
        return item.values
    if isinstance(item, Branch):
        inner = [entry_of(each) for each in item.displays]
        return entry_of(item.group) | ({"displays": inner} if inner else {})
    return {"type": type_name(type(item)), **to_values(item)}
