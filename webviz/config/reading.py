"""Configs from YAML text."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import msgspec
from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError

from webviz.config.errors import ConfigError, describe, nearest
from webviz.config.files import is_rviz, read_text
from webviz.config.model import VERSION, Branch, Config, Item, Settings, Unreadable
from webviz.display import make
from webviz.group import Group
from webviz.registry import broken_display_types, display_types

MAX_VALUES = 200_000
"""In one file; YAML's aliases can make a few lines endless."""


def load(path: Path) -> Config:
    """Read a config file: YAML, or RViz's if its name ends with .rviz.

    Raises:
        ConfigError: the file is missing, no YAML, or not a config. A single display that does not
            fit is no error: it becomes an `Unreadable`.
    """
    text = read_text(path)
    if is_rviz(path):
        from webviz import rviz  # it stands on this module

        return rviz.read(text, str(path))[0]
    return parse(text, str(path))


def parse(text: str, where: str) -> Config:
    """A config from YAML text; `where` names it in errors. See `load`."""
    try:
        document = YAML(typ="safe", pure=True).load(text)
    except YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        place = f"{where}:{mark.line + 1}" if mark else where
        problem = getattr(error, "problem", None) or str(error).splitlines()[0]
        raise ConfigError(f"{place} is not valid YAML: {problem}.") from error
    except (ValueError, RecursionError) as error:  # such as a date that does not exist
        raise ConfigError(f"{where} is not valid YAML: {error}.") from error
    if _is_endless(document):
        raise ConfigError(f"{where} holds more than {MAX_VALUES} values, aliases counted.")
    if not isinstance(document, Mapping):
        raise ConfigError(f"{where} holds no settings such as `fixed_frame: map`.")
    version = document.get("version", VERSION)
    if isinstance(version, int) and version > VERSION:
        raise ConfigError(
            f"{where} has version {version}, this webviz reads up to {VERSION}: update webviz."
        )
    rest = {str(key): value for key, value in document.items() if key != "displays"}
    _refuse_unknown(rest, [*Settings.__struct_fields__, "displays"], where)
    try:
        settings = msgspec.convert(rest, Settings)
    except msgspec.ValidationError as error:
        raise ConfigError(f"{where}: {describe(error)}.") from error
    entries = document.get("displays") or []
    if not isinstance(entries, list):
        raise ConfigError(f"{where}: displays: expected a list, each entry with a `type`.")
    return Config(settings, [read_display(e, f"displays[{i}]") for i, e in enumerate(entries)])


def read_display(entry: Any, place: str) -> Item:
    """A display or group from an entry of a list in a config file, which is at `place`."""
    if not isinstance(entry, Mapping) or not isinstance(entry.get("type"), str):
        return Unreadable(entry, f"{place}: a display needs a `type`, such as `type: Grid`.")
    if "rviz" in entry:
        return Unreadable(
            entry, f"{place}: RViz's {entry['type']} has no counterpart here yet; it is kept."
        )
    types = display_types()
    cls = types.get(entry["type"])
    if cls is Group:
        return _read_group(entry, place)
    if entry["type"] in broken_display_types():
        return Unreadable(entry, f"{place}: {broken_display_types()[entry['type']]}")
    if cls is None:
        hint = nearest(entry["type"], types)
        return Unreadable(entry, f"{place}: no display type `{entry['type']}` here, {hint}")
    values = {key: value for key, value in entry.items() if key != "type"}
    try:
        _refuse_unknown(values, cls.__struct_fields__, place)
        return make(cls, values)
    except ConfigError as error:
        return Unreadable(entry, str(error))
    except msgspec.ValidationError as error:
        return Unreadable(entry, f"{place}.{describe(error)}")


def _read_group(entry: Mapping[str, Any], place: str) -> Branch | Unreadable:
    inner = entry.get("displays") or []
    if not isinstance(inner, list):
        return Unreadable(entry, f"{place}.displays: expected a list, each entry with a `type`.")
    values = {key: value for key, value in entry.items() if key not in ("type", "displays")}
    try:
        _refuse_unknown(values, [*Group.__struct_fields__, "displays"], place)
        group = make(Group, values)
    except ConfigError as error:
        return Unreadable(entry, str(error))
    except msgspec.ValidationError as error:
        return Unreadable(entry, f"{place}.{describe(error)}")
    return Branch(group, [read_display(e, f"{place}.displays[{i}]") for i, e in enumerate(inner)])


def _is_endless(document: Any) -> bool:
    """Whether a document has too many values, such as an alias for what it stands in."""
    waiting, count = [document], 0
    while waiting:
        value = waiting.pop()
        count += 1
        if count > MAX_VALUES:
            return True
        if isinstance(value, Mapping):
            waiting.extend(value.values())
        elif isinstance(value, list):
            waiting.extend(value)
    return False


def _refuse_unknown(values: Mapping[str, Any], valid: Iterable[str], where: str) -> None:
    for key in values:
        if key not in valid:
            raise ConfigError(f"{where}: unknown key `{key}`, {nearest(key, valid)}")
