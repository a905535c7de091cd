"""ROS 2 messages without ROS: definitions, decoding of received bytes, and encoding.

`decode` takes a type name and the bytes received from DDS or a bag. The message it returns has the
field names of ROS (`scan.header.frame_id`, `grid.info.resolution`); numeric arrays, and sequences
of points and poses (see `webviz.data.messages.geometry`), are read-only numpy arrays, mostly views
of the bytes. Some messages have typed classes here; that of any other is
`message_class(type_name)`. All are built as in rclpy: `Header(frame_id="map")`. `encode` returns
the bytes of such messages, or of nested mappings.
"""

from webviz.data.messages.classes import is_message, message_class, types_of
from webviz.data.messages.decode import decode, defined, peek_header, prepare, register
from webviz.data.messages.encode import encode
from webviz.data.messages.errors import (
    DecodeError,
    DefinitionError,
    EncodeError,
    MessageError,
    UnknownTypeError,
)
from webviz.data.messages.geometry import (
    Duration,
    FrameTransform,
    Header,
    Point,
    Pose,
    PoseArray,
    PoseSequence,
    PoseStamped,
    PoseStampedSequence,
    PoseWithCovariance,
    PoseWithCovarianceStamped,
    Quaternion,
    TFMessage,
    Time,
    Twist,
    TwistWithCovariance,
    Vector3,
)
from webviz.data.messages.markers import (
    ColorRGBA,
    CompressedImage,
    Marker,
    MarkerArray,
    MarkerSequence,
    MeshFile,
)
from webviz.data.messages.trajectories import JointTrajectoryPoint, JointTrajectoryPointSequence
from webviz.data.messages.tree import to_tree
from webviz.data.messages.types import (
    Clock,
    JointState,
    LaserScan,
    MapMetaData,
    OccupancyGrid,
    OccupancyGridUpdate,
    Odometry,
    Path,
    PointCloud2,
    PointField,
    String,
)
from webviz.data.messages.typestore import (
    KNOWN,
    MessageTypes,
    definition,
    find_with,
    type_exists,
    type_hash,
)
from webviz.data.messages.workspaces import learn

__all__ = [
    "KNOWN",
    "Clock",
    "ColorRGBA",
    "CompressedImage",
    "DecodeError",
    "DefinitionError",
    "Duration",
    "EncodeError",
    "FrameTransform",
    "Header",
    "JointState",
    "JointTrajectoryPoint",
    "JointTrajectoryPointSequence",
    "LaserScan",
    "MapMetaData",
    "Marker",
    "MarkerArray",
    "MarkerSequence",
    "MeshFile",
    "MessageError",
    "MessageTypes",
    "OccupancyGrid",
    "OccupancyGridUpdate",
    "Odometry",
    "Path",
    "Point",
    "PointCloud2",
    "PointField",
    "Pose",
    "PoseArray",
    "PoseSequence",
    "PoseStamped",
    "PoseStampedSequence",
    "PoseWithCovariance",
    "PoseWithCovarianceStamped",
    "Quaternion",
    "String",
    "TFMessage",
    "Time",
    "Twist",
    "TwistWithCovariance",
    "UnknownTypeError",
    "Vector3",
    "decode",
    "defined",
    "definition",
    "encode",
    "is_message",
    "message_class",
    "peek_header",
    "prepare",
    "register",
    "to_tree",
    "type_exists",
    "type_hash",
    "types_of",
]

find_with(learn)  # the last to be asked: what is installed is what runs
