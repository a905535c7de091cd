"""Bags as a source, with the arguments that ROS would get."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from webviz.shell.remappings import remappings
from webviz.sources.bag.extras import Extra
from webviz.sources.bag.ghost import Ghost
from webviz.sources.bag.source import BagSource


def bag_source(
    paths: Path | Sequence[Path],
    extras: Sequence[Extra] = (),
    ros_args: Sequence[str] = (),
    ghost: Ghost | None = None,
) -> BagSource:
    """One or several bags, merged by time.

    Args:
        paths: MCAP files, db3 files or rosbag2 folders.
        extras: messages to add, see `webviz.sources.bag.extras`.
        ros_args: remappings of topics: `["--ros-args", "-r", "/scan:=/front/scan"]`.
        ghost: a second run to show beside it.

    Raises:
        Error: a bag cannot be read, or an argument is unsupported.
    """
    return BagSource(paths, extras, remappings(ros_args, "a bag"), ghost)
