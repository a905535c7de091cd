"""Message paths as panels read them: which topics, and why there is nothing."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from webviz.api.offer import Offer
from webviz.api.panel import Panel
from webviz.data.messages.message_paths import MessagePath
from webviz.data.messages.paths import PathError
from webviz.data.messages.value_names import NO_NAMES, ValueNames
from webviz.engine.state import PanelTab


def types_of(offers: Mapping[str, Offer]) -> dict[str, str]:
    """Return the message types of all topics with a publisher, as they are or would be read."""
    return {
        topic: offer.type or offer.publishers[0].type
        for topic, offer in offers.items()
        if offer.publishers
    }


def id_of(panel: Panel, panels: Sequence[PanelTab]) -> str:
    """Return the id of a panel for commands, "" until it is known."""
    return next((tab.id for tab in panels if tab.panel is panel), "")


class PathReading:
    """A message path that a panel reads.

    Args:
        text: as written; an invalid one has a problem.
    """

    def __init__(self, text: str) -> None:
        self.text = text
        self.path: MessagePath | None = None
        self.problem = ""
        """Reason why the newest message has no value, a sentence or ""."""
        self.has_message = False
        self._invalid = ""
        try:
            self.path = MessagePath(text)
        except PathError as error:
            self._invalid = str(error) if text else "Choose a topic."

    @property
    def topic(self) -> str:
        """Its topic, "" if it is invalid."""
        return self.path.topic if self.path else ""

    def values(self, message: Any) -> list[Any]:
        """Return the values in a message; none if it has a problem."""
        if self.path is None:
            return []
        self.has_message = True
        try:
            numbers = self.path.values(message)
        except PathError as error:
            self.problem = str(error)
            return []
        self.problem = ""
        return numbers

    def value_names(self, message: Any) -> ValueNames:
        """Return the names of the values in a message; see `webviz.data.messages.value_names`."""
        return self.path.value_names(message) if self.path else NO_NAMES

    def explanation(self, types: Mapping[str, str]) -> str:
        """Return why there is nothing to show, a sentence or ""."""
        if self._invalid:
            return self._invalid
        if self.topic not in types:
            return f"No publisher on {self.topic}. Start the node that publishes it."
        return self.problem or ("" if self.has_message else "No message yet.")


def subscribed(readings: Iterable[PathReading], types: Mapping[str, str]) -> dict[str, str]:
    """Return the types of the topics that are read, as far as they are known."""
    return {each.topic: types[each.topic] for each in readings if each.topic in types}
