"""Parts of messages, for tests that write them as nested mappings."""

from __future__ import annotations

from typing import Any

from webviz.shell.testing.source import SECOND


def header(frame: str, stamp_ns: int) -> dict[str, Any]:
    """A std_msgs/Header as nested mappings."""
    sec, nanosec = divmod(stamp_ns, SECOND)
    return {"frame_id": frame, "stamp": {"sec": sec, "nanosec": nanosec}}
