"""The scenes: what is published, and how webviz shows it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import webviz_urdf
from side_by_side import content, marker_content
from side_by_side.marks import Lane, Place
from side_by_side.streams import Stream

MAP = "nav_msgs/msg/OccupancyGrid"
MAP_UPDATE = "map_msgs/msg/OccupancyGridUpdate"
SCAN = "sensor_msgs/msg/LaserScan"
CLOUD = "sensor_msgs/msg/PointCloud2"
PATH = "nav_msgs/msg/Path"
ODOMETRY = "nav_msgs/msg/Odometry"
TF = "tf2_msgs/msg/TFMessage"
TEXT = "std_msgs/msg/String"
MARKERS = "visualization_msgs/msg/MarkerArray"


@dataclass(frozen=True)
class Scene:
    """A scene.

    Args:
        name: of the command line.
        title: for people.
        make: the streams; made where they are needed, as some are large.
        displays: of webviz's config, in YAML.
        lane: the one whose latency counts.
    """

    name: str
    title: str
    make: Callable[[], list[Stream]] = field(repr=False)
    displays: str = field(repr=False)
    lane: int = 0

    @cached_property
    def streams(self) -> list[Stream]:
        """Return the published streams."""
        return self.make()

    @property
    def config(self) -> str:
        """webviz's config file."""
        return f"version: 1\nfixed_frame: map\ndisplays:\n{self.displays}"

    @property
    def lanes(self) -> list[Lane]:
        """The marks in it."""
        return [stream.lane for stream in self.streams if stream.lane is not None]

    @property
    def topics(self) -> Mapping[str, str]:
        """Types by topic."""
        return {stream.topic: stream.type for stream in self.streams}


def _scan(topic: str, frame: str, beams: int, hz: float, lane: int) -> Stream:
    return Stream(topic, SCAN, hz, content.scans(frame, beams), Lane(lane, Place.FIRST_POINT))


def _cloud(count: int, hz: float) -> Callable[[], list[Stream]]:
    lane = Lane(0, Place.FIRST_POINT)
    return lambda: [
        Stream("/tf_static", TF, 0, content.static(("map", "lidar"))),
        Stream("/points", CLOUD, hz, content.clouds("lidar", count), lane),
    ]


def _demo() -> list[Stream]:
    urdf = (Path(webviz_urdf.__file__).parent / "demo/robot.urdf").read_text()
    return [
        Stream("/robot_description", TEXT, 0, [{"data": urdf}]),
        Stream("/tf_static", TF, 0, content.static(("base_link", "scanner"))),
        Stream("/map", MAP, 0, content.maps(200)),
        Stream("/tf", TF, 50, content.moving("map", "base_link")),
        _scan("/scan", "scanner", 360, 10, 0),
        Stream("/path", PATH, 1, content.paths(100)),
        Stream("/odom", ODOMETRY, 50, content.odometry(), Lane(1, Place.LAST_POSE)),
    ]


def _small_robot() -> list[Stream]:
    return [
        Stream("/robot_description", TEXT, 0, content.robot(12)),
        Stream("/tf_static", TF, 0, content.static(("base_link", "scanner"))),
        Stream("/map", MAP, 0, content.maps(400)),
        Stream("/tf", TF, 20, content.moving("map", "base_link")),
        Stream("/tf", TF, 20, content.links(12), Lane(1, Place.LINK)),
        _scan("/scan", "scanner", 360, 10, 0),
    ]


def _robot() -> list[Stream]:
    return [
        Stream("/robot_description", TEXT, 0, content.robot(60)),
        Stream("/tf", TF, 50, content.frames("frame_", "map", 200), Lane(0, Place.FRAME)),
        Stream("/tf", TF, 50, content.links(60), Lane(1, Place.LINK)),
    ]


def _frames() -> list[Stream]:
    return [Stream("/tf", TF, 50, content.frames("frame_", "map", 200), Lane(0, Place.FRAME))]


def _laser() -> list[Stream]:
    return [
        Stream("/tf_static", TF, 0, content.static(("map", "laser"))),
        _scan("/scan", "laser", 1080, 40, 0),
    ]


def _big_map() -> list[Stream]:
    updates = content.map_updates(4000, 200)
    return [
        Stream("/tf_static", TF, 0, content.static(("map", "base_link"))),
        Stream("/map", MAP, 0, content.maps(4000), Lane(1, Place.PICTURE)),
        Stream("/map_updates", MAP_UPDATE, 5, updates, Lane(0, Place.PICTURE)),
    ]


def _everything() -> list[Stream]:
    costmaps = [
        Stream(f"/costmap_{i}", MAP, 2, content.maps(400, 2), Lane(2 + i, Place.PICTURE))
        for i in range(4)
    ]
    paths = [
        Stream(f"/path_{i}", PATH, 5, content.paths(500), Lane(6 + i, Place.FIRST_VERTEX))
        for i in range(3)
    ]
    trail = Lane(9, Place.LAST_POSE)
    return [
        Stream("/tf_static", TF, 0, content.static(("map", "front"), ("map", "rear"))),
        _scan("/scan_front", "front", 1080, 20, 0),
        _scan("/scan_rear", "rear", 1080, 20, 1),
        *costmaps,
        *paths,
        Stream("/odom", ODOMETRY, 20, content.odometry(), trail, prefill=10_000),
    ]


def _comings_and_goings() -> list[Stream]:
    return [
        *_demo(),
        Stream("/markers", MARKERS, 20, marker_content.churn(), Lane(2, Place.FRAME)),
        Stream("/tf", TF, 5, content.passing_frames(40, 5)),
    ]


def _still() -> list[Stream]:
    lane = Lane(0, Place.PICTURE)
    return [
        Stream("/tf_static", TF, 0, content.static(("map", "base_link"))),
        Stream("/map", MAP, 0, content.maps(400), lane),
    ]


def _markers(
    make: Callable[[], list[content.Values]], hz: float, place: Place
) -> Callable[[], list[Stream]]:
    return lambda: [
        Stream("/tf_static", TF, 0, content.static(("map", "base_link"))),
        Stream("/markers", MARKERS, hz, make(), Lane(0, place)),
    ]


DEMO = """\
- {type: Map, draw_behind: true}
- {type: TF, marker_scale: 0.6, show_arrows: false}
- {type: RobotModel}
- {type: LaserScan, size: 0.05}
- {type: Path}
- {type: Odometry, keep: 300, covariance: {value: false}}
"""
EVERYTHING = "".join(
    [
        *(f"- {{type: LaserScan, topic: /scan_{each}}}\n" for each in ("front", "rear")),
        *(f"- {{type: Map, topic: /costmap_{i}}}\n" for i in range(4)),
        *(f"- {{type: Path, topic: /path_{i}}}\n" for i in range(3)),
        "- {type: Odometry, keep: 10000, covariance: {value: false}}\n",
    ]
)
SMALL_ROBOT = "".join(f"- {{type: {each}}}\n" for each in ("Map", "RobotModel", "LaserScan"))
ARRAY = "- {type: MarkerArray, topic: /markers}\n"
ALL_POINTS = "- {type: PointCloud2, max_points: 0}\n"

SCENES = {
    scene.name: scene
    for scene in (
        Scene("A", "the demo", _demo, DEMO),
        Scene(
            "B",
            "a robot of 60 links and 200 frames, 50 Hz",
            _robot,
            "- {type: RobotModel}\n- {type: TF}\n",
        ),
        Scene(
            "S",
            "a small robot: a map, 12 links at 20 Hz, a scan at 10 Hz",
            _small_robot,
            SMALL_ROBOT,
            lane=1,
        ),
        Scene("TF", "200 frames, 50 Hz", _frames, "- {type: TF}\n"),
        Scene("D", "a scan of 1080 beams, 40 Hz", _laser, "- {type: LaserScan}\n"),
        Scene("E100k", "100 000 points, 10 Hz", _cloud(100_000, 10), ALL_POINTS),
        Scene("E1M3", "1 000 000 points, 3 Hz", _cloud(1_000_000, 3), ALL_POINTS),
        Scene("F", "a map of 4000 x 4000, 200 x 200 updates, 5 Hz", _big_map, "- {type: Map}\n"),
        Scene(
            "G",
            "two scans, four costmaps, three paths, a trail of 10 000",
            _everything,
            EVERYTHING,
        ),
        Scene(
            "M1k",
            "1000 cubes, 20 Hz",
            _markers(lambda: marker_content.cubes(1000, 8), 20, Place.FRAME),
            ARRAY,
        ),
        Scene(
            "depth",
            "depths of 640 x 480, 16UC1, 30 Hz, as a cloud",
            lambda: content.depths(640, 480),
            "- {type: DepthCloud, topic: /depth/image, max_points: 0}\n",
        ),
        Scene(
            "soak",
            "the demo with frames and markers that come and go",
            _comings_and_goings,
            DEMO + ARRAY,
        ),
        Scene("idle", "nothing moves", _still, "- {type: Map}\n"),
    )
}
