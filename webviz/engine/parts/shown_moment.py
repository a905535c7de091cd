"""The moment that is shown, as bug reports and shared runs contain it."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec
from msgspec.structs import replace

from webviz.api.errors import Error
from webviz.engine.commands import Sender
from webviz.engine.parts.part import Core
from webviz.engine.parts.views import ViewsPart
from webviz.files.config import Config
from webviz.sources.bag.history import BagHistory
from webviz.sources.player import Player
from webviz.sources.recording import Entry
from webviz.sources.slices import BagSlice, MemorySlice, Slice

BEFORE_NS, AFTER_NS = 30_000_000_000, 5_000_000_000
"""Of a bag around the moment that is shown, unless a span is selected."""
MIN_S, MAX_S = 0.1, 86_400.0
"""Of a span."""


Margins = tuple[float, float]
"""Seconds before and after the moment that is shown."""


def margins(before_s: float | None, after_s: float | None) -> Margins | None:
    """Return the margins that a command asks for, None if it leaves them open.

    Raises:
        Error: one is negative or too long, or both are zero.
    """
    if before_s is None and after_s is None:
        return None
    before_s, after_s = before_s or 0.0, after_s or 0.0
    if not (0.0 <= before_s <= MAX_S and 0.0 <= after_s <= MAX_S and before_s + after_s > 0.0):
        raise Error("This is not a valid time span. Give seconds before and after the moment.")
    return before_s, after_s


def slice_around(player: Player, around: Margins | None = None) -> tuple[Slice, str]:
    """Return the slice around the moment that is shown, and the name of its source.

    Of a bag it has the subscribed topics, and what displays need of the time before.

    Args:
        player: of what is shown.
        around: the span; None is the selected one or half a minute of a bag, and all of memory. The
            past of live topics is always shared as a whole.

    Raises:
        Error: nothing has been received yet.
    """
    history = player.history
    if isinstance(history, BagHistory):
        at_ns = min(player.position_ns, history.end_ns)
        if around is not None:
            first_ns, last_ns = at_ns - _ns(around[0]), at_ns + _ns(around[1])
        else:
            first_ns, last_ns = player.selected or (at_ns - BEFORE_NS, at_ns + AFTER_NS)
        first_ns, last_ns = min(first_ns, at_ns), max(last_ns, at_ns)
        span_ns = max(first_ns, history.start_ns), min(last_ns, history.end_ns)
        renamed = {ours: theirs for theirs, ours in history.remappings.items()}
        wanted = dict(player.subscriptions)
        part = BagSlice(history.paths, wanted, renamed, span_ns, at_ns, history.ghost)
        return part, ", ".join(history.names)
    memory = player.memory
    if around is not None and player.is_live and memory is not None:
        entries: Sequence[Entry] = memory.recent.last(max(around[0], MIN_S)).whole
    else:
        entries = () if memory is None else memory.entries()
    if memory is None or not entries:
        raise Error(
            "No messages are kept in memory. Show a topic, or raise memory.seconds in the config."
        )
    shown_s = None if player.is_live else memory.clock.arrived_s(player.reached_ns)
    return MemorySlice(memory.recorded_channels, entries, shown_s), "live"


def _ns(seconds: float) -> int:
    return round(seconds * 1e9)


def as_seen(config: Config, core: Core, sender: Sender) -> Config:
    """Return a config that begins with the view of the browser that sent a command."""
    views = core.get(ViewsPart).current()
    view = views.get(sender.browser) if sender.browser is not None else None
    if view is None:
        return config
    return replace(config, settings=msgspec.structs.replace(config.settings, view=view))
