"""Commands of pages that the server carries out itself, without the frame loop."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec


class Invite(msgspec.Struct, frozen=True):
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


class Dismiss(msgspec.Struct, frozen=True):
    """End the visit of somebody else.

    Args:
        visitor: id of the browser whose visit ends.
        revokes: whether its link is not valid any more, either.
    """

    visitor: int
    revokes: bool


class Revoke(msgspec.Struct, frozen=True):
    """End a link, and all visits by it.

    Args:
        name: of the link.
    """

    name: Annotated[str, msgspec.Meta(max_length=100)]


class UseWidget(msgspec.Struct, frozen=True):
    """Use a widget in a plug-in's panel.

    Args:
        panel: its name in the registry.
        widget: its id.
        value: what was entered, None for a button.
    """

    panel: str
    widget: str
    value: bool | str | None = None
