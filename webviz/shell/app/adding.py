"""Validation of displays that Python programs add, and the choice of a display for a topic."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import msgspec

from webviz.api.declared import make
from webviz.api.display import Display
from webviz.api.errors import Error
from webviz.api.registry import display_types, plugin_type
from webviz.data.words import joined
from webviz.engine.parts.by_topic import picks
from webviz.files.config import mistakes, nearest, sentences


class NoSuchProperty(Error, AttributeError):
    """A display does not have this property."""


def no_property(type: str, name: str, valid: Iterable[str]) -> str:
    """Return the error for an unknown property, with a suggestion."""
    return f"{type} has no property `{name}`, {nearest(name, valid)}"


def check_properties(type: str, properties: Mapping[str, Any]) -> None:
    """Refuse unknown properties of a display type; unknown types are ignored.

    Raises:
        NoSuchProperty: a property is unknown; the message lists all errors.
    """
    cls = plugin_type(Display, type)
    fields = cls.__struct_fields__ if cls else properties
    if cls is None or properties.keys() <= set(fields):
        return
    try:
        make(cls, dict(properties))
    except msgspec.ValidationError as error:
        reasons = [
            sentences([(path, clause)])
            if path[0] in fields
            else no_property(type, str(path[0]), fields)
            for path, clause in mistakes(cls, properties, error)
        ]
        raise NoSuchProperty(joined(*reasons)) from error


def by_topic(
    properties: Mapping[str, Any], topics: Mapping[str, tuple[str, ...]]
) -> tuple[str, dict[str, Any]]:
    """Return the display type that shows a topic, and its properties with the topic in its input.

    Args:
        properties: with the name of the topic as `topic`.
        topics: message types of the published topics.

    Raises:
        Error: no display shows the topic, or several do.
    """
    topic = properties.get("topic")
    if not isinstance(topic, str):
        raise Error("Give the type of the display, or the name of a published topic.")
    if topic not in topics:
        hint = nearest(topic, topics) if topics else "there are no publishers."
        raise Error(f"No publisher on {topic}. Give the type of the display, or {hint}")
    fitting = picks({topic: topics[topic]}, display_types())
    if not fitting:
        raise Error(f"No display shows {topic} of type {', '.join(topics[topic])}.")
    if len(fitting) > 1:
        names = ", ".join(pick.display for pick in fitting)
        raise Error(f"Several displays show {topic}. Give the type: {names}.")
    rest = {name: value for name, value in properties.items() if name != "topic"}
    return fitting[0].display, {**fitting[0].values, **rest}
