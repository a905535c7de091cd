"""Recording of what arrives: the last minutes in memory, and files."""

from webviz.engine.recording.channels import Channels, library
from webviz.engine.recording.memory import Memory
from webviz.engine.recording.recorder import Recorder

__all__ = ["Channels", "Memory", "Recorder", "library"]
