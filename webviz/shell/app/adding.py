"""What Python programs may add: types of displays, their properties, and topics."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import msgspec

from webviz.api.declared import make
from webviz.api.errors import Error
from webviz.api.registry import display_types
from webviz.engine.by_topic import picks
from webviz.files.config import mistakes, nearest, sentences


class NoSuchProperty(Error, AttributeError):
    """A display has no property of that name."""


def no_property(type: str, name: str, valid: Iterable[str]) -> str:
    """That a display type lacks a property, and which was meant."""
    return f"{type} has no property `{name}`, {nearest(name, valid)}"


def check_properties(type: str, properties: Mapping[str, Any]) -> None:
    """Refuse what a display type lacks; of a type that does not exist others tell.

    Raises:
        NoSuchProperty: it has not one of these; the sentences tell of all that is wrong.
    """
    cls = display_types().get(type)
    fields = cls.__struct_fields__ if cls else properties
    if cls is None or properties.keys() <= set(fields):
        return
    try:
        make(cls, dict(properties))
    except msgspec.ValidationError as error:
        told = [
            sentences([(path, clause)])
            if path[0] in fields
            else no_property(type, str(path[0]), fields)
            for path, clause in mistakes(cls, properties, error)
        ]
        raise NoSuchProperty(" ".join(told)) from error


def by_topic(
    properties: Mapping[str, Any], topics: Mapping[str, tuple[str, ...]]
) -> tuple[str, dict[str, Any]]:
    """The display type that shows a topic, and the properties with the topic where it belongs.

    Args:
        properties: with the name of the topic as `topic`.
        topics: message types of the topics that are published.

    Raises:
        Error: none shows it, or several do.
    """
    topic = properties.get("topic")
    if not isinstance(topic, str):
        raise Error("Give the type of the display, or the name of a topic that is published.")
    if topic not in topics:
        hint = nearest(topic, topics) if topics else "nothing is published."
        raise Error(f"No publisher on {topic}. Give the type of the display, or {hint}")
    fitting = picks({topic: topics[topic]}, display_types())
    if not fitting:
        raise Error(f"No display shows {topic}, whose type is {', '.join(topics[topic])}.")
    if len(fitting) > 1:
        names = ", ".join(pick.display for pick in fitting)
        raise Error(f"Several displays show {topic}, so say which: {names}.")
    rest = {name: value for name, value in properties.items() if name != "topic"}
    return fitting[0].display, {fitting[0].input: topic, **rest}
