"""Recorded messages in files: MCAP, SQLite (db3) and rosbag2 folders, compressed or not.

Files come from anywhere: what they claim and what they unfold to is bounded, and what is whole in a
damaged file is read.
"""

from pathlib import Path

from webviz.data.recordings.folder import FolderRecording
from webviz.data.recordings.opening import open_file
from webviz.data.recordings.recording import RecordedChannel, Recording, RecordingError


def open_recording(path: Path) -> Recording:
    """Open a file or a rosbag2 folder.

    Raises:
        RecordingError: it is not a recording, or not readable at all.
        OSError: it cannot be read.
    """
    return FolderRecording(path) if path.is_dir() else open_file(path)


__all__ = ["RecordedChannel", "Recording", "RecordingError", "open_recording"]
