"""Commands for recordings: bags, and the memory of live topics.

Times are seconds from the start of the recording, or of the viewer if topics are live. Without a
past, these commands are refused.
"""

from __future__ import annotations

from webviz.engine.commands.command import Command


class Play(Command, frozen=True):
    """Play from the position, at the end of the span from its start; `Pause` stops it."""


class Seek(Command, frozen=True):
    """Show the recording at a time; answered when the scene shows it."""

    at_s: float


class ReturnToLive(Command, frozen=True):
    """Show what arrives again, instead of the past of live topics or a recording."""


class SetRate(Command, frozen=True):
    """Set how fast to play: seconds of the recording per second, 0 is as fast as possible."""

    rate: float


class SetLoop(Command, frozen=True):
    """Choose whether the span starts over at its end."""

    loop: bool = True


class SelectSpan(Command, frozen=True):
    """Choose the part of the recording to play; without times, all of it.

    Args:
        first_s: its start, None for that of the recording.
        last_s: its end, None for that of the recording.
    """

    first_s: float | None = None
    last_s: float | None = None


class SaveBookmark(Command, frozen=True):
    """Give a moment of the recording a name, in place of a moment of that name.

    Args:
        name: of the bookmark.
        at_s: the moment, None for the position.
    """

    name: str
    at_s: float | None = None


class RemoveBookmark(Command, frozen=True):
    """Remove a bookmark."""

    name: str


class StepMessage(Command, frozen=True):
    """Pause, and show the recording at the next or previous message of a topic.

    Args:
        topic: its name; "" is every displayed topic.
        is_forward: whether to the next message.
    """

    topic: str = ""
    is_forward: bool = True
