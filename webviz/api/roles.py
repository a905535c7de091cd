"""The roles of those who open the page, and so of what they ask for."""

from __future__ import annotations

import enum


class Role(enum.IntEnum):
    """Rights of a connection; each role includes those before it."""

    WATCHER = 1
    """Looks: has a camera, a view and a selection of their own, and reads the panels."""
    OPERATOR = 2
    """Also changes displays and views, uses tools and drives."""
    OWNER = 3
    """Also opens, saves and uploads configs, and invites others."""

    @property
    def label(self) -> str:
        """Its name in texts, such as "watcher"."""
        return self.name.lower()

    @property
    def phrase(self) -> str:
        """Its name with an article."""
        return f"an {self.label}" if self.label[0] in "aeiou" else f"a {self.label}"
