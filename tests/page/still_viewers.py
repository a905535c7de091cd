"""A viewer of a robot in the simulator's building, as people have it before them."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import building
import numpy as np
from bags import START_NS, Bag
from waiting import until

from tests.page.everything import group
from tests.page.page_bench import SCAN, TRANSFORMS, PageBench, PageServer
from tests.page.still_pages import NOW_NS, StillClock
from webviz.api.declared import make
from webviz.commands import Reset, SetProperty, StartRecording
from webviz.files.config.model import MemorySettings
from webviz.panels.log import LOG
from webviz.shell.testing.messages import header, stamped_transform
from webviz.sources import Offer, Publisher
from webviz.sources.bag.history import BagHistory
from webviz.sources.player import Player
from webviz.tools.goal_pose import GoalPose
from webviz.tools.publish_point import PublishPoint
from webviz_displays.grid import Grid
from webviz_displays.laser_scan import LaserScan
from webviz_displays.map import Map
from webviz_displays.path import Path as PathDisplay
from webviz_displays.robot_model import RobotModel
from webviz_displays.robot_model.parts import LinkSettings
from webviz_sim.pose import Pose2D

MAP, TEXT, ODOMETRY = "nav_msgs/msg/OccupancyGrid", "std_msgs/msg/String", "nav_msgs/msg/Odometry"
URDF = """
<robot name="lab_robot">
  <link name="base_link"><visual>
    <origin xyz="0 0 0.05"/><geometry><box size="0.7 0.5 0.1"/></geometry>
    <material name="blue"><color rgba="0.2 0.4 0.8 1"/></material>
  </visual></link>
  <link name="laser"><visual>
    <geometry><cylinder radius="0.12" length="0.1"/></geometry>
    <material name="dark"><color rgba="0.1 0.1 0.1 1"/></material>
  </visual></link>
  <joint name="mount" type="fixed"><parent link="base_link"/><child link="laser"/></joint>
</robot>
"""
ODD = "Link settings"
"""Name of the status of the robot that is a warning."""
NO_MEMORY = MemorySettings(seconds=0.0)
RAN_NS = 83_200_000_000
"""Time in ns for which each viewer of live topics has been running."""
RATED_NS = 10_000_000_000
"""Time for which messages of a viewer without memory come, of which rates are measured."""
STEP_NS = 25_000_000
TURN_NS = 200_000_000


@cache
def still_scan() -> dict[str, Any]:
    """The scan of a laser at the origin."""
    return building.scan(Pose2D(0.0, 0.0, 0.0))


def scan(frame: str, at_ns: int) -> dict[str, Any]:
    """The same with noise, which takes space in a recording."""
    random = np.random.default_rng(at_ns)
    scan = still_scan()
    return {
        **scan,
        "header": header(frame, at_ns),
        "ranges": scan["ranges"] + random.normal(0.0, 0.01, building.LIDAR.beams),
        "intensities": random.random(building.LIDAR.beams),
    }


def placed(at_ns: int) -> dict[str, Any]:
    """The transform of the robot, whose laser is at the origin."""
    return {"transforms": [stamped_transform("map", "base_link", at_ns, (-0.2, 0.0, 0.0))]}


LATCHED = {
    "/map": (MAP, {"header": header("map", 0), **building.grid()}),
    "/robot_description": (TEXT, {"data": URDF}),
    "/tf_static": (
        TRANSFORMS,
        {"transforms": [stamped_transform("base_link", "laser", 0, (0.2, 0.0, 0.15))]},
    ),
}
STREAMED = {"/rosout": LOG, "/scan": SCAN, "/tf": TRANSFORMS}


def show(viewer: PageBench, **settings: Any) -> None:
    """Show six displays, two of them in a group, with a change that is not saved."""
    scans = LaserScan(
        name="Front scan", color_transformer="FlatColor", color=(255, 60, 30), size=0.08
    )
    viewer.show(
        Grid(name="Grid"),
        Map(name="Map"),
        RobotModel(name="RobotModel", links={"gripper_link": LinkSettings()}),
        group("Sensors", scans, PathDisplay(name="Plan")),
        tools=(make(GoalPose, {}), make(PublishPoint, {})),
        path=Path("lab.yaml"),
        **settings,
    )
    viewer.do(SetProperty(viewer.id("Plan"), "enabled", False))


def wait_until_drawn(viewer: PageBench) -> None:
    """Turn until the map and the robot, which threads prepare, are drawn."""

    def are_drawn() -> bool:
        return "Map" in viewer.row("Map").statuses and ODD in viewer.row("RobotModel").statuses

    until(are_drawn, turn=viewer.turn)


class StillViewers:
    """Starts viewers on a server, one after another.

    Args:
        page_server: of their pages.
        clock: stands still at `NOW_NS` for pictures.
    """

    def __init__(self, page_server: PageServer, clock: StillClock) -> None:
        self._page_server = page_server
        self._clock = clock
        self._players: list[Player] = []
        self.recorded = 0
        """Messages of the newest viewer that are being recorded."""

    def begin(
        self,
        frame: str = "laser",
        memory: MemorySettings = NO_MEMORY,
        recorded_s: float = 0.0,
    ) -> PageBench:
        """Start a viewer of live topics, whose scans paused between 40 and 30 s ago.

        Args:
            frame: of the scans.
            memory: of live topics.
            recorded_s: seconds for which they are being recorded, to the folder "run".
        """
        self._clock.now_ns, self.recorded = NOW_NS - RAN_NS, 0
        viewer = self._page_server.begin(is_linked=False, memory=memory)
        viewer.source.now = self._clock.now_ns
        viewer.do(Reset())
        for topic, type_ in STREAMED.items():
            viewer.offer(topic, type_, "/robot")
        show(viewer, memory=memory)
        for topic, (type_, values) in LATCHED.items():
            publisher = Publisher("/robot", type_, "reliable", "transient_local")
            viewer.source.topics[topic] = Offer((publisher,), ("reliable", "transient_local"))
            viewer.turn()
            viewer.publish_past(0.0, topic, type_, values)
        viewer.publish_past(0.0, "/tf", TRANSFORMS, placed(self._clock.now_ns))
        wait_until_drawn(viewer)
        for ago_ns in range(RAN_NS if memory.seconds else RATED_NS, -1, -STEP_NS):
            at_ns = NOW_NS - ago_ns
            self._clock.go_on(viewer, at_ns)
            if ago_ns == round(recorded_s * 1e9) > 0:
                viewer.do(StartRecording("run"))
                self.recorded = len(LATCHED) + 1  # and the last transform
            count = self._publish(viewer, at_ns, frame)
            self.recorded += count if self.recorded else 0
            if ago_ns % TURN_NS == 0:
                viewer.turn()
        return viewer

    def play(self, bag: Path) -> PageBench:
        """Start a viewer of a bag, with a bookmark."""
        self._clock.now_ns = NOW_NS
        self._players.append(Player(BagHistory([bag])))
        viewer = self._page_server.begin(player=self._players[-1])
        show(viewer, bookmarks={"lost": START_NS / 1e9 + 55.0})
        return viewer

    def close(self) -> None:
        """Close the bags."""
        for player in self._players:
            player.close()

    def _publish(self, viewer: PageBench, at_ns: int, frame: str) -> int:
        """Publish what is due, and return the number of messages."""
        step, ago_s = at_ns // STEP_NS, (NOW_NS - at_ns) / 1e9
        due: list[tuple[str, dict[str, Any]]] = []
        if step % 2 == 0:
            due.append(("/tf", placed(at_ns)))
        if ago_s < 30 or (ago_s > 40 and step % 4 == 0):
            due.append(("/scan", scan(frame, at_ns)))
        if ago_s == 25:
            due.append(("/rosout", {"level": 40, "name": "amcl", "msg": "lost track"}))
        for topic, values in due:
            viewer.publish_past(0.0, topic, STREAMED[topic], values)
        return len(due)


def record(path: Path) -> Path:
    """Write a bag of 100 s, whose scans pause for 10 s and are fewer from then on."""
    bag = Bag()
    for topic, (type_, values) in LATCHED.items():
        bag.add(topic, type_, latched=True)
        bag.put(0.0, topic, values)
    bag.transform(0.0, "map", "base_link", -0.2, static=True)
    bag.add("/odom", ODOMETRY)
    bag.add("/scan", SCAN)
    for step in range(2000):
        at_s = step / 20
        bag.put(at_s, "/odom", {"header": {"frame_id": "map"}})
        if step % (2 if at_s < 40 else 4) == 0 and not 40 <= at_s < 50:
            bag.put(at_s, "/scan", scan("laser", START_NS + round(at_s * 1e9)))
    bag.put(100.0, "/odom", {"header": {"frame_id": "map"}})
    return bag.write_file(path)
