"""Values that override a config file: `--set displays.Scan.size=0.1`."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NoReturn

import msgspec

from webviz.api.declared import P, make, set_property
from webviz.api.group import DisplayGroup
from webviz.files.config import (
    Branch,
    Config,
    ConfigError,
    Item,
    Location,
    PanelItem,
    Settings,
    ToolItem,
    Unreadable,
    YamlDocument,
    explain,
    nearest,
    read_display,
    read_panel,
    read_tool,
)
from webviz.files.config.source import Path

Entry = Item | ToolItem | PanelItem
"""Entry of a list of a config."""

_LISTS = {"displays": read_display, "tools": read_tool, "panels": read_panel}
FORM = "write it as displays.Scan.size=0.1 or view.distance=5"
_SETTINGS = tuple(key for key in Settings.__struct_fields__ if key not in ("version", "rviz"))
_STEP = re.compile(
    r"""\.?(?: \[(?P<index>\d+)\] | \[?"(?P<quoted>[^"]*)"\]? | (?P<word>[^.\["=]+) )""", re.VERBOSE
)


def override(config: Config, assignments: Sequence[str]) -> Config:
    """Return a config with overridden values.

    Args:
        config: not modified.
        assignments: each a path, "=", and a value as YAML has it. Displays have their name or
            their place in the list: `displays.Sensors.Front.size=0.1`, `displays[2].color[0]=255`;
            a name with dots is quoted. So do tools and panels: `tools."2D Goal Pose".topic=/goal`.

    Raises:
        ConfigError: the path is unknown or ambiguous, or the value is invalid.
    """
    for assignment in assignments:
        config = _Assignment(assignment).applied(config)
    return config


class _Assignment:
    def __init__(self, text: str) -> None:
        self._text = text
        path, end = [], 0
        while step := _STEP.match(text, end):
            index, quoted, word = step.group("index", "quoted", "word")
            path.append(int(index) if index else word if quoted is None else quoted)
            end = step.end()
        if not path or text[end : end + 1] != "=":
            self._refuse(FORM)
        self._path: Path = tuple(path)
        self._kind = str(path[0]).removesuffix("s")
        value = text[end + 1 :]
        self._value = YamlDocument(value, f"--set {text}").values() if value.strip() else ""

    def applied(self, config: Config) -> Config:
        steps = self._path[1:]
        if (key := str(self._path[0])) in _LISTS:
            return msgspec.structs.replace(
                config, **{key: self._in_list(getattr(config, key), steps)}
            )
        return msgspec.structs.replace(config, settings=self._in_settings(config.settings))

    def _in_settings(self, settings: Settings) -> Settings:
        key = str(self._path[0])
        if key not in _SETTINGS:
            self._refuse(f"unknown key, {nearest(key, [*_LISTS, *_SETTINGS])}")
        values = msgspec.to_builtins(settings)
        if self._path == ("view", "type"):  # each type has keys of its own
            values[key] = {"type": self._value}
        else:
            values[key] = _patched(values[key], self._path[1:], self._value)
        try:
            return msgspec.convert(values, Settings)
        except msgspec.ValidationError as error:
            self._refuse_value(*explain(error, Settings, values))

    def _in_list(self, items: Sequence[Entry], steps: Path) -> list[Any]:
        if not steps:
            self._refuse(FORM)
        index = self._index_of(items, steps[0])
        return [*items[:index], self._in_item(items[index], steps[1:]), *items[index + 1 :]]

    def _in_item(self, item: Entry, steps: Path) -> Entry:
        if isinstance(item, Branch):
            if len(steps) < 2 and (not steps or steps[0] in DisplayGroup.__struct_fields__):
                return Branch(self._in_display(item.group, steps), item.displays)
            inner = steps[1:] if steps[0] == "displays" else steps
            return Branch(item.group, self._in_list(item.displays, inner))
        if isinstance(item, Unreadable):
            return self._in_unreadable(item, steps)
        return self._in_display(item, steps)

    def _in_display(self, display: P, steps: Path) -> P:
        fields = type(display).__struct_fields__
        key = str(steps[0]) if steps else ""
        if key not in fields:
            self._refuse(f"unknown key, {nearest(key, fields)}" if steps else FORM)
        values = msgspec.to_builtins(display)
        changed = make(type(display), values)
        value = _patched(values[key], steps[1:], self._value)
        try:
            set_property(changed, key, value)
        except msgspec.ValidationError as error:
            path, clause = explain(error, type(display), {key: value})
            self._refuse_value((*self._path[: -len(steps)], *path), clause)
        return changed

    def _in_unreadable(self, item: Unreadable, steps: Path) -> Entry:
        """Return an invalid entry, which this value may repair."""
        if item.is_from_rviz or not isinstance(item.values, Mapping) or not steps:
            self._refuse(f"this {self._kind} is not shown: {item.reason}")
        read_again = _LISTS[str(self._path[0])]
        read = read_again(_patched(dict(item.values), steps, self._value), Location())
        if isinstance(read, Unreadable):
            self._refuse(read.reason)
        return read

    def _index_of(self, items: Sequence[Entry], step: str | int) -> int:
        """Return the place in a list of what has a name, or this place."""
        named = [index for index, item in enumerate(items) if _name(item) == step]
        if len(named) == 1:
            return named[0]
        above = self._path[: self._path.index(step)]
        if named:
            places = [Location((*above, index)).words() for index in named]
            self._refuse(f"`{step}` names several displays, use {' or '.join(places)}")
        if str(step).isdecimal() and int(step) < len(items):
            return int(step)
        deeper = [path for path, name in _tree(items) if name == step]
        if len(deeper) == 1:
            names = ".".join(map(str, (*above, *deeper[0])))
            self._refuse(f"no {self._kind} `{step}` here, did you mean {names}?")
        names = [_name(item) for item in items]
        hint = nearest(str(step), names)
        self._refuse(f"no {self._kind} `{step}`, {hint}")

    def _refuse_value(self, path: Path, clause: str) -> NoReturn:
        """Refuse the value; the error names its place if it lies below the given path."""
        deeper = path[len(self._path) :] if path[: len(self._path)] == self._path else ()
        self._refuse(Location(deeper).says(clause))

    def _refuse(self, clause: str) -> NoReturn:
        raise ConfigError(f"--set {self._text}: {clause}{'' if clause[-1] in '.?:' else '.'}")


def _patched(plain: Any, path: Path, value: Any) -> Any:
    """Plain values with one value replaced; a mapping keeps its other keys."""
    if not path:
        is_part = isinstance(plain, Mapping) and isinstance(value, Mapping) and "type" not in value
        return {**plain, **value} if is_part else value
    step, rest = path[0], path[1:]
    if isinstance(plain, list | tuple) and isinstance(step, int) and step < len(plain):
        return [_patched(each, rest, value) if i == step else each for i, each in enumerate(plain)]
    inner = plain if isinstance(plain, Mapping) else {}
    return {**inner, str(step): _patched(inner.get(str(step)), rest, value)}


def _name(item: Entry) -> str:
    return item.group.name if isinstance(item, Branch) else item.name


def _tree(items: Sequence[Entry], above: tuple[str, ...] = ()) -> Iterator[tuple[Any, str]]:
    """Every display in groups with its path of names."""
    for item in items:
        path = (*above, _name(item))
        yield path, _name(item)
        if isinstance(item, Branch):
            yield from _tree(item.displays, path)
