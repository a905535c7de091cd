"""Commands for recordings: bags, and the memory of live topics.

Times are seconds from the start of the recording, or of the viewer if topics are live. Without a
past, these commands are refused.
"""

from __future__ import annotations

from dataclasses import dataclass

from webviz.engine.commands.command import Command


@dataclass(frozen=True)
class Play(Command):
    """Play from the position, at the end of the span from its start; `Pause` stops it."""


@dataclass(frozen=True)
class Seek(Command):
    """Show the recording at a time; answered when the scene shows it."""

    at_s: float


@dataclass(frozen=True)
class ReturnToLive(Command):
    """Show what arrives again, instead of the past of live topics or a recording."""


@dataclass(frozen=True)
class SetRate(Command):
    """Set how fast to play: seconds of the recording per second, 0 is as fast as possible."""

    rate: float


@dataclass(frozen=True)
class SetLoop(Command):
    """Choose whether the span starts over at its end."""

    loop: bool = True


@dataclass(frozen=True)
class SelectSpan(Command):
    """Choose the part of the recording to play; without times, all of it.

    Args:
        first_s: its start, None for that of the recording.
        last_s: its end, None for that of the recording.
    """

    first_s: float | None = None
    last_s: float | None = None


@dataclass(frozen=True)
class SaveBookmark(Command):
    """Give a moment of the recording a name, in place of a moment of that name.

    Args:
        name: of the bookmark.
        at_s: the moment, None for the position.
    """

    name: str
    at_s: float | None = None


@dataclass(frozen=True)
class RemoveBookmark(Command):
    """Remove a bookmark."""

    name: str


@dataclass(frozen=True)
class StepMessage(Command):
    """Pause, and show the recording at the next or previous message of a topic.

    Args:
        topic: its name; "" is every displayed topic.
        is_forward: whether to the next message.
    """

    topic: str = ""
    is_forward: bool = True
