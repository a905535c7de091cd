"""Remappings of topics where there is no ROS node to remap them."""

from __future__ import annotations

from collections.abc import Sequence

from webviz.api.errors import Error


def remappings(ros_args: Sequence[str], source: str) -> dict[str, str]:
    """Topics by the names that displays use.

    Args:
        ros_args: such as `["--ros-args", "-r", "/scan:=/front/scan"]`.
        source: in whose place a node would be, for the error, such as "a bag".

    Raises:
        Error: another argument is given.
    """
    result = {}
    rest = [a for a in ros_args if a not in ("--ros-args", "--", "-r", "--remap")]
    for argument in rest:
        theirs, mark, ours = argument.partition(":=")
        if not mark or not theirs.startswith("/"):
            raise Error(
                f"{argument!r} is not supported with {source}. The only ROS argument is "
                "`-r /topic:=/other`."
            )
        result[theirs] = ours
    return result
