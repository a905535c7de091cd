"""Faults of transforms."""

from __future__ import annotations

import math
from typing import Any

from tests.doctor_trial.provocation import Provocation, changed
from tests.doctor_trial.robot import TrialRobot, Values


def _transform(values: Values) -> Any:
    return values["transforms"][0]


def _renamed(name: str, parent: str) -> Any:
    """Return what gives a stream's transform another parent."""
    return lambda robot: robot[name].then(
        lambda values, _: _transform(values)["header"].update(frame_id=parent)
    )


def _placed(name: str, part: str, **values: float) -> Any:
    """Return what changes the translation or rotation of a stream's transform."""
    return lambda robot: robot[name].then(
        lambda message, _: _transform(message)["transform"][part].update(values)
    )


def _framed(name: str, frame: str) -> Any:
    return lambda robot: robot[name].then(lambda values, _: values["header"].update(frame_id=frame))


def _jumping(name: str) -> Any:
    """Return what moves a transform by 1.5 m every half second."""

    def jump(values: Values, at_s: float) -> None:
        place = _transform(values)["transform"]["translation"]
        place["x"] += 1.5 * (int(at_s / 0.5) % 2)

    return lambda robot: robot[name].then(jump)


def _loop(robot: TrialRobot) -> None:
    robot.link("arm", "hand")
    robot.link("hand", "arm")


def _two_static(robot: TrialRobot) -> None:
    robot.add("again", "mount", node="other").then(
        lambda values, _: _transform(values)["transform"]["translation"].update(x=0.4)
    )


def _static_too(robot: TrialRobot) -> None:
    robot.add("again", "mount", node="other", topic="/tf", rate_hz=10.0, is_latched=False)


def _unlocalised(robot: TrialRobot) -> None:
    robot.remove("localisation")


def _removed(*names: str) -> Any:
    return lambda robot: robot.remove(*names)


NULL = {"x": 0.0, "y": 0.0, "z": 0.0, "w": 0.0}
LASER, ODOM = "scan", "odom"

ALL = [
    Provocation("loop of two frames", "TF007", "parent", _loop),
    Provocation(
        "two parents of the base", "TF008", "parent", lambda r: r.link("other", "base_link")
    ),
    Provocation("two static poses of the laser", "TF009", "", _two_static),
    Provocation("laser on /tf and /tf_static", "TF010", "", _static_too),
    Provocation(
        "two publishers of the odometry transform",
        "TF011",
        "",
        lambda r: r.link("odom", "base_link"),
    ),
    Provocation(
        "no transforms at all", "TF001", "", _removed("odom", "localisation", "wheel", "mount")
    ),
    Provocation("localisation does not run", "TF003", "AMCL", _unlocalised),
    Provocation("no odometry transform", "TF005", "odometry", _removed("odom")),
    Provocation(
        "no robot_state_publisher",
        "TF012",
        "robot_state_publisher",
        _removed("mount", "wheel", "description"),
    ),
    Provocation("no joint states", "TF013", "joint_state_publisher", _removed("joints", "wheel")),
    Provocation("frame of the scan with a slash", "TF014", "", _framed(LASER, "/laser")),
    Provocation("frame of the scan is empty", "TF015", "", _framed(LASER, "")),
    Provocation("frame of the scan is misspelt", "TF016", "", _framed(LASER, "lasr")),
    Provocation(
        "frame of the scan is unknown",
        "TF017",
        "--child-frame-id lidar_top",
        _framed(LASER, "lidar_top"),
    ),
    Provocation("odometry stops", "TF018", "", changed(ODOM, ends_s=4.0), seconds=20.0),
    Provocation(
        "localisation every 3 s",
        "TF019",
        "rate",
        changed("localisation", rate_hz=1 / 3, ahead_s=0.0),
        seconds=20.0,
    ),
    Provocation(
        "odometry transform at 1 Hz", "TF019", "rate", changed(ODOM, rate_hz=1.0), seconds=12.0
    ),
    Provocation(
        "base at UTM coordinates",
        "TF022",
        "",
        _placed("localisation", "translation", x=4.5e5, y=5.4e6),
    ),
    Provocation(
        "zeros as the laser's quaternion", "TF023", "", _placed("mount", "rotation", **NULL)
    ),
    Provocation(
        "zeros as the odometry's quaternion", "TF023", "", _placed(ODOM, "rotation", **NULL)
    ),
    Provocation(
        "NaN as the odometry's quaternion", "TF023", "", _placed(ODOM, "rotation", w=math.nan)
    ),
    Provocation(
        "NaN as the odometry's position", "TF023", "", _placed(ODOM, "translation", x=math.nan)
    ),
    Provocation("quaternion that is not normalised", "TF023", "", _placed(ODOM, "rotation", w=3.0)),
    Provocation("laser without a parent", "TF023", "", _renamed("mount", parent="")),
    Provocation("base as its own parent", "TF023", "", _renamed(ODOM, parent="base_link")),
    Provocation(
        "static transform that is volatile", "TF024", "", changed("mount", is_latched=False)
    ),
    Provocation("localisation that jumps", "TF026", "", _jumping("localisation")),
    Provocation("odometry transform that jumps", "TF026", "", _jumping(ODOM)),
    Provocation("two trees", "TF006", "", _renamed("mount", parent="chassis")),
    Provocation(
        "fixed frame is misspelt",
        "TF002",
        "",
        options=["-d", "c.yaml"],
        files={"c.yaml": "fixed_frame: mapp\ndisplays: [{type: LaserScan, topic: /scan}]"},
    ),
    Provocation(
        "fixed frame does not exist",
        "TF004",
        "",
        options=["-d", "c.yaml"],
        files={"c.yaml": "fixed_frame: earth\ndisplays: [{type: LaserScan, topic: /scan}]"},
    ),
    Provocation("laser in a frame of its own prefix", "TF016", "", _framed(LASER, "robot1/laser")),
]
