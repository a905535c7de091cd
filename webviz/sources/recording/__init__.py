"""Recording of what arrives: the last minutes in memory, and files."""

from webviz.sources.recording.channels import Channels, library
from webviz.sources.recording.recent import Entry, RecentMessages, Remembered
from webviz.sources.recording.recorder import ForwardClock, Recorder

__all__ = [
    "Channels",
    "Entry",
    "ForwardClock",
    "RecentMessages",
    "Recorder",
    "Remembered",
    "library",
]
