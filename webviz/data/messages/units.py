"""Units of the numbers in messages, as the definitions of their types and REP 103 state them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from webviz.data.messages.errors import MessageError
from webviz.data.messages.typestore import KNOWN, MessageTypes, fields

TIMES = "builtin_interfaces/msg/Time", "builtin_interfaces/msg/Duration"
"""Types that are read as numbers."""
POSITION = {"x": "m", "y": "m", "z": "m"}
UNITS: Mapping[str, Mapping[str, str]] = {
    "builtin_interfaces/msg/Duration": {"sec": "s", "nanosec": "ns"},
    "builtin_interfaces/msg/Time": {"sec": "s", "nanosec": "ns"},
    "geometry_msgs/msg/Accel": {"linear": "m/s²", "angular": "rad/s²"},
    "geometry_msgs/msg/Inertia": {"m": "kg", "com": "m"},
    "geometry_msgs/msg/Point": POSITION,
    "geometry_msgs/msg/Point32": POSITION,
    "geometry_msgs/msg/PointStamped": {"point": "m"},
    "geometry_msgs/msg/Pose": {"position": "m"},
    "geometry_msgs/msg/Pose2D": {"x": "m", "y": "m", "theta": "rad"},
    "geometry_msgs/msg/Transform": {"translation": "m"},
    "geometry_msgs/msg/Twist": {"linear": "m/s", "angular": "rad/s"},
    "geometry_msgs/msg/Wrench": {"force": "N", "torque": "N·m"},
    "nav_msgs/msg/MapMetaData": {"resolution": "m"},
    "sensor_msgs/msg/BatteryState": {
        "voltage": "V",
        "temperature": "°C",
        "current": "A",
        "charge": "Ah",
        "capacity": "Ah",
        "design_capacity": "Ah",
        "cell_voltage": "V",
        "cell_temperature": "°C",
    },
    "sensor_msgs/msg/FluidPressure": {"fluid_pressure": "Pa"},
    "sensor_msgs/msg/Illuminance": {"illuminance": "lx"},
    "sensor_msgs/msg/Imu": {"angular_velocity": "rad/s", "linear_acceleration": "m/s²"},
    "sensor_msgs/msg/LaserScan": {
        "angle_min": "rad",
        "angle_max": "rad",
        "angle_increment": "rad",
        "time_increment": "s",
        "scan_time": "s",
        "range_min": "m",
        "range_max": "m",
        "ranges": "m",
    },
    "sensor_msgs/msg/MagneticField": {"magnetic_field": "T"},
    "sensor_msgs/msg/NavSatFix": {"latitude": "°", "longitude": "°", "altitude": "m"},
    "sensor_msgs/msg/Range": {
        "field_of_view": "rad",
        "min_range": "m",
        "max_range": "m",
        "range": "m",
    },
    "sensor_msgs/msg/Temperature": {"temperature": "°C"},
}
"""Units of the fields of a type; those of a vector are of its components, too."""


def unit_of(type_name: str, names: Sequence[str], types: MessageTypes = KNOWN) -> str:
    """Return the unit of a number in a message, "" if its type states none.

    Args:
        type_name: three-part name.
        names: of the fields that lead to it, from the outermost.
        types: that define the type.
    """
    unit = ""
    for name in names:
        try:
            known = {field.name: field for field in fields(type_name, types)}
        except MessageError:
            return ""
        if name not in known:
            return unit
        unit = UNITS.get(type_name, {}).get(name, unit)
        if not known[name].is_message:
            return unit
        type_name = known[name].base
    return "s" if type_name in TIMES else unit
