"""Players of bags, with the arguments that ROS would get."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from webviz.shell.remappings import remappings
from webviz.sources import Source
from webviz.sources.bag.comparison import ComparisonRun
from webviz.sources.bag.extras import Extra
from webviz.sources.bag.history import BagHistory
from webviz.sources.player import Player


def bag_player(
    paths: Path | Sequence[Path],
    extras: Sequence[Extra] = (),
    ros_args: Sequence[str] = (),
    comparison: ComparisonRun | None = None,
) -> Player:
    """Return a player of one or several bags, merged by time.

    Args:
        paths: MCAP files, db3 files or rosbag2 folders.
        extras: messages to add, see `webviz.sources.bag.extras`.
        ros_args: remappings of topics: `["--ros-args", "-r", "/scan:=/front/scan"]`.
        comparison: a second run to show beside it.

    Raises:
        Error: a bag cannot be read, or an argument is unsupported.
    """
    return Player(BagHistory(paths, extras, remappings(ros_args, "a bag"), comparison))


def bag_of(source: Source | None) -> BagHistory | None:
    """Return the bag that a source plays, None for live topics."""
    history = source.history if isinstance(source, Player) else None
    return history if isinstance(history, BagHistory) else None
