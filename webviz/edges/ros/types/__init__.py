"""Message and service classes for rclpy by name, also for types whose package is not installed.

`/tf` carries `tf2_msgs/msg/TFMessage`, and tf2_msgs is not among the ROS packages on PyPI; neither
are map_msgs and nav2_msgs. rclpy needs no generated Python code of a type, only what the middleware
must know of it: a `rosidl_message_type_support_t` or `rosidl_service_type_support_t`, held by a
capsule in the attribute `_TYPE_SUPPORT` of the class's metaclass. A package brings that struct
compiled in a shared library. If the package is missing, this package composes the same struct with
ctypes, from the definition:

* names and bounds, as rmw_fastrtps_cpp wants them (`message_type_support_callbacks_t`),
* the members of the type and of every nested type (`MessageMembers`), which Fast DDS announces,
* the type description and its hash (REP 2016), which other nodes compare and ask for.

No C struct stands behind such a class, so its messages exist as serialised CDR bytes only:
subscribe with `raw=True`, publish `bytes`; requests and responses hold their bytes in `cdr`. The
layouts are those of ROS 2 Jazzy, in the headers of rosidl_runtime_c,
rosidl_typesupport_fastrtps_cpp and rosidl_typesupport_introspection_c. Another RMW implementation
looks for other structs and so needs the real package.
"""

from webviz.edges.ros.types.classes import (
    MessageTypeError,
    from_cdr,
    message_class,
    service_class,
    to_cdr,
)
from webviz.edges.ros.types.descriptions import type_hash
from webviz.edges.ros.types.learning import learn

__all__ = [
    "MessageTypeError",
    "from_cdr",
    "learn",
    "message_class",
    "service_class",
    "to_cdr",
    "type_hash",
]
