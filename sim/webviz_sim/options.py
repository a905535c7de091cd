"""The ROS parameters of the simulator and their valid values."""

import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

BUILDING = Path(__file__).parent / "worlds" / "building.yaml"

_KINDS = {bool: "true or false", int: "a whole number", float: "a number", str: "text"}


@dataclass(frozen=True)
class Option:
    """One parameter; its type is that of its default."""

    default: bool | int | float | str | list
    help: str
    low: float = -math.inf
    high: float = math.inf
    read_only: bool = False
    choices: tuple[str, ...] = ()

    @property
    def range(self) -> tuple[float, float] | None:
        """Its limits for those who describe it, None without any; they must be finite."""
        if math.isinf(self.low) and math.isinf(self.high):
            return None
        return float(max(self.low, -sys.float_info.max)), float(min(self.high, sys.float_info.max))

    def refusal(self, name: str, value: Any) -> str | None:
        """Return why a value is invalid, in one sentence; None if it is valid."""
        kind = type(self.default)
        if kind is list:
            # rcl reads an empty list of a file as a parameter without a value.
            if value is None or (_is_list(value) and len(value) in (0, 3)):
                return None
            return f"{name} must be [x, y, yaw] or [], not {value}."
        # A rate of 10 means 10.0.
        if type(value) is not kind and not (kind is float and type(value) is int):
            return f"{name} must be {_KINDS[kind]}, not {value!r}."
        if self.choices and value not in self.choices:
            return f"{name} must be {', '.join(self.choices[:-1])} or {self.choices[-1]}."
        # Written so that NaN is refused.
        if isinstance(value, int | float) and not self.low <= value <= self.high:
            return f"{name} must be between {self.low:g} and {self.high:g}, not {value:g}."
        return None


FAULT = "fault_"
"""Prefix of the names of faults."""

OPTIONS = {
    "world": Option(
        "",
        "Map to drive in: a yaml for nav2's map_server; empty: the bundled building.",
        read_only=True,
    ),
    "start_pose": Option(
        [],
        "Where the robot starts in the map, [x, y, yaw] in m and rad; []: any free spot.",
        read_only=True,
    ),
    "robot": Option(
        "",
        "URDF of the robot, with the joints and frames of the bundled one; empty: that.",
        read_only=True,
    ),
    "frame_prefix": Option(
        "", "Before the names of all frames but map, such as robot1/.", read_only=True
    ),
    "localization": Option(
        "perfect",
        "What places the robot in the map: perfect, amcl or slam, with their topics.",
        read_only=True,
        choices=("perfect", "amcl", "slam"),
    ),
    "obstacles": Option(0, "People who walk about, whom no map has.", 0, 50, read_only=True),
    "seed": Option(0, "Seed of all noise.", 0, 2**32 - 1, read_only=True),
    "rate": Option(50.0, "Steps, /odom and /tf per second.", 1, 500, read_only=True),
    "stamped_cmd_vel": Option(
        False, "/cmd_vel is a TwistStamped instead of a Twist.", read_only=True
    ),
    "publish_clock": Option(
        False,
        "Publish /clock from 0, and use it for stamps instead of the system's time.",
        read_only=True,
    ),
    "tour": Option(True, "Tour the building while no commands arrive."),
    "tour_speed": Option(0.35, "Speed along a path in m/s.", 0.05, 0.6),
    "cmd_vel_timeout": Option(0.5, "How long a /cmd_vel is valid, in s.", 0.05, 10),
    "odom_drift": Option(0.0, "Error of the odometry, as a fraction of the motion.", 0, 1),
    "slip": Option(0.0, "Share of the wheels' motion that the robot does not make.", 0, 0.9),
    "transform_tolerance": Option(0.2, "How far map -> odom is stamped ahead, in s.", 0, 10),
    "joint_state_rate": Option(20.0, "/joint_states per second.", 0.1, 500),
    "scan_rate": Option(10.0, "Revolutions of the scanner, /scan, per second.", 0.1, 100),
    "scan_beams": Option(360, "Beams of one revolution.", 1, 20_000),
    "scan_range_min": Option(0.12, "Nearest distance measured, in m.", 0, 100),
    "scan_range_max": Option(10.0, "Farthest distance measured, in m.", 0.1, 1000),
    "scan_noise": Option(0.01, "Standard deviation of a range, in m.", 0, 10),
    "scan_sweep": Option(
        False,
        "Measure each beam at its own time, as a rotating scanner does, and set time_increment; "
        "otherwise measure all beams at the stamp.",
    ),
}

OPTIONS |= {
    FAULT + name: Option(0.0, f"A fault: {text}", low, high, read_only=True)
    for name, (text, low, high) in {
        "laser_yaw": ("/tf_static has the laser turned by this, in rad.", -math.pi, math.pi),
        "misplaced": ("/tf_static has map -> odom, this far beside the robot, in m.", -100, 100),
        "stale_path": ("a path is planned once, and a box on it later; 1 is on.", 0, 1),
        "clock": ("all stamps are this late, in s.", -1000, 1000),
    }.items()
}


def fault_parameter(text: str) -> str:
    """Return the parameter, as NAME:=VALUE, of a fault that is given as NAME=VALUE.

    1 without a value.

    Raises:
        ValueError: the fault is unknown, or its value is invalid; the text says which.
    """
    name, _, value = text.partition("=")
    option = OPTIONS.get(FAULT + name)
    if option is None:
        names = ", ".join(key.removeprefix(FAULT) for key in OPTIONS if key.startswith(FAULT))
        raise ValueError(f"Unknown fault '{name}'. Choose one of {names}.")
    try:
        number = float(value or 1.0)
    except ValueError:
        raise ValueError(f"{name} must be a number, not '{value}'.") from None
    if reason := option.refusal(name, number):
        raise ValueError(reason.removesuffix("."))
    return f"{FAULT}{name}:={number!r}"


def _is_list(value: Any) -> bool:
    """Return whether a value is a list of finite numbers."""
    if isinstance(value, str | bytes) or not isinstance(value, Sequence):
        return False
    return all(isinstance(each, int | float) and math.isfinite(each) for each in value)


def refusal(values: dict[str, Any]) -> str | None:
    """Return why values are invalid, alone or together, in one sentence; None if they are valid.

    Args:
        values: By name; unknown names are ignored.
    """
    for name, value in values.items():
        if name in OPTIONS and (reason := OPTIONS[name].refusal(name, value)):
            return reason
    low, high = values.get("scan_range_min", -math.inf), values.get("scan_range_max", math.inf)
    if low >= high:
        return f"scan_range_min must be below scan_range_max, which is {high}."
    return None
