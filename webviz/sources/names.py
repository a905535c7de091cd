"""Full names of topics without ROS, remapped as ROS does it."""

from __future__ import annotations

import re
from collections.abc import Container, Mapping

NODE = "webviz"
"""Name of the viewer's node, for private names."""


def is_own(node: str) -> bool:
    """Return whether a node, by its full name, is one of webviz."""
    return node.rpartition("/")[2] == NODE


_TOPIC = re.compile(r"(/[A-Za-z_][A-Za-z0-9_]*)+", re.ASCII)


MAX_NAME = 255
"""Characters, which is DDS's limit."""


def is_full_name(name: str) -> bool:
    """Return whether ROS allows a full name of a topic."""
    return len(name) <= MAX_NAME and _TOPIC.fullmatch(name) is not None


def resolved(
    topic: str, remappings: Mapping[str, str], recorded: Container[str] = frozenset()
) -> str:
    """Return the full name of a topic.

    Args:
        topic: as a user wrote it.
        remappings: other full names by full names.
        recorded: full names that are valid although ROS 2 forbids them.

    Raises:
        ValueError: it is not a valid topic name.
    """
    name = topic if topic.startswith("/") else f"/{topic}"
    if topic.startswith("~"):
        name = f"/{NODE}/{topic.removeprefix('~').removeprefix('/')}"
    if topic in recorded:
        name = topic
    elif name not in recorded and not _TOPIC.fullmatch(name):
        raise ValueError(
            f"{topic!r} is not a valid topic name: it must be words of letters, digits and "
            "underscores, separated by slashes, that do not start with a digit"
        )
    return remappings.get(name, name)
