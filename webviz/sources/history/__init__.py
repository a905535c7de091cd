"""The past as data, and a position in it from which messages are delivered."""

from webviz.sources.history.history import (
    CLOCK,
    FOLLOWED,
    History,
    HistoryChannel,
    Recorded,
    RecordedTime,
)
from webviz.sources.history.needed import NeededMessages
from webviz.sources.history.playhead import Playhead
from webviz.sources.history.runs import Runs

__all__ = [
    "CLOCK",
    "FOLLOWED",
    "History",
    "HistoryChannel",
    "NeededMessages",
    "Playhead",
    "Recorded",
    "RecordedTime",
    "Runs",
]
