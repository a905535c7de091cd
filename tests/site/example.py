"""A drive of the simulated robot as one HTML file, which the site shows."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np

from tests.support.bags import START_NS, Bag, ns
from webviz.shell.cli import main
from webviz_sim import messages
from webviz_sim.description import demo_description, read_joints
from webviz_sim.lidar import LidarSettings, scan
from webviz_sim.pose import Pose2D
from webviz_sim.simulation import Simulation, SimulationSettings
from webviz_sim.world import load_world

NAME = "run.md"
"""Name of its page on the site."""
DURATION_S = 12.0
STEP_S = 0.05
SCAN_STEPS = 4
MAX_SIZE = "6MB"
BUILDING = Path(messages.__file__).parent / "worlds/building.yaml"
PAGE = """\
# A run in your browser

This is [one HTML file](runs/building.html), which `webviz export` wrote of a bag: 12 s of the
simulated robot. Turn the scene, play, drag the timeline, and select what you see. Nothing is loaded
from a server, and nothing is installed.
[What such a file contains](time/index.md#a-run-as-one-file).

<iframe src="runs/building.html" title="A run of the simulated robot" loading="lazy"
  style="width: 100%; height: 620px; border: 0"></iframe>

It was made by a command like this:

```sh
webviz export run.mcap -d lab.yaml --from 10 --to 22 -o run.html
```
"""
CONFIG = """\
version: 1
fixed_frame: map
view: {distance: 13, yaw: -1.75, pitch: 0.95, focal_point: [0.1, -0.3, 0.0]}
displays:
- {type: Map, draw_behind: true}
- {type: RobotModel}
- {type: LaserScan, size: 0.08}
- {type: Path}
- {type: TF, enabled: false}
"""


def write(folder: Path) -> None:
    """Write the page and the run to the sources of the site."""
    (folder / NAME).write_text(PAGE, encoding="utf-8")
    (folder / "runs").mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        bag, config = Path(scratch) / "building", Path(scratch) / "building.yaml"
        drive().write(bag)
        config.write_text(CONFIG, encoding="utf-8")
        options = ["-d", config, "--max-size", MAX_SIZE, "-o", folder / "runs/building.html"]
        status = main(["export", str(bag), *map(str, options)])
        assert status == 0, f"webviz export ended with status {status}"


def drive(duration_s: float = DURATION_S) -> Bag:
    """Messages of the simulated robot on a tour of the building, the same each time."""
    simulation = Simulation(load_world(BUILDING), SimulationSettings(), seed=1)
    robot, random, lidar = simulation.robot, np.random.default_rng(1), LidarSettings()
    joints = read_joints(demo_description())
    fixed = [joint.transform(START_NS) for joint in joints if joint.kind == "fixed"]
    by_name = {joint.name: joint for joint in joints}
    wheels = [by_name[name] for name in messages.WHEEL_JOINTS]
    (place,) = [each.translation for each in fixed if each.child == messages.SCANNER]
    scanner = Pose2D(*place[:2])

    bag = Bag()
    bag.add("/tf_static", "tf2_msgs/msg/TFMessage", latched=True)
    bag.add("/tf", "tf2_msgs/msg/TFMessage")
    bag.add("/robot_description", "std_msgs/msg/String", latched=True)
    bag.add("/map", "nav_msgs/msg/OccupancyGrid", latched=True)
    bag.add("/path", "nav_msgs/msg/Path")
    bag.add("/scan", "sensor_msgs/msg/LaserScan", best_effort=True)
    bag.put(0.0, "/tf_static", messages.tf(fixed))
    bag.put(0.0, "/robot_description", {"data": demo_description()})
    bag.put(0.0, "/map", messages.occupancy_grid(simulation.world, START_NS))
    for step in range(round(duration_s / STEP_S)):
        simulation.step(STEP_S)
        at_s = step * STEP_S
        now = START_NS + ns(at_s)
        turned = [
            joint.transform(now, angle) for joint, angle in zip(wheels, robot.wheels, strict=True)
        ]
        base_transform = messages.planar("map", "base_link", now, robot.pose)
        bag.put(at_s, "/tf", messages.tf([base_transform, *turned]))
        if step % SCAN_STEPS:
            continue
        pose = robot.pose @ scanner
        measured = scan(simulation.world, pose, pose, lidar, random)
        period = SCAN_STEPS * STEP_S
        bag.put(at_s, "/scan", messages.laser_scan(measured, lidar, now, period, sweep=False))
        if len(simulation.path) > 1:
            bag.put(at_s, "/path", messages.path(simulation.path, now))
    return bag
