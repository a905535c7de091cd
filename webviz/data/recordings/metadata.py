"""The metadata.yaml of rosbag2 folders."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path, PurePath
from typing import Any

from webviz.data.lfs import is_lfs
from webviz.data.plain_yaml import YamlLimits, read_plain
from webviz.data.recordings.recording import RecordingError
from webviz.data.recordings.unpacking import COMPRESSIONS
from webviz.data.words import shortened

METADATA = "metadata.yaml"
INFORMATION = "rosbag2_bagfile_information"
LIMITS = YamlLimits(values=200_000, characters=2 << 20, depth=16)
"""A file of a recording takes 13 values, a topic 50 for each publisher, in ten seconds at most."""


def read_metadata(folder: Path) -> list[str]:
    """Return the names of the files.

    Raises:
        RecordingError: the metadata are broken, or messages have an unknown compression.
        OSError: they cannot be read.
    """
    path = folder / METADATA
    remedy = f"run `ros2 bag reindex {folder}`, or give one of the files in it."
    text = _text(path)
    if is_lfs(text):
        raise RecordingError(f"{path} is a Git LFS pointer: run `git lfs pull`.")
    try:
        information = _information(text)
        names = [PurePath(name).name for name in information["relative_file_paths"]]
        mode = str(information.get("compression_mode") or "").lower()
        compression = str(information["compression_format"]) if mode == "message" else ""
    except Exception as error:  # of YAML, or of the wrong types
        raise RecordingError(f"{path} is damaged: {remedy}") from error
    if compression not in COMPRESSIONS:
        name = repr(shortened(compression, 40))
        raise RecordingError(f"{folder} has messages in {name}, which is unsupported.")
    return list(dict.fromkeys(names))


def recorded_counts(file: Path) -> Mapping[str, int]:
    """Return the numbers of messages by topic, if metadata.yaml is of this file alone.

    Returns:
        Nothing if there are none, or they cannot be read.
    """
    try:
        information = _information(_text(file.with_name(METADATA)))
        if [PurePath(name).name for name in information["relative_file_paths"]] != [file.name]:
            return {}
        return {
            str(entry["topic_metadata"]["name"]): int(entry["message_count"])
            for entry in information["topics_with_message_count"]
        }
    except Exception:  # of the disk, of YAML, or of the wrong types
        return {}


def _text(path: Path) -> bytes:
    with path.open("rb") as file:
        return file.read(4 * LIMITS.characters + 1)


def _information(text: bytes) -> dict[str, Any]:
    return read_plain(text.decode(), LIMITS)[INFORMATION]
