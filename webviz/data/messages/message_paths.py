"""Message paths: a topic, the path of a field, and functions: `/odom.twist.twist.linear.x.@abs`.

`displays/docs/page/message_paths.md` describes the syntax.
"""

from __future__ import annotations

import math
import re
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from webviz.data.messages.errors import MessageError
from webviz.data.messages.paths import (
    MAX_LENGTH,
    FieldPath,
    PathError,
    as_number,
    required_number,
)
from webviz.data.messages.typestore import KNOWN, MessageTypes, fields
from webviz.data.messages.value_names import NO_NAMES, ValueNames, names_at

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
            by_name = {field.name: field for field in fields(type_name, types)}
        except MessageError:
            return ""
        if name not in by_name:
            return unit
        unit = UNITS.get(type_name, {}).get(name, unit)
        if not by_name[name].is_message:
            return unit
        type_name = by_name[name].base
    return "s" if type_name in TIMES else unit


FUNCTIONS: Mapping[str, Callable[[float], float]] = {
    "abs": abs,
    "negative": lambda value: -value,
    "degrees": math.degrees,
    "radians": math.radians,
}
"""Functions of a number."""
GEOMETRIC = ("norm", "roll", "pitch", "yaw")
"""Functions of a vector, and of a quaternion in radians; they come first."""
ANGLES = {"roll": "rad", "pitch": "rad", "yaw": "rad", "radians": "rad", "degrees": "°"}
"""Units of what functions give."""
OVER_TIME = ("derivative", "mean")
"""Functions of a number and those before it."""
MEAN_S = 1.0
"""Time that `@mean` averages by default."""
MAX_MEAN_S = 3600.0
MAX_KEPT = 10_000
"""Values that a moving average keeps; of a faster topic, the newest ones count."""
MAX_FUNCTIONS = 8

_TOPIC = re.compile(r"/[A-Za-z0-9_~/]*")
_FUNCTION = re.compile(r"\.@(\w+)(?:\(([0-9.]+)\))?")
_CALLS = re.compile(r"(?:\.@\w+(?:\([0-9.]+\))?)*\Z")

OverTime = Callable[[float, float], float]
"""A function of the time in seconds and the value, called in the order of time."""


class MessagePath:
    """A topic, and what is read of its messages.

    Args:
        text: as written.

    Raises:
        PathError: it is not a message path; one sentence.
    """

    def __init__(self, text: str) -> None:
        self.text = text = text.strip()
        topic = _TOPIC.match(text) if len(text) <= MAX_LENGTH else None
        if topic is None or len(topic[0]) < 2:
            raise PathError(f"`{text[:80]}` has no topic. Start it with one, such as /odom.")
        self.topic = topic[0]
        calls = _CALLS.search(text)
        end = calls.start() if calls else len(text)
        rest = text[topic.end() : end]
        self._field = FieldPath(rest.removeprefix(".")) if rest else None
        self._geometry = ""
        self._functions: list[Callable[[float], float]] = []
        self._over_time: list[tuple[str, float]] = []
        self._calls: list[str] = []
        function_calls = _FUNCTION.findall(text, end)
        if len(function_calls) > MAX_FUNCTIONS:
            raise PathError(f"`{text[:80]}` has more than {MAX_FUNCTIONS} functions.")
        for place, (name, argument) in enumerate(function_calls):
            self._add(name, argument, is_first=place == 0)

    def _add(self, name: str, argument: str, *, is_first: bool) -> None:
        if argument and name != "mean":
            raise PathError(f"`@{name}` takes no argument.")
        self._calls.append(name)
        if name in GEOMETRIC and is_first:
            self._geometry = name
        elif name in GEOMETRIC:
            raise PathError(f"`@{name}` needs a field. Make it the first function.")
        elif name in FUNCTIONS and not self._over_time:
            self._functions.append(FUNCTIONS[name])
        elif name in FUNCTIONS:
            raise PathError(f"`@{name}` comes before functions over time, such as `@derivative`.")
        elif name in OVER_TIME:
            self._over_time.append((name, _seconds(argument)))
        else:
            names = ", ".join(f"@{each}" for each in (*GEOMETRIC, *FUNCTIONS, *OVER_TIME))
            raise PathError(f"Unknown function `@{name[:40]}`. Use {names}.")

    def values(self, message: Any) -> list[Any]:
        """Return the values in a message before functions over time; the message without a field.

        Raises:
            PathError: it has no such field or element, or a function does not fit it.
        """
        field_values = [message] if self._field is None else self._field.values(message)
        if not self._geometry and not self._functions:
            return field_values
        return [self._calculated(value) for value in field_values]

    def one(self, message: Any) -> Any:
        """Return the only value in a message, as `values`; see `FieldPath.one`."""
        value = message if self._field is None else self._field.one(message)
        is_plain = not self._geometry and not self._functions
        return value if is_plain else self._calculated(value)

    def number(self, message: Any) -> float:
        """Return the only number in a message, before functions over time.

        See `FieldPath.number`.
        """
        return required_number(self.one(message), self.text)

    def unit(self, type_name: str, types: MessageTypes = KNOWN) -> str:
        """Return the unit of the values, "" if the type of the messages states none.

        Args:
            type_name: of the messages.
            types: that define it.
        """
        unit = unit_of(type_name, self._field.names, types) if self._field else ""
        for name in self._calls:
            if name in ANGLES:
                unit = ANGLES[name]
            elif name == "derivative" and unit:
                unit = f"{unit}²" if unit.endswith("/s") else f"{unit}/s"
        return unit

    def value_names(self, message: Any) -> ValueNames:
        """Return the names of the values in a message; none of what functions give."""
        if self._field is None or self._calls:
            return NO_NAMES
        return names_at(message, self._field.names)

    @property
    def has_field(self) -> bool:
        """True if it is about a part of the messages."""
        return self._field is not None

    @property
    def finds_many(self) -> bool:
        """True if messages may have several values, or none."""
        return self._field is not None and self._field.finds_many

    def over_time(self) -> OverTime | None:
        """Return the functions over time, without values so far; None if it has none."""
        chain = [Derivative() if name == "derivative" else Mean(s) for name, s in self._over_time]
        if not chain:
            return None

        def follow(time_s: float, value: float) -> float:
            for each in chain:
                value = each(time_s, value)
            return value

        return follow

    def _calculated(self, value: Any) -> float:
        if self._geometry:
            value = _geometry(self._geometry, value, self.text)
        number = required_number(value, self.text)
        for function in self._functions:
            number = function(number)
        return number


class Derivative:
    """The change per second since the value before; NaN for the first, and without time between."""

    def __init__(self) -> None:
        self._before: tuple[float, float] | None = None

    def __call__(self, time_s: float, value: float) -> float:
        """Take a value."""
        before, self._before = self._before, (time_s, value)
        if before is None or time_s <= before[0]:
            return math.nan
        return (value - before[1]) / (time_s - before[0])


class Mean:
    """The mean of the finite values of the last seconds; NaN without one.

    Args:
        seconds: that it averages, up to the newest value.
    """

    def __init__(self, seconds: float) -> None:
        self._seconds = seconds
        self._window: deque[tuple[float, float]] = deque()
        self._sum = 0.0
        self._changes = 0

    def __call__(self, time_s: float, value: float) -> float:
        """Take a value."""
        if math.isfinite(value):
            self._window.append((time_s, value))
            self._sum += value
        while self._window and (
            self._window[0][0] < time_s - self._seconds or len(self._window) > MAX_KEPT
        ):
            self._sum -= self._window.popleft()[1]
            self._changes += 1
        count = len(self._window)
        if self._changes > count or not math.isfinite(self._sum):
            # A sum that values are taken from drifts, and one of large values overflows.
            self._changes = 0
            mean = math.fsum(each / count for _, each in self._window) if count else math.nan
            self._sum = mean * count if count else 0.0
            return mean
        return self._sum / count if count else math.nan


def _seconds(argument: str) -> float:
    try:
        seconds = float(argument or MEAN_S)
    except ValueError:
        seconds = 0.0
    if not 0.0 < seconds <= MAX_MEAN_S:
        raise PathError(f"`@mean({argument[:20]})` needs seconds, up to {MAX_MEAN_S:g}.")
    return seconds


def _geometry(name: str, value: Any, text: str) -> float:
    """Return the length of a vector, or an angle of a quaternion (x, y, z, w)."""
    size = 0 if name == "norm" else 4
    parts = _parts(value)
    if parts is None or (size and len(parts) != size):
        needed = "a quaternion" if size else "a vector"
        raise PathError(f"`{text}`: @{name} needs {needed}.")
    if name == "norm":
        return float(np.linalg.norm(parts))
    x, y, z, w = parts
    # Roll, pitch and yaw about fixed axes: Diebel, "Representing Attitude" (2006), (290).
    if name == "roll":
        return math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    if name == "pitch":
        return math.asin(max(-1.0, min(1.0, 2 * (w * y - z * x))))
    return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


def _parts(value: Any) -> list[float] | None:
    """Return the numbers of a vector, None if it is not one."""
    if isinstance(value, np.ndarray) and value.ndim == 1:
        return [float(each) for each in value]
    if isinstance(value, tuple) and all(isinstance(each, float | int) for each in value):
        return [float(each) for each in value]
    names = getattr(value, "__struct_fields__", None) or getattr(value, "_fields", ())
    if tuple(names[:2]) != ("x", "y"):
        return None
    numbers = [as_number(getattr(value, name)) for name in names]
    return None if None in numbers else [each for each in numbers if each is not None]
