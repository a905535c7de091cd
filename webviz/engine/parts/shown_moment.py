"""The moment that is shown, as bug reports and shared runs contain it."""

from __future__ import annotations

import msgspec
from msgspec.structs import replace

from webviz.api.errors import Error
from webviz.engine.commands import Sender
from webviz.engine.parts.part import Core
from webviz.engine.playback import PlaybackControl
from webviz.engine.state import State
from webviz.files.config import Config
from webviz.sources.bag.source import BagSource
from webviz.sources.rewindable import Rewindable
from webviz.sources.slices import Slice
from webviz.sources.switchable import Switchable

BEFORE_NS, AFTER_NS = 30_000_000_000, 5_000_000_000
"""Of a bag around the moment that is shown, unless a span is selected."""


def slice_around(core: Core, control: PlaybackControl) -> tuple[Slice, str]:
    """Return the slice around the moment that is shown, and the name of its source.

    Raises:
        Error: nothing has been received yet.
    """
    source = core.source
    if isinstance(source, Switchable):
        source = source.shown
    if isinstance(source, BagSource):
        at_ns = min(max(control.position_ns, source.start_ns), source.end_ns)
        first_ns, last_ns = control.selected or (at_ns - BEFORE_NS, at_ns + AFTER_NS)
        part = source.slice(min(first_ns, at_ns), max(last_ns, at_ns), at_ns)
        return part, ", ".join(source.names)
    if not isinstance(source, Rewindable) or (found := source.slice()) is None:
        raise Error(
            "No messages are kept in memory. Show a topic, or raise memory.seconds in the config."
        )
    return found, "live"


def as_seen(config: Config, state: State, sender: Sender) -> Config:
    """Return a config that begins with the view of the browser that sent a command."""
    view = state.views.get(sender.browser) if sender.browser is not None else None
    if view is None:
        return config
    return replace(config, settings=msgspec.structs.replace(config.settings, view=view))
