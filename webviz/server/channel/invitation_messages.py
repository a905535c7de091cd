"""Messages by which an owner invites and dismisses others."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec

from webviz.server.channel.messages import FromPage, Number, ToPage


class Invite(FromPage, frozen=True):
    """Asks for a link for somebody else.

    Args:
        number: of the request, for the page to know its `Invitation`.
        name: of who gets the link.
        role: that it gives.
        days: until it ends, None for never.
        url: of the page, to which the token is added.
    """

    number: Number
    name: Annotated[str, msgspec.Meta(max_length=100)]
    role: Literal["watcher", "operator", "owner"]
    days: float | None
    url: Annotated[str, msgspec.Meta(max_length=300, pattern="^https?://")]


class Dismiss(FromPage, frozen=True):
    """Ends the visit of somebody else; the answer is a `Done`.

    Args:
        number: of the request.
        browser: whose visit ends.
        revokes: whether its link is not valid any more, either.
    """

    number: Number
    browser: int
    revokes: bool


class Revoke(FromPage, frozen=True):
    """Ends a link, and all visits by it; the answer is a `Done`.

    Args:
        number: of the request.
        name: of the link.
    """

    number: Number
    name: Annotated[str, msgspec.Meta(max_length=100)]


class Dismissed(ToPage, frozen=True):
    """The last message to a page whose visit the owner has ended.

    Args:
        text: for its user, sentences without markup.
    """

    text: str


class Invitation(ToPage, frozen=True):
    """Answers an `Invite`.

    Args:
        number: of the request.
        problem: why there is none, a sentence; else "".
        link: with a new token.
        code: the same as a QR code, the address of an image.
    """

    number: int
    problem: str
    link: str
    code: str
