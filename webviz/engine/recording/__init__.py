"""Recording of what arrives: the last minutes in memory, and files."""

from webviz.engine.recording.channels import Channels, library, new_name
from webviz.engine.recording.recent import RecentMessages, Remembered
from webviz.engine.recording.recorder import Recorder

__all__ = ["Channels", "RecentMessages", "Recorder", "Remembered", "library", "new_name"]
