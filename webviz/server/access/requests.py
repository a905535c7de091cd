"""Commands of pages that the server carries out itself, without the frame loop."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

import msgspec


@dataclass(frozen=True)
class Invite:
    """Make a link for somebody else; the answer has the `link` and its QR `code`.

    Args:
        name: of who gets the link.
        role: that it gives.
        days: until it ends, None for never.
        url: of the page, to which the token is added.
    """

    name: Annotated[str, msgspec.Meta(max_length=100)]
    role: Literal["watcher", "operator", "owner"]
    days: float | None
    url: Annotated[str, msgspec.Meta(max_length=300, pattern="^https?://")]


@dataclass(frozen=True)
class Dismiss:
    """End the visit of somebody else.

    Args:
        visitor: id of the browser whose visit ends.
        revokes: whether its link is not valid any more, either.
    """

    visitor: int
    revokes: bool


@dataclass(frozen=True)
class Revoke:
    """End a link, and all visits by it.

    Args:
        name: of the link.
    """

    name: Annotated[str, msgspec.Meta(max_length=100)]


@dataclass(frozen=True)
class UseWidget:
    """Use a widget in a plug-in's panel.

    Args:
        panel: its name in the registry.
        widget: its id.
        value: what was entered, None for a button.
    """

    panel: str
    widget: str
    value: bool | str | None = None
