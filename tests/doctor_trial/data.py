"""Faults of what messages contain."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import building
import numpy as np

from tests.doctor_trial.provocation import Provocation
from tests.doctor_trial.robot import START, URDF, Stream, TrialRobot, Values, laser, pose
from webviz.shell.testing.messages import header
from webviz_sim.pose import Pose2D

IMAGE = "sensor_msgs/msg/Image"
Change = Callable[[TrialRobot], object]


def _then(name: str, change: Callable[[Values, float], object]) -> Change:
    return lambda robot: robot[name].then(change)


def _with(stream: str, /, **fields: Any) -> Change:
    return _then(stream, lambda values, _: values.update(fields))


def _ranges(change: Callable[[Any], Any]) -> Change:
    return _then("scan", lambda values, _: values.update(ranges=change(values["ranges"])))


def _mounted(x: float = 0.0, y: float = 0.0, yaw: float = 0.0) -> Change:
    """Return what mounts the laser elsewhere than its transform says."""

    def look(values: Values, at_s: float) -> None:
        at = laser(at_s)
        cos, sin = math.cos(at.yaw), math.sin(at.yaw)
        there = Pose2D(at.x + cos * x - sin * y, at.y + sin * x + cos * y, at.yaw + yaw)
        values.update(building.scan(there))

    return _then("scan", look)


def _elsewhere(x: float, y: float) -> Change:
    """Return what localises the robot elsewhere."""

    def shift(values: Values, _: float) -> None:
        values["transforms"][0]["transform"]["translation"].update(x=START.x + x, y=START.y + y)

    return _then("localisation", shift)


def _twist(linear: float = 1.0, angular: float = 1.0) -> Change:
    def scale(values: Values, _: float) -> None:
        twist = values["twist"]["twist"]
        twist["linear"]["x"] *= linear
        twist["angular"]["z"] *= angular

    return _then("odometry", scale)


def _own_tf(values: Values, at_s: float) -> None:
    at = pose(at_s)
    place = values["pose"]["pose"]["position"]
    place.update(x=at.x + 0.5 * at_s, y=at.y)


def _image(robot: TrialRobot, **fields: Any) -> None:
    width, height = 32, 24
    robot.streams["image"] = Stream(
        "camera",
        "/image",
        IMAGE,
        lambda _, stamp_ns: (
            {
                "header": header("laser", stamp_ns),
                "width": width,
                "height": height,
                "encoding": "rgb8",
                "step": 3 * width,
                "data": np.zeros(3 * width * height, np.uint8),
            }
            | fields
        ),
    )


def _self(ranges: Any) -> Any:
    ranges = ranges.copy()
    ranges[100:112] = 0.13
    return ranges


def _jointless(**fields: Any) -> Change:
    """Return what makes joint states invalid, which leave the wheel without a transform."""
    return lambda robot: (_with("joints", **fields)(robot), robot.remove("wheel"))


def _described(text: str) -> Change:
    return _with("description", data=text)


def _hall() -> Any:
    """Return the cells of a hall with pillars, as large as the building's map."""
    cells = np.zeros_like(building.WORLD.cells)
    cells[[0, -1]] = cells[:, [0, -1]] = 100
    rows, columns = cells.shape
    for row, column in np.random.default_rng(0).integers(0, (rows - 6, columns - 6), (30, 2)):
        cells[row : row + 6, column : column + 6] = 100
    return cells.ravel()


def _clean(robot: TrialRobot) -> None:
    robot["map"].then(lambda v, _: v.update(data=np.full_like(v["data"], -1)))


IMAGES: dict[str, Any] = {
    "options": ("-d", "c.yaml"),
    "files": {"c.yaml": "fixed_frame: map\ndisplays: [{type: Image, topic: /image}]"},
}
MESH = URDF.replace('<box size="0.3 0.2 0.1"/>', '<mesh filename="package://cart/cart.dae"/>')

ALL = [
    Provocation("scan of NaN only", "DATA006", "", _ranges(lambda r: np.full_like(r, math.nan))),
    Provocation("scan of zeros only", "DATA006", "", _ranges(np.zeros_like)),
    Provocation(
        "limits of the scan exchanged",
        "DATA006",
        "limits",
        _with("scan", range_min=10.0, range_max=0.12),
    ),
    Provocation("ranges in millimetres", "DATA007", "metres", _ranges(lambda r: r * 1000)),
    Provocation(
        "angles in degrees",
        "DATA016",
        "radians",
        _with("scan", angle_min=-180.0, angle_max=179.0, angle_increment=1.0),
    ),
    Provocation(
        "angles that disagree with the ranges", "DATA008", "", _with("scan", angle_max=0.0)
    ),
    Provocation("laser turned by 90°", "DATA001", "yaw", _mounted(yaw=math.pi / 2)),
    Provocation("laser upside down", "DATA002", "roll", _ranges(lambda r: r[::-1].copy())),
    Provocation("robot 1 m off", "DATA003", "2D Pose Estimate", _elsewhere(0.6, 0.6)),
    Provocation(
        "laser 30 cm off",
        "DATA003",
        "Correct the transform of 'laser'",
        _mounted(x=0.3),
        seconds=24.0,
    ),
    Provocation(
        "map of another place",
        "DATA004",
        "",
        _then("map", lambda v, _: v.update(data=_hall())),
    ),
    Provocation("map that is unknown", "DATA018", "", _clean),
    Provocation(
        "map with a resolution of zero",
        "DATA019",
        "resolution",
        _then("map", lambda v, _: v.update(info=v["info"] | {"resolution": 0.0})),
    ),
    Provocation(
        "map with too little data",
        "DATA019",
        "",
        _then("map", lambda v, _: v.update(data=v["data"][:100])),
    ),
    Provocation(
        "constant intensities",
        "DATA009",
        "",
        _then("scan", lambda v, _: v.update(intensities=np.zeros(360, np.float32))),
    ),
    Provocation(
        "covariance of zero",
        "DATA010",
        "",
        _then("odometry", lambda v, _: v["pose"].update(covariance=[0.0] * 36)),
    ),
    Provocation(
        "laser sees its own robot",
        "DATA014",
        "range_min",
        _then(
            "scan",
            lambda v, _: v.update(
                ranges=np.where(np.arange(360) // 12 == 8, 0.1, v["ranges"]).astype(np.float32),
                range_min=0.05,
            ),
        ),
    ),
    Provocation("twist forwards with a wrong sign", "DATA013", "sign", _twist(linear=-1.0)),
    Provocation("twist of turns with a wrong sign", "DATA013", "sign", _twist(angular=-1.0)),
    Provocation("twist in km/h", "DATA020", "m/s", _twist(linear=3.6), seconds=16.0),
    Provocation("twist in degrees", "DATA020", "rad/s", _twist(angular=57.29578), seconds=16.0),
    Provocation("odometry against its own transform", "DATA021", "", _then("odometry", _own_tf)),
    Provocation("joint states without positions", "DATA017", "position", _jointless(position=[])),
    Provocation("joint states with NaN", "DATA017", "", _jointless(position=[math.nan])),
    Provocation(
        "joint states of other joints",
        "DATA017",
        "",
        lambda r: (_with("joints", name=["arm"])(r), r.remove("wheel")),
    ),
    Provocation("meshes are missing", "DATA011", "--mesh-root", _described(MESH)),
    Provocation("description that is no XML", "DATA019", "XML", _described("<robot><link>")),
    Provocation("description that is empty", "DATA019", "", _described("")),
    Provocation(
        "image with a wrong encoding",
        "DATA015",
        "encoding",
        lambda r: _image(r, encoding="mono8"),
        **IMAGES,
    ),
    Provocation(
        "image with too little data", "DATA015", "", lambda r: _image(r, height=48), **IMAGES
    ),
    Provocation(
        "image with an unknown encoding",
        "DATA019",
        "encoding",
        lambda r: _image(r, encoding="rgb10"),
        **IMAGES,
    ),
]
