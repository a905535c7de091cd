"""One line of the list of displays."""

from __future__ import annotations

import msgspec

from webviz.api.display import Display
from webviz.api.group import DisplayGroup
from webviz.engine.pipeline import Runner
from webviz.files.config import Unreadable


class Entry(msgspec.Struct, eq=False):
    """One line of the list.

    Args:
        id: for commands.
        content: a running display, a group, or an entry of a config that cannot be shown.
        parent: the group it is in.
        revision: how often its properties were changed.
    """

    id: str
    content: Runner | DisplayGroup | Unreadable
    parent: Entry | None = None
    revision: int = 0

    @property
    def declared(self) -> Display | Unreadable:
        """The display, the group, or the entry that cannot be shown."""
        return self.content.display if isinstance(self.content, Runner) else self.content

    @property
    def depth(self) -> int:
        """Return the number of groups around it."""
        return 0 if self.parent is None else 1 + self.parent.depth

    @property
    def is_enabled(self) -> bool:
        """Return whether it and all groups it is in are enabled."""
        declared = self.declared
        own = isinstance(declared, Unreadable) or declared.enabled
        return own and (self.parent is None or self.parent.is_enabled)

    def is_within(self, other: Entry) -> bool:
        """Return whether it is `other` or in it."""
        return self is other or (self.parent is not None and self.parent.is_within(other))
