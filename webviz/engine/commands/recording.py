"""Commands that record live topics to files."""

from __future__ import annotations

from webviz.engine.commands.files import FileCommand


class OpenRecording(FileCommand, frozen=True):
    """Play a recording in the place of live topics, until `ReturnToLive`.

    Args:
        path: a file or folder. Browsers can choose only those of the black box.
    """

    path: str


class StartRecording(FileCommand, frozen=True):
    """Record all topics that are subscribed to, until `StopRecording`.

    Args:
        path: of a new folder; "" is one in the working folder, named by date and time. Browsers
            cannot choose it.
    """

    path: str = ""


class StopRecording(FileCommand, frozen=True):
    """Complete the recording."""


class SaveMemory(FileCommand, frozen=True):
    """Write the last seconds of what was subscribed to, with the latched messages before them.

    Args:
        seconds: as far as they are remembered; None is everything.
        path: as that of `StartRecording`.
    """

    seconds: float | None = None
    path: str = ""
