"""Faults of the ROS graph."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable
from typing import Any

import numpy as np

from tests.doctor_trial.provocation import Provocation, changed
from tests.doctor_trial.robot import SCAN, STRING, Stream, TrialRobot, TrialSubscription
from webviz.shell.testing.messages import header

CLOUD = "sensor_msgs/msg/PointCloud2"


def _reading(**how: Any) -> Callable[[TrialRobot], object]:
    return lambda robot: robot.readers.append(TrialSubscription("student", "/scan", SCAN, **how))


def _twice(robot: TrialRobot) -> None:
    robot.add("again", "scan", node="lidar#2")


def _viewers(robot: TrialRobot) -> None:
    for node in ("webviz", "webviz#2"):
        robot.streams[node] = Stream(
            node, "/clicked_point", "geometry_msgs/msg/PointStamped", lambda *_: {}, rate_hz=1e-3
        )


def _killed(at_s: float) -> Callable[[TrialRobot], object]:
    return lambda robot: robot.actions.append((at_s, lambda: os.kill(os.getpid(), signal.SIGKILL)))


def _of_type(type_: str, make: Any) -> Callable[[TrialRobot], None]:
    def change(robot: TrialRobot) -> None:
        robot.streams["other"] = Stream("other", "/other", type_, make)

    return change


def _huge(robot: TrialRobot) -> None:
    fields = [{"name": n, "offset": 4 * i, "datatype": 7, "count": 1} for i, n in enumerate("xyz")]
    points = np.random.default_rng(0).random(3_000_000 // 4, dtype=np.float32)
    robot.streams["cloud"] = Stream(
        "camera",
        "/points",
        CLOUD,
        lambda _, stamp_ns: {
            "header": header("laser", stamp_ns),
            "height": 1,
            "width": len(points) // 3,
            "fields": fields,
            "point_step": 12,
            "row_step": 4 * len(points),
            "data": points.view(np.uint8),
        },
        5.0,
        is_reliable=False,
    )


def displays_of(*displays: str, frame: str = "map") -> dict[str, Any]:
    """Return options and file of a config of these displays."""
    text = f"fixed_frame: {frame}\ndisplays: [{', '.join(displays)}]"
    return {"options": ("-d", "c.yaml"), "files": {"c.yaml": text}}


QOS = "{{type: LaserScan, topic: {{name: /scan, {}}}}}"
MAP_QOS = "{type: Map, topic: {name: /map, durability: transient_local}}"

ALL = [
    Provocation(
        "student's node that subscribes as reliable",
        "GRAPH016",
        "qos_profile_sensor_data",
        _reading(),
    ),
    Provocation(
        "node that waits for latched scans",
        "GRAPH016",
        "volatile",
        _reading(is_reliable=False, is_latched=True),
    ),
    Provocation(
        "node with a deadline", "GRAPH014", "deadline", _reading(is_reliable=False, deadline_s=0.2)
    ),
    Provocation(
        "display that asks for reliable",
        "GRAPH005",
        "",
        **displays_of(QOS.format("reliability: reliable")),
    ),
    Provocation(
        "display that asks for transient local",
        "GRAPH006",
        "",
        **displays_of(QOS.format("durability: transient_local")),
    ),
    Provocation(
        "map that is volatile", "GRAPH008", "transient local", changed("map", is_latched=False)
    ),
    Provocation("lidar that is silent", "GRAPH008", "sensor", changed("scan", ends_s=0.0)),
    Provocation(
        "wheels that are silent",
        "GRAPH008",
        "",
        lambda r: (changed("odometry", ends_s=0.0)(r), changed("odom", ends_s=0.0)(r)),
    ),
    Provocation("lidar that stops", "GRAPH009", "", changed("scan", ends_s=4.0), seconds=20.0),
    Provocation("robot that is killed", "GRAPH009", "", _killed(4.0), seconds=20.0),
    Provocation(
        "lidar that ends",
        "GRAPH011",
        "",
        lambda r: r.actions.append((4.0, lambda: r.leave("lidar"))),
        seconds=14.0,
    ),
    Provocation("lidar that is started twice", "GRAPH015", "End one", _twice),
    Provocation("two other viewers", "GRAPH015", "namespace", _viewers),
    Provocation(
        "lidar that is not activated", "GRAPH012", "lifecycle", lambda r: r.lifecycle.add("lidar")
    ),
    Provocation(
        "topic that is misspelt", "GRAPH002", "", **displays_of("{type: LaserScan, topic: /scn}")
    ),
    Provocation(
        "topic in another namespace",
        "GRAPH003",
        "/scan",
        **displays_of("{type: LaserScan, topic: /front/scan}"),
    ),
    Provocation(
        "display of another type", "GRAPH004", "", **displays_of("{type: Path, topic: /scan}")
    ),
    Provocation(
        "topic without a publisher",
        "GRAPH010",
        "",
        **displays_of("{type: PointCloud2, topic: /velodyne_points}"),
    ),
    Provocation(
        "robot in a namespace",
        "GRAPH003",
        "namespace",
        lambda r: r.into("robot1"),
        **displays_of(
            "{type: LaserScan, topic: /scan}",
            "{type: Odometry, topic: /odom}",
            "{type: Map, topic: /map}",
            "{type: RobotModel, description_topic: /robot_description}",
        ),
    ),
    Provocation(
        "robot in a namespace with transforms of its own",
        "TF001",
        "/robot1/tf",
        lambda r: r.into("robot1", True),
    ),
    Provocation(
        "scan as text",
        "GRAPH004",
        "",
        lambda r: (
            _of_type(STRING, lambda *_: {"data": "1 2 3"})(r),
            setattr(r["other"], "topic", "/scan"),
            r.remove("scan"),
        ),
        **displays_of("{type: LaserScan, topic: /scan}"),
    ),
    Provocation("large clouds as best effort", "NET013", "reliably", _huge),
]
