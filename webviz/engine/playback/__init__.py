"""Playing of recorded messages: the interface of sources with a past, and the control of it."""

from webviz.engine.playback.control import PlaybackControl
from webviz.engine.playback.display_events import DisplayEvents
from webviz.sources.playable import Playable

__all__ = ["DisplayEvents", "Playable", "PlaybackControl"]
