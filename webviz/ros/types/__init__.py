"""Message and service classes for rclpy by name, even if the package of the type is missing.

`/tf` carries `tf2_msgs/msg/TFMessage`, but PyPI has no tf2_msgs; nor has it map_msgs and nav2_msgs.
rclpy does not need the generated Python code of a type. It needs a `rosidl_message_type_support_t`
or `rosidl_service_type_support_t`, as a capsule in `_TYPE_SUPPORT` of the metaclass. A package
contains this struct in a shared library. Without the package, it is composed here with ctypes from
the definition of the type:

* names and bounds for rmw_fastrtps_cpp (`message_type_support_callbacks_t`),
* the members of the type and its nested types (`MessageMembers`), announced by Fast DDS,
* the type description and its hash (REP 2016), which other nodes request and compare.

There is no C struct of the message itself, so messages are serialised CDR bytes only: subscribe
with `raw=True`, publish `bytes`; requests and responses hold their bytes in `cdr`. The layouts are
those of ROS 2 Jazzy and Kilted in the headers of rosidl_runtime_c,
rosidl_typesupport_fastrtps_cpp and rosidl_typesupport_introspection_c. Other RMW implementations
and distributions have other structs and need the package.
"""

from webviz.ros.types.classes import (
    MessageTypeError,
    from_cdr,
    message_class,
    service_class,
    to_cdr,
)
from webviz.ros.types.descriptions import type_hash
from webviz.ros.types.learning import learn

__all__ = [
    "MessageTypeError",
    "from_cdr",
    "learn",
    "message_class",
    "service_class",
    "to_cdr",
    "type_hash",
]
