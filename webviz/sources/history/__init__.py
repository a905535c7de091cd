"""The past as data, and a position in it from which messages are delivered."""

from webviz.sources.history.history import (
    CLOCK,
    FOLLOWED,
    History,
    HistoryChannel,
    Recorded,
    RecordedTime,
)
from webviz.sources.history.intervals import ValidityIntervals
from webviz.sources.history.needed import NeededMessages
from webviz.sources.history.playhead import Playhead

__all__ = [
    "CLOCK",
    "FOLLOWED",
    "History",
    "HistoryChannel",
    "NeededMessages",
    "Playhead",
    "Recorded",
    "RecordedTime",
    "ValidityIntervals",
]
