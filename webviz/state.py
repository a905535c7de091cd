"""What a panel shows of a viewer: a snapshot made by the frame loop."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from webviz.display import Display
from webviz.status import Level, Status, worst


@dataclass(frozen=True)
class Row:
    """One display in the list.

    Args:
        id: for commands.
        type: name of the display type.
        display: its properties, to read; None if the entry of the config cannot be shown.
        name: as shown.
        statuses: sentences by key.
        depth: in how many groups it is.
    """

    id: str
    type: str
    display: Display | None
    name: str
    statuses: Mapping[str, Status]
    depth: int = 0

    @property
    def level(self) -> Level:
        """The worst of its statuses."""
        return worst(self.statuses.values())


@dataclass(frozen=True)
class State:
    """A viewer at one moment.

    Args:
        rows: the displays in order.
        fixed_frame: frame id that everything is drawn in.
        frames: every frame id known, sorted.
        topics: message types by topic name.
        statuses: what holds for the viewer as a whole, such as "Fixed Frame".
    """

    rows: tuple[Row, ...]
    fixed_frame: str
    frames: tuple[str, ...]
    topics: Mapping[str, tuple[str, ...]]
    statuses: Mapping[str, Status]
