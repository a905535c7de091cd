"""Displays that can show live topics."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from webviz.api.display import Display, inputs_of
from webviz.api.ports import ANY, Namespace


@dataclass(frozen=True, order=True)
class Pick:
    """A topic and a display for it.

    Args:
        topic: its name.
        display: name of the display type.
        input: the property that takes the topic.
        message: the type of its messages.
        namespace: that the property takes instead of the topic, "" if it does not.
    """

    topic: str
    display: str
    input: str
    message: str
    namespace: str = ""

    @property
    def values(self) -> dict[str, str]:
        """The property of the display, and its value."""
        return {self.input: self.namespace or self.topic}


def picks(
    topics: Mapping[str, tuple[str, ...]], displays: Mapping[str, type[Display]]
) -> list[Pick]:
    """Every live topic with each display that fits its type, sorted.

    Displays of any type are offered for the topics that no other one shows.

    Args:
        topics: message types by topic.
        displays: display classes by name.
    """
    takers: dict[str, list[tuple[str, str, str]]] = {}
    endings: dict[str, list[tuple[str, Namespace]]] = {}
    for name, cls in displays.items():
        if (offer := cls.offered_for) is not None:
            endings.setdefault(offer.type, []).append((name, offer))
        for input, spec in inputs_of(cls).items():
            # What comes beside another topic, such as updates of a map, is not shown alone.
            if spec.is_offered and not spec.follows:
                for type_ in spec.types:
                    takers.setdefault(type_, []).append((name, input, spec.offered_for))

    def from_inputs(topic: str, message: str, type_: str) -> list[Pick]:
        return [
            Pick(topic, name, input, message)
            for name, input, ending in takers.get(type_, ())
            if topic.endswith(ending)
        ]

    def fitting(topic: str, message: str) -> list[Pick]:
        of_type = from_inputs(topic, message, message)
        of_name = [
            Pick(topic, name, offer.input, message, topic.removesuffix(offer.ending))
            for name, offer in endings.get(message, ())
            if topic.endswith(offer.ending) and topic != offer.ending
        ]
        return of_type + of_name or from_inputs(topic, message, ANY)

    live = ((topic, message) for topic, messages in topics.items() for message in messages)
    return sorted(pick for topic, message in live for pick in fitting(topic, message))


def no_display(messages: Sequence[str]) -> str:
    """Return why a topic of these message types cannot be shown."""
    return f"No display for {' or '.join(messages)}." if messages else "No publisher."
