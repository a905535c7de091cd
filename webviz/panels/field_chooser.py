"""Adds message paths to a panel: a topic is chosen, and fields of its newest message."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from webviz.api.panel import Ui

MAX_FIELDS = 300
"""Fields of a message that are offered."""
MAX_TOPICS = 2000
NOTHING = ""


class FieldChooser:
    """The topic and the fields that a panel offers to add.

    Args:
        fields: returns the first paths in a message that can be added.
        add: called with a message path that a user adds, and their browser.
    """

    def __init__(
        self,
        fields: Callable[[Any, int], Sequence[str]],
        add: Callable[[str, int | None], object],
    ) -> None:
        self._fields = fields
        self._added = add
        self._example: Any = None
        self.topic = NOTHING
        """The topic whose fields are offered; its messages are needed."""

    def build(self, ui: Ui, what: str) -> None:
        """Add the button to the head of the panel; `what` is what is added, such as "curve"."""
        self._what = what
        self._widget = ui.widget("fields", self._values({}), self._use)

    def take(self, topic: str, message: Any) -> None:
        """Take a message, whose fields are offered if it is of the topic."""
        if topic == self.topic:
            self._example = message

    def offer(self, topics: Mapping[str, Any]) -> None:
        """Offer these topics, and the fields of the newest message."""
        self._widget.show(self._values(topics))

    def _values(self, topics: Mapping[str, Any]) -> Mapping[str, Any]:
        fields = [] if self._example is None else self._fields(self._example, MAX_FIELDS)
        return {
            "what": self._what,
            "topic": self.topic,
            "topics": sorted(topics)[:MAX_TOPICS],
            "fields": list(fields),
        }

    def _use(self, value: Any, browser: int | None) -> None:
        """Choose a topic, or add a message path."""
        if not isinstance(value, dict):
            return
        if isinstance(topic := value.get("topic"), str):
            self.topic, self._example = topic, None
        elif isinstance(path := value.get("add"), str) and path:
            self._added(path, browser)
