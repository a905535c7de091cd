"""The state of recordings for panels: of the one that is played, and of those that are made."""

from __future__ import annotations

import msgspec

from webviz.api.status import Level


class PlaybackState(msgspec.Struct, frozen=True, kw_only=True):
    """The recording that is played; see `webviz.sources.player.Player`.

    Args:
        names: of the recordings.
        start_ns, end_ns: times of recording of the first and the last message, since 1970; of
            live topics, when the viewer began, and now.
        position_s: what is shown, in seconds from the start.
        rate: seconds of the recording per second; infinity is as fast as possible.
        is_playing: whether the position moves on.
        is_seeking: whether the position is being approached; the scene still shows another one.
        loop: whether the span starts over at its end.
        selected: the first and the last second to play, None for all.
        first_s: of the first message that there is, in seconds from the start.
        is_live: whether topics are live, and shown as they arrive; None for a bag.
        gap: the first and the last second of what was forgotten while the past was shown.
        is_memory: whether it is what live topics brought, not a bag.
        is_opened: whether it is shown in the place of live topics, to which one can return.
        counted: the first and the last second in which messages are counted, None for all.
    """

    names: tuple[str, ...]
    start_ns: int
    end_ns: int
    position_s: float
    rate: float
    is_playing: bool
    is_seeking: bool
    loop: bool
    selected: tuple[float, float] | None
    first_s: float = 0.0
    is_live: bool | None = None
    is_memory: bool = False
    is_opened: bool = False
    gap: tuple[float, float] | None = None
    counted: tuple[float, float] | None = None


class Event(msgspec.Struct, frozen=True):
    """A warning or an error at a moment of a recording.

    Args:
        at_ns: time of recording, since 1970.
        level: `Level.WARN` or `Level.ERROR`.
        name: of the node or display, which may contain anything.
        text: a sentence, or the first line of a log message.
    """

    at_ns: int
    level: Level
    name: str
    text: str
