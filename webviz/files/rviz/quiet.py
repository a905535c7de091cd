"""Unsupported values in .rviz files that change nothing in the scene."""

from __future__ import annotations

from typing import Any

from webviz.files.rviz.tree import Path, Tree

ALWAYS = {
    "Tree": "TF's tree of frames, which RViz rebuilds from the transforms",
    "Expand Tree": "how RViz's panel looks",
    "Expand Link Details": "how RViz's panel looks",
    "Expand Joint Details": "how RViz's panel looks",
    "Link Tree Style": "how RViz's panel looks",
    "Link Tree": "links in an order that RViz writes but does not read",
    "Link/Joint Tree": "links in an order that RViz writes but does not read",
    "Topic Filter": "which topics RViz's panel offers",
    **dict.fromkeys(
        (
            *("Acceleration_Scaling_Factor", "Velocity_Scaling_Factor"),
            *("MoveIt_Planning_Attempts", "MoveIt_Planning_Time", "MoveIt_Allow_Approximate_IK"),
            *("MoveIt_Allow_External_Program", "MoveIt_Allow_Replanning"),
            *("MoveIt_Allow_Sensor_Positioning", "MoveIt_Use_Cartesian_Path"),
            *("MoveIt_Use_Constraint_Aware_IK", "MoveIt_Warehouse_Host", "MoveIt_Warehouse_Port"),
            *("MoveIt_Goal_Tolerance", "Interactive Marker Size", "Planning Group"),
            *("Colliding Link Color", "JointsTab_Use_Radians"),
        ),
        "for planning with MoveIt; the display says that it only shows plans",
    ),
    **dict.fromkeys(("Payload", "TextHeight"), "of MoveIt's metrics, if any is shown"),
}
"""Reasons by key, at any level of the path."""

AT_DEFAULT: dict[str, tuple[Any, ...]] = {
    "Selectable": (True,),
    "Position Transformer": ("XYZ", ""),
    "Links": (None,),
    "Show All Links": (True,),
    "Show Scene Robot": (True,),  # of MoveIt before Show Robot Visual
    "Show Weight Limit": (False,),
    "Show Manipulability Index": (False,),
    "Show Manipulability": (False,),
    "Show Joint Torques": (False,),
    "Alpha": (1,),
    "Marker Alpha": (1,),
    "Mesh Color": ("Color",),
    "ColorMap": ("default",),  # the rainbow
    "Show Trail": (False,),
    "Mesh": (False,),
    "Signal Lights": (False,),
    "Download map": (False,),  # buttons of RTAB-Map's MapCloud
    "Download graph": (False,),
}
"""Default values of RViz that need no support, by key."""

SCALARS = ("Temperature", "FluidPressure", "Illuminance", "RelativeHumidity")
HIDDEN_OF_SCALARS = (
    *("Position Transformer", "Color Transformer", "Channel Name", "Color", "Axis"),
    *("Autocompute Intensity Bounds", "Autocompute Value Bounds", "Use Fixed Frame"),
)
"""Properties of point clouds that RViz's displays of one number hide, but write."""


IGNORED_BY_RVIZ2 = (("Queue Size",), ("Unreliable",), ("Transport Hint",))
"""Keys of ROS 1 that files keep beside the topics of ROS 2, which have the values in use."""


OBJECTS = "autoware_perception_rviz_plugin"
TASKS = "moveit_task_constructor/Motion Planning Tasks"
IGNORED_BY_PLUGINS = {
    ("Namespaces", "nvblox_rviz_plugin/NvbloxVoxelBlockLayer"),
    ("Tasks", TASKS),
    ("Robot/Value", TASKS),
    ("Hide Small Values", "rviz/WrenchStamped"),
    ("Hide Small Values", "rviz_default_plugins/Wrench"),
    ("Path", f"{OBJECTS}/DetectedObjects"),
    ("Path", f"{OBJECTS}/TrackedObjects"),
    ("Text/UUID", f"{OBJECTS}/DetectedObjects"),
    ("Text/Acceleration", f"{OBJECTS}/DetectedObjects"),
}
"""Keys that files have from ROS 1 or other displays, or that only report something, with the class
that ignores them in RViz2."""


LINKS_BESIDE_THEIR_GROUP = ("Scene Robot", "Planned Path")
UNCHANGED_LINK = {"Alpha": 1, "Show Axes": False, "Show Trail": False, "Value": True}
"""A link of old MoveIt files, which have it in these groups instead of in their group Links."""


def is_without_effect(path: Path, tree: Tree) -> bool:
    """Return whether the value at a path of a display has no effect on what RViz shows."""
    first, last, cls = path[0], path[len(path) - 1], str(tree.get("Class"))
    if any(key in ALWAYS for key in path) or path in IGNORED_BY_RVIZ2:
        return True
    if any(("/".join(path[:end]), cls) in IGNORED_BY_PLUGINS for end in (1, 2)):
        return True
    if first in HIDDEN_OF_SCALARS and cls.rpartition("/")[2] in SCALARS:
        return True
    value, outer = tree, None
    for key in path:
        value, outer = (value.get(key) if isinstance(value, dict) else None), value
    if first in LINKS_BESIDE_THEIR_GROUP and len(path) == 3 and outer == UNCHANGED_LINK:
        return True
    if (
        first == "Namespaces" or (first, cls) == ("Markers", TASKS)
    ) and value is True:  # as all are
        return True
    name = path[len(path) - 2] if last == "Value" and len(path) > 1 else last
    return value == {} or any(value == each for each in AT_DEFAULT.get(name, ()))
