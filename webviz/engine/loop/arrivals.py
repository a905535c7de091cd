"""Arrivals of a turn: time, transforms and messages."""

from __future__ import annotations

from webviz.engine.parts import Batches, Core, Parts
from webviz.engine.parts.time import TimePart
from webviz.engine.parts.transforms import TransformsPart


class Arrivals:
    """Takes what has arrived at the source, and resets all parts when time goes back.

    Args:
        core: shared by all parts.
        time: detects that time went back.
        transforms: inserts transforms before other parts look them up.
    """

    def __init__(self, core: Core, time: TimePart, transforms: TransformsPart) -> None:
        self._core = core
        self._time = time
        self._transforms = transforms

    def take(self, parts: Parts) -> Batches:
        """Take what arrived since the last turn; while paused, messages wait in the inbox."""
        core, attempt = self._core, self._core.guard.attempt
        batches: Batches = {}
        core.now_ns = attempt("Source", core.now_ns, core.player.now_ns)
        core.offers = attempt("Source", core.offers, core.player.offers)
        if self._time.is_paused:
            self._time.missed = attempt("Source", self._time.missed, core.player.inbox.hold)
        else:
            batches = attempt("Source", batches, core.player.inbox.drain)
        if attempt("Time", False, self._time.ros.step, core.now_ns):
            # Messages of this turn may be older or newer. Latched ones are requested again.
            batches = {}
            parts.reset()
        if attempt("Transforms", False, self._transforms.insert, batches):
            self._time.ros.note("The transforms started over in the past: everything was reset.")
            parts.reset()
        return batches
