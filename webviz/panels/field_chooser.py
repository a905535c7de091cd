"""Two lists from which a message path is chosen: a topic, and a field of its newest message."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from webviz.api.panel import Ui

MAX_FIELDS = 300
"""Fields of a message that are offered."""
NOTHING = ""


class FieldChooser:
    """The topic and the fields that a panel offers to add.

    Args:
        fields: returns the first paths in a message that can be added.
        add: called with a message path that somebody adds, and their browser.
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
        """Add both lists; `what` is what is added, such as "curve"."""
        self._topics = ui.choice(
            "Topic", NOTHING, self._choose, f"Topic with the values of a new {what}."
        )
        self._paths = ui.choice("Add field", NOTHING, self._add, "Fields of the newest message.")

    def take(self, topic: str, message: Any) -> None:
        """Take a message, whose fields are offered if it is of the topic."""
        if topic == self.topic:
            self._example = message

    def offer(self, topics: Mapping[str, Any]) -> None:
        """Offer these topics, and the fields of the newest message."""
        self._topics.offer([NOTHING, *sorted(topics)], self.topic)
        fields = [] if self._example is None else self._fields(self._example, MAX_FIELDS)
        self._paths.offer([NOTHING, *fields], NOTHING)

    def _choose(self, topic: str, browser: int | None) -> None:
        self.topic, self._example = topic, None

    def _add(self, field: str, browser: int | None) -> None:
        if field:
            self._added(f"{self.topic}.{field}", browser)
