"""What the server and its pages tell each other: JSON objects whose `type` is the class's name."""

from __future__ import annotations

from typing import ClassVar

import msgspec


class ToPage(msgspec.Struct, frozen=True, tag=True):
    """What the server tells a page."""

    kept: ClassVar[bool] = False
    """Whether only the newest of a kind counts: pages that join are told it, and of those that wait
    to be sent the newest takes the place of the others."""


class FromPage(msgspec.Struct, frozen=True, tag=True, forbid_unknown_fields=True):
    """What a page tells the server; nobody vouches for it."""


class Hello(FromPage, frozen=True):
    """The first message of a page.

    Args:
        key: what viser's connection of the same page was told.
    """

    key: str


class Ask(ToPage, frozen=True):
    """Asks for an `Answer` after everything that was sent before."""

    token: str


class Answer(FromPage, frozen=True):
    """Says that all has been done that came before the `Ask` with the same token."""

    token: str
