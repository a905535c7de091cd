"""Which displays could show which live topics."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from webviz.api.display import Display, inputs_of
from webviz.engine.commands import AddDisplay


@dataclass(frozen=True, order=True)
class Pick:
    """A topic and a display for it.

    Args:
        topic: its name.
        display: name of the display type.
        input: the property that takes the topic.
        message: the type of its messages.
    """

    topic: str
    display: str
    input: str
    message: str

    def command(self) -> AddDisplay:
        """Add this display with this topic."""
        return AddDisplay(self.display, {self.input: self.topic})


def picks(
    topics: Mapping[str, tuple[str, ...]], displays: Mapping[str, type[Display]]
) -> list[Pick]:
    """Every live topic with each display that fits its type, sorted; topics without one are left
    out.

    Args:
        topics: message types by topic.
        displays: display classes by name.
    """
    takers: dict[str, list[tuple[str, str]]] = {}
    for name, cls in displays.items():
        for input, spec in inputs_of(cls).items():
            # What comes beside another topic, such as updates of a map, is not shown by itself.
            if not spec.follows:
                for type_ in spec.types:
                    takers.setdefault(type_, []).append((name, input))
    return sorted(
        Pick(topic, name, input, message)
        for topic, messages in topics.items()
        for message in messages
        for name, input in takers.get(message, ())
    )


def no_display(messages: Sequence[str]) -> str:
    """Why a topic of these message types cannot be shown."""
    return f"No display for {' or '.join(messages)}." if messages else "No publisher."
