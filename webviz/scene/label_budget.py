"""Number of texts that browsers show, and the rate at which they are sent."""

from __future__ import annotations

from collections.abc import Callable

MAX_LABELS = 4096
"""Texts that viser's page shows."""
MAX_CHARACTERS = 500_000
"""Largest number of characters of all texts; each is two triangles."""
AT_ONCE = 200
"""Texts that are added in one flush, as each takes 0.1 ms."""


class LabelBudget:
    """Shared by all nodes with texts of a scene; those that do not get one wait for room.

    A node takes room for each text, and frees it when the text goes.
    """

    def __init__(self) -> None:
        self._labels = MAX_LABELS
        self._characters = MAX_CHARACTERS
        self._due = AT_ONCE
        self._waiting: dict[str, Callable[[], None]] = {}

    def take(self, text: str) -> bool:
        """Take room for a text that is added; whether there is any now."""
        if not self._due or not self._labels or len(text) > self._characters:
            return False
        self._due -= 1
        self._labels -= 1
        self._characters -= len(text)
        return True

    def change(self, old: str, new: str) -> bool:
        """Take the room of another text; whether there is enough."""
        if len(new) - len(old) > self._characters:
            return False
        self._characters -= len(new) - len(old)
        return True

    def free(self, text: str) -> None:
        """Give back the room of a text."""
        self._labels += 1
        self._characters += len(text)

    def wait(self, name: str, add_more: Callable[[], None]) -> None:
        """Have `add_more` called in later flushes; it waits again if it needs more than one."""
        self._waiting[name] = add_more

    def leave(self, name: str) -> None:
        """Wait no longer."""
        self._waiting.pop(name, None)

    def deliver(self) -> None:
        """Let nodes that wait add texts; called once in each flush."""
        self._due = AT_ONCE
        waiting, self._waiting = self._waiting, {}
        for add_more in waiting.values():
            add_more()

    @property
    def is_waiting(self) -> bool:
        """Return whether a node has texts that are not shown."""
        return bool(self._waiting)

    @property
    def is_unfinished(self) -> bool:
        """Return whether the next flush can add more texts."""
        return bool(self._waiting) and not self._due
