"""A file to make of a bag."""

from __future__ import annotations

import msgspec

from webviz.api.errors import Error
from webviz.files.config import Config
from webviz.shell.export.recorder import ExportSpan
from webviz.shell.pictures.times import At, position_ns, seconds_from_start
from webviz.sources.player import Player

RATE_HZ = 10.0
MAX_BYTES = 50_000_000


class ExportOrder(msgspec.Struct, frozen=True):
    """A file to make.

    Args:
        config: what to show.
        source: the bag.
        bag: its name, for errors.
        name: of the config, "" for none.
        first, last: of the span to record.
        rate_hz: frames per second of the bag.
        max_bytes: limit of the file; large clouds, and then versions of what is large, are left
            out until it is kept.
        at: moment that the file begins with, None for the first.
    """

    config: Config
    source: Player
    bag: str
    name: str = ""
    first: At = "start"
    last: At = "end"
    rate_hz: float = RATE_HZ
    max_bytes: int = MAX_BYTES
    at: At | None = None

    def span(self) -> ExportSpan:
        """Return the part of the bag to record.

        Raises:
            Error: it is outside of the bag, or empty.
        """
        first_ns, last_ns = (
            position_ns(at, self.source.history, self.bag) for at in (self.first, self.last)
        )
        if first_ns > last_ns:
            first_s, last_s = (
                seconds_from_start(at, self.source.history) for at in (first_ns, last_ns)
            )
            raise Error(f"--from {first_s:g} s is later than --to {last_s:g} s. Swap them.")
        return ExportSpan(first_ns, last_ns, self.rate_hz)

    def begin_s(self, span: ExportSpan) -> float:
        """Return the moment that the file begins with, in seconds from the start of its span.

        Raises:
            Error: it is outside of the span.
        """
        if self.at is None:
            return 0.0
        at_ns = position_ns(self.at, self.source.history, self.bag)
        if not span.first_ns <= at_ns <= span.last_ns:
            at_s = seconds_from_start(at_ns, self.source.history)
            raise Error(f"--at {at_s:g} s must be between --from and --to.")
        return (at_ns - span.first_ns) / 1e9
