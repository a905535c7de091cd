"""The properties of displays, tools and nested settings, from RViz's tree and back into one."""

from __future__ import annotations

import typing
from collections.abc import Mapping
from typing import Any, Literal

import msgspec

from webviz.api.declared import Topic
from webviz.api.ports import Output
from webviz.files.rviz import switch_tree, topics, values
from webviz.files.rviz.properties import RvizProperty, properties
from webviz.files.rviz.tree import Path, Tree, leaves, put
from webviz.files.rviz.values import Unfit

WITH_CHILDREN = ("Frames", "Joints")
"""Mappings whose switches RViz writes as {Value: true}, because they have children."""

UNLISTED = {"GridMapLayer", "intensity", "intensities"}
"""Values that RViz and its plug-ins write without offering them as a choice; they mean the default.

A DepthCloud says `intensity` as all clouds do, though its points have none; ROS 1's RViz called the
intensities of scans `intensities`.
"""


class Reading(msgspec.Struct):
    """The result of reading a tree.

    Args:
        used: paths of all values that have a property here.
        faults: paths of invalid values, with the reason.
    """

    used: set[Path] = msgspec.field(default_factory=set)
    faults: list[tuple[Path, str]] = msgspec.field(default_factory=list)

    def struct(self, cls: type[msgspec.Struct], tree: Tree, above: Path = ()) -> dict[str, Any]:
        """Plain values for `cls` from a tree; `above` is its path in the display's tree."""
        result = {}
        places = properties(cls)
        own = [place for place in places if _is_said(place, tree)]
        for place in own:
            result[place.name], used = topics.read(tree, place, self.faults)
            self.used |= {(*above, *path) for path in used}
        topics.complete(result, own)
        for place in places:
            if place.port:
                continue
            raw = _at(tree, place.path)
            if raw is None and place.missing is not None:
                result[place.name] = place.missing
            elif raw is None and _is_struct(place.kind):
                if missing := self.struct(place.kind, {}):
                    result[place.name] = missing
            elif raw is not None:
                path = (*above, *place.path)
                try:
                    result[place.name] = self._value(place, raw, path, places)
                except Unfit as error:
                    self.faults.append((path, f"{error}; using the default"))
        return result

    def _value(
        self, place: RvizProperty, raw: Any, path: Path, all: tuple[RvizProperty, ...]
    ) -> Any:
        origin = typing.get_origin(place.kind)
        if _is_struct(place.kind):
            if not isinstance(raw, Mapping):  # of an old file
                self.used.add(path)
            return self.struct(place.kind, _opened(raw), path)
        if place.is_tree:
            self.used |= set(leaves(raw, path))
            return switch_tree.read(raw)
        if origin is dict:
            others = {p.path[1] for p in all if p.path[0] == place.path[0] and len(p.path) > 1}
            return self._entries(typing.get_args(place.kind)[1], raw, path, others)
        if origin is list:
            self.used.add(path)
            return _converted(raw, place.kind)
        if origin is Literal and values.own_value(raw) in ("", *UNLISTED):
            self.used |= {path, (*path, "Value")}
            return values.AUTO if values.AUTO in typing.get_args(place.kind) else place.default
        value = values.read(_limited(raw, place), place.kind)
        if place.factor != 1.0:
            value /= place.factor
        is_leaf = not isinstance(raw, Mapping) or origin is tuple
        self.used |= set(leaves(raw, path)) if is_leaf else {(*path, "Value")}
        return self._bounded(value, place, path)

    def _entries(self, kind: Any, raw: Any, path: Path, others: set[str]) -> dict[str, Any]:
        """Return settings by name, such as a robot's links; `others` are keys to skip."""
        if not isinstance(raw, Mapping):
            raise Unfit("expected entries")
        result = {}
        is_struct = _is_struct(kind)
        for name, entry in raw.items():
            must_be_open = is_struct or path[-1] in WITH_CHILDREN
            if name in others or (must_be_open and not isinstance(entry, Mapping)):
                continue
            place = RvizProperty(name, (name,), kind, None)
            try:
                result[name] = self._value(place, entry, (*path, name), ())
            except Unfit as error:
                self.faults.append(((*path, name), f"{error}; using the default"))
        return result

    def _bounded(self, value: Any, place: RvizProperty, path: Path) -> Any:
        if place.kind not in (int, float):
            return value
        bounded = value
        if place.low is not None and value < place.low:
            bounded = place.low
        if place.high is not None and value > place.high:
            bounded = place.high
        if bounded != value:
            self.faults.append((path, f"{value:g} is out of range, clamped to {bounded:g}"))
        return place.kind(bounded)


def _is_said(place: RvizProperty, tree: Tree) -> bool:
    """Return whether a tree says what a topic is; that of a display without one is "" in RViz."""
    is_output = isinstance(place.port, Output)
    return place.path[0] in tree if is_output else place.port is not None


def struct_tree(value: msgspec.Struct) -> Tree:
    """Return the properties of a display, tool or nested setting as RViz's tree."""
    tree: Tree = {}
    places = properties(type(value))
    first = next((getattr(value, p.name) for p in places if p.port), Topic())
    for place in places:
        put(tree, place.path, _written(getattr(value, place.name), place, first))
    return tree


def _written(value: Any, place: RvizProperty, first: Topic) -> Any:
    if place.port:
        return topics.write(value, place.port, first)
    if isinstance(value, msgspec.Struct):
        return struct_tree(value)
    if place.is_tree:
        return switch_tree.write(value)
    if isinstance(value, dict):
        kind = typing.get_args(place.kind)[1]
        inner = RvizProperty(place.name, place.path, kind, None)
        open = place.path[-1] in WITH_CHILDREN
        return {
            name: {"Value": entry} if open else _written(entry, inner, first)
            for name, entry in value.items()
        }
    if isinstance(value, list):
        return msgspec.to_builtins(value)
    return values.write(value if place.factor == 1.0 else value * place.factor, place.kind)


def _is_struct(kind: Any) -> bool:
    return isinstance(kind, type) and issubclass(kind, msgspec.Struct)


def _at(tree: Any, path: Path) -> Any:
    """Return the value at a path; a property without children has only its own value."""
    for key in path:
        tree = _opened(tree).get(key)
    return tree


def _limited(raw: Any, place: RvizProperty) -> Any:
    """Return the bound of a property in place of an infinity, which means no limit in RViz."""
    if place.kind is float and place.low is not None and place.high is not None:
        infinities = {"inf": place.high, "-inf": place.low}
        return infinities.get(values.text(values.own_value(raw)).replace(".inf", "inf"), raw)
    return raw


def _opened(raw: Any) -> Tree:
    """Return a property with its children; old files have only its own value."""
    return dict(raw) if isinstance(raw, Mapping) else {"Value": raw}


def _converted(raw: Any, kind: Any) -> Any:
    try:
        return msgspec.to_builtins(msgspec.convert(raw, kind))
    except msgspec.ValidationError as error:
        raise Unfit(str(error)) from None
