"""The moment that is shown, as bug reports and shared runs contain it."""

from __future__ import annotations

import msgspec
from msgspec.structs import replace

from webviz.api.errors import Error
from webviz.engine.commands import Sender
from webviz.engine.parts.part import Core
from webviz.engine.parts.views import ViewsPart
from webviz.files.config import Config
from webviz.sources.bag.history import BagHistory
from webviz.sources.player import Player
from webviz.sources.slices import BagSlice, MemorySlice, Slice

BEFORE_NS, AFTER_NS = 30_000_000_000, 5_000_000_000
"""Of a bag around the moment that is shown, unless a span is selected."""


def slice_around(player: Player) -> tuple[Slice, str]:
    """Return the slice around the moment that is shown, and the name of its source.

    Of a bag it has the subscribed topics, and what displays need of the time before.

    Raises:
        Error: nothing has been received yet.
    """
    history = player.history
    if isinstance(history, BagHistory):
        at_ns = min(player.position_ns, history.end_ns)
        first_ns, last_ns = player.selected or (at_ns - BEFORE_NS, at_ns + AFTER_NS)
        first_ns, last_ns = min(first_ns, at_ns), max(last_ns, at_ns)
        span_ns = max(first_ns, history.start_ns), min(last_ns, history.end_ns)
        renamed = {ours: theirs for theirs, ours in history.remappings.items()}
        wanted = dict(player.subscriptions)
        part = BagSlice(history.paths, wanted, renamed, span_ns, at_ns, history.ghost)
        return part, ", ".join(history.names)
    memory = player.memory
    if memory is None or not (entries := memory.entries()):
        raise Error(
            "No messages are kept in memory. Show a topic, or raise memory.seconds in the config."
        )
    shown_s = None if player.is_live else memory.clock.arrived_s(player.reached_ns)
    return MemorySlice(memory.recorded_channels, entries, shown_s), "live"


def as_seen(config: Config, core: Core, sender: Sender) -> Config:
    """Return a config that begins with the view of the browser that sent a command."""
    views = core.get(ViewsPart).current()
    view = views.get(sender.browser) if sender.browser is not None else None
    if view is None:
        return config
    return replace(config, settings=msgspec.structs.replace(config.settings, view=view))
