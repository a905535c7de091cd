"""What arrives: time, transforms, and the messages of topics."""

from __future__ import annotations

from webviz.engine.parts import Batches, Core, Parts
from webviz.engine.parts.time import TimePart
from webviz.engine.parts.transforms import TransformsPart


class Arrivals:
    """Takes what the source has, and lets all parts start over when time or transforms do.

    Args:
        core: what all parts share.
        time: notices that time went back.
        transforms: are inserted before any part asks for them.
    """

    def __init__(self, core: Core, time: TimePart, transforms: TransformsPart) -> None:
        self._core = core
        self._time = time
        self._transforms = transforms

    def take(self, parts: Parts) -> Batches:
        """Take what arrived since the last turn; while paused, it waits in the inbox."""
        core, attempt = self._core, self._core.guard.attempt
        batches: Batches = {}
        core.now_ns = attempt("Source", core.now_ns, core.source.now_ns)
        core.offers = attempt("Source", core.offers, core.source.offers)
        if not self._time.is_paused:
            batches = attempt("Source", batches, core.source.inbox.drain)
        if attempt("Time", False, self._time.ros.step, core.now_ns):
            # What arrived with it may be older or newer; what is latched is asked for again.
            batches = {}
            parts.reset()
        if attempt("Transforms", False, self._transforms.insert, batches):
            self._time.ros.tell("The transforms started over in the past: everything was reset.")
            parts.reset()
        return batches
