"""Names of types, topics and nodes on the wire of Zenoh, and their bounds.

rmw_zenoh_cpp writes types as DDS names them, such as `std_msgs::msg::dds_::String_`;
zenoh-bridge-ros2dds as ROS does. Read in ros2/rmw_zenoh, ZettaScaleLabs/hiroz (both formats),
Pico-ROS, pamoja-ros2 (`dds_type_name`) and eclipse-zenoh/zenoh-plugin-ros2dds.
"""

from __future__ import annotations

import re

from webviz.sources.names import MAX_NAME

MAX_TYPE = 255
"""Characters of the name of a type."""
_DDS_TYPE = re.compile(r"([A-Za-z]\w*)::(msg|srv|action)::dds_::([A-Za-z]\w*)_", re.ASCII)
_ROS_TYPE = re.compile(r"[A-Za-z]\w*/(msg|srv|action)/[A-Za-z]\w*", re.ASCII)
_NODE = re.compile(r"[A-Za-z_]\w*", re.ASCII)
_NAMESPACE = re.compile(r"(/[A-Za-z_]\w*)*/?", re.ASCII)


def dds_type(type: str) -> str:
    """Return the DDS name of a ROS type, such as "std_msgs/msg/String"."""
    package, kind, name = type.split("/")
    return f"{package}::{kind}::dds_::{name}_"


def ros_type(dds: str) -> str:
    """Return the ROS name of a DDS type, "" if it is not one of ROS."""
    found = _DDS_TYPE.fullmatch(dds) if len(dds) <= MAX_TYPE else None
    return "/".join(found.groups()) if found else ""


def is_ros_type(type: str) -> bool:
    """Return whether ROS allows a name of a type."""
    return len(type) <= MAX_TYPE and _ROS_TYPE.fullmatch(type) is not None


def node_name(namespace: str, name: str) -> str:
    """Return the full name of a node, "" if ROS does not allow it."""
    is_valid = (
        len(namespace) + len(name) < MAX_NAME
        and _NODE.fullmatch(name) is not None
        and _NAMESPACE.fullmatch(namespace) is not None
    )
    return f"{namespace.rstrip('/')}/{name}" if is_valid else ""
