"""Definitions of common types that rosbags does not include, as files in the layout of ROS.

Field names, types and their order are those of ROS 2 Jazzy, in navigation2, navigation_msgs,
MoveIt, slam_toolbox, nvblox, rtabmap, octomap, grid_map and object_recognition_msgs; of
moveit_task_constructor_msgs 0.1, vision_msgs 4.1, foxglove_msgs 3.2, zed_msgs 5.3, Autoware and
ffmpeg_image_transport_msgs. Constants are those that are used.
"""

from __future__ import annotations

from pathlib import Path

FILES = {
    "/".join((*path.parts[-3:-1], path.stem)): path
    for path in sorted(Path(__file__).parent.glob("*/*/*.*"))
}
"""Files of messages, services and actions, by the full name of their type."""


def text(type_name: str) -> str:
    """Return the definition of a type by its full name, "" if there is none; it is not cached."""
    path = FILES.get(type_name)
    return path.read_text(encoding="utf-8") if path else ""
