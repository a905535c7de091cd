"""Bags of robots that are well though they are odd, in which the doctor finds nothing."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import building
import msgspec
import numpy as np
import pytest
from bags import START_NS, TF, Bag, ns, stamped

from webviz.shell.cli import main
from webviz.shell.doctor.report import DoctorReport
from webviz.shell.testing import header
from webviz_sim.pose import Pose2D

SECONDS, MOVING_S = 5.0, 2.5
SPEED = 0.4
START = Pose2D(-2.0, 0.0)
TWO_DAYS = 172_800.0


def distance_driven(at_s: float) -> float:
    """The way in metres that the robot has driven, before it stops."""
    return SPEED * min(at_s, MOVING_S)


def times(rate: float) -> list[float]:
    return [step / rate for step in range(int(SECONDS * rate))]


def head(frame: str, at_s: float) -> dict[str, Any]:
    return header(frame, START_NS + ns(at_s))


def write(path: Path, namespace: str, prefix: str) -> Path:
    """Write a bag of a robot in a namespace and with a prefix of frames.

    The map and the static transforms are older than a day, AMCL stamps ahead, the wheels slip,
    covariances and intensities are zero, beams without a return too, there are transforms at 10 Hz
    and scans at 5 Hz, costmaps beside the map, an IMU without orientation, and what the navigation
    sends ends with the way.
    """
    bag = Bag()
    bag.add("/tf_static", TF, latched=True)
    bag.add("/tf", TF)
    bag.add("/map", "nav_msgs/msg/OccupancyGrid", latched=True)
    bag.put(0.0, "/map", building.grid() | {"header": head("map", -TWO_DAYS)})
    laser = stamped(f"{prefix}base_link", f"{prefix}laser", START_NS - ns(TWO_DAYS))
    bag.put(0.0, "/tf_static", {"transforms": [laser]})
    local = f"{namespace}/local_costmap/costmap"
    streams = {
        f"{namespace}/scan": "sensor_msgs/msg/LaserScan",
        f"{namespace}/odom": "nav_msgs/msg/Odometry",
        f"{namespace}/imu": "sensor_msgs/msg/Imu",
        f"{namespace}/plan": "nav_msgs/msg/Path",
        f"{namespace}/amcl_pose": "geometry_msgs/msg/PoseWithCovarianceStamped",
        local: "nav_msgs/msg/OccupancyGrid",
    }
    for topic, type_ in streams.items():
        bag.add(topic, type_)
    for at_s in times(10.0):
        at_ns = START_NS + ns(at_s)
        bag.put(
            at_s + 0.02,
            "/tf",
            {
                "transforms": [
                    stamped(f"{prefix}odom", f"{prefix}base_link", at_ns, distance_driven(at_s))
                ]
            },
        )
        place = {"position": {"x": distance_driven(at_s)}, "orientation": {"w": 1.0}}
        slipping = {"linear": {"x": 1.4 * SPEED}}
        odometry = {"pose": {"pose": place}, "twist": {"twist": slipping}}
        bag.put(at_s, f"{namespace}/odom", {"header": head(f"{prefix}odom", at_s)} | odometry)
        imu = {"orientation": {"w": 0.0}, "orientation_covariance": [-1.0] + [0.0] * 8}
        bag.put(at_s, f"{namespace}/imu", {"header": head(f"{prefix}base_link", at_s)} | imu)
    for at_s in times(5.0):
        ahead = stamped("map", f"{prefix}odom", START_NS + ns(at_s + 1.0), START.x)
        bag.put(at_s, "/tf", {"transforms": [ahead]})
        scan = building.scan(Pose2D(START.x + distance_driven(at_s), START.y))
        scan["ranges"] = np.where(np.arange(360) % 5, scan["ranges"], 0.0).astype(np.float32)
        scan["intensities"] = np.zeros(360, np.float32)
        bag.put(at_s + 0.05, f"{namespace}/scan", {"header": head(f"{prefix}laser", at_s)} | scan)
        corner = {
            "position": {"x": distance_driven(at_s) - 1.5, "y": -1.5},
            "orientation": {"w": 1.0},
        }
        info = {"resolution": 0.05, "width": 60, "height": 60, "origin": corner}
        cells = {"info": info, "data": np.zeros(3600, np.int8)}
        bag.put(at_s, local, {"header": head(f"{prefix}odom", at_s)} | cells)
        if at_s < MOVING_S:
            way = building.path([(START.x + distance_driven(at_s), 0.0), (START.x + 1.0, 0.0)])
            bag.put(at_s, f"{namespace}/plan", way | {"header": head("map", at_s)})
            pose = {"pose": {"pose": {"orientation": {"w": 1.0}}, "covariance": [0.1] * 36}}
            bag.put(at_s, f"{namespace}/amcl_pose", {"header": head("map", at_s)} | pose)
    return bag.write(path)


@pytest.mark.parametrize(("namespace", "prefix"), [("", ""), ("/robot1", "robot1/")])
def test_a_healthy_robot_has_no_findings(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], namespace: str, prefix: str
) -> None:
    bag = write(tmp_path / "run", namespace, prefix)
    status = main(["doctor", "--bag", str(bag), "--json"])
    report = msgspec.json.decode(capsys.readouterr().out, type=DoctorReport)
    assert [each.cause for each in report.findings if each.severity != "note"] == []
    assert status == 0
    assert report.displays > len(("Map", "LaserScan", "Odometry", "Imu", "Path"))


def test_topics_missing_in_a_bag_are_one_finding_for_all_displays(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bag = write(tmp_path / "run", "", "")
    expected = [f"/front{number}/scan_of_another_robot" for number in range(6)]
    displays = [{"type": "LaserScan", "topic": {"name": topic}} for topic in expected]
    config = tmp_path / "config.yaml"
    config.write_bytes(msgspec.json.encode({"displays": displays}))
    main(["doctor", "--bag", str(bag), "--display-config", str(config), "--json"])
    report = msgspec.json.decode(capsys.readouterr().out, type=DoctorReport)
    (finding,) = [each for each in report.findings if each.id == "GRAPH010"]
    assert finding.cause == "6 displays read topics that this bag lacks."
    assert finding.proof == f"It has no messages on {', '.join(expected[:4])} and 2 more."
    assert len(finding.explains) == 6
