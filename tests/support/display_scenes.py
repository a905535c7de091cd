"""Messages for each display, in which every property of it has something to change."""

from __future__ import annotations

import numpy as np
import photos
from clouds import CLOUD, xyz_cloud
from moveit_scenes import settle

from webviz.api.display import inputs
from webviz.shell.testing import DisplayBench
from webviz.shell.testing.messages import header
from webviz_displays.robot_model.parts import LinkSettings

SECOND = 1_000_000_000


def scans(bench: DisplayBench) -> None:
    """Two scans of a tilted laser that moves while it turns."""
    tilt = (0.5, 0.5, 0.5, 0.5)  # x points along y, y along z
    for i in range(10):
        stamp_ns = bench.now_ns + i * SECOND // 10
        bench.transform("map", "laser", (0.3 * i, 0.0, 0.1 * i), tilt, stamp_ns=stamp_ns)
    for _ in range(2):
        values = {
            "angle_increment": 0.7,
            "time_increment": 0.125,
            "range_max": 10.0,
            "ranges": [1.0, 2.5, 2.0, 4.0, 1.5],
            "intensities": [100.0, 900.0, 30.0, 4000.0, 5000.0],
        }
        bench.send("sensor_msgs/msg/LaserScan", values, frame="laser")
        bench.turn()


def clouds(bench: DisplayBench) -> None:
    """Two clouds of many fields and near points, of a tilted sensor."""
    bench.transform("map", "lidar", (1.0, 0.0, 0.5), (0.5, 0.5, 0.5, 0.5))
    points = [(1.0, 0.0, 0.1), (1.1, 0.2, 0.3), (40.0, 4.0, 4.4), (41.0, 4.1, 4.5)]
    extra = {"intensity": [100.0, 900.0, 30.0, 5000.0], "rgb": [1e-38, 2e-38, 3e-38, 4e-38]}
    extra |= {"r": [0.1, 0.2, 0.3, 0.4], "g": [0.5] * 4, "b": [0.6, 0.5, 0.4, 0.3]}
    for _ in range(2):
        bench.send(CLOUD, xyz_cloud(points, extra), frame="lidar")
        bench.turn()


def paths(bench: DisplayBench) -> None:
    for height in (0.0, 1.0):
        poses = [{"pose": {"position": {"x": x, "z": height}}} for x in (0.0, 1.0, 2.0)]
        bench.send("nav_msgs/msg/Path", {"poses": poses}, frame="map")
        bench.turn()


def odometries(bench: DisplayBench) -> None:
    """Small steps and turns; the last pose is uncertain in space."""
    variances = np.diag([0.1, 0.2, 0.3, 0.1, 0.2, 0.3]).ravel()
    for i in range(250):
        turn = {"z": float(np.sin(0.03 * i)), "w": float(np.cos(0.03 * i))}
        pose = {"position": {"x": 0.07 * i}, "orientation": turn}
        values = {"pose": {"pose": pose, "covariance": variances}}
        bench.send("nav_msgs/msg/Odometry", values, frame="map")
    bench.turn()


def robot_frame(bench: DisplayBench) -> None:
    """A frame to refer to, away from the fixed frame."""
    bench.transform("map", "robot", (1.0, 2.0, 0.0))
    bench.turn()


def _detect(bench: DisplayBench) -> None:
    """One detection in an image."""
    box = {"size_x": 1.0, "size_y": 1.0}
    result = {"bbox": box, "results": [{"hypothesis": {"class_id": "box", "score": 0.5}}]}
    values = {"detections": [result]}
    bench.send("vision_msgs/msg/Detection2DArray", values, frame="camera", topic="/found")


def images(bench: DisplayBench) -> None:
    """Two depth images of different ranges, and detections on /found."""
    _detect(bench)
    for depths in ([0.3, 0.6], [2.0, 5.0]):
        data = np.array(depths, np.float32).view(np.uint8)
        values = {"width": 2, "height": 1, "encoding": "32FC1", "step": 8, "data": data}
        bench.send("sensor_msgs/msg/Image", values, frame="camera")
        bench.turn()


def image_planes(bench: DisplayBench) -> None:
    """Depth images, more than their range is the median of by default."""
    bench.transform("map", "camera", (1.0, 0.0, 0.0))
    for scale in (0.1, 0.2, 0.4, 0.8, 1.6, 0.2):
        values = photos.raw(scale * photos.room(16, 12)[1], "32FC1")
        bench.send(photos.RAW, values, frame="camera")
        bench.turn()
    bench.settle()


def camera_infos(bench: DisplayBench) -> None:
    """A camera, and its image."""
    bench.transform("map", "camera", (1.0, 0.0, 0.0))
    bench.send(photos.INFO, photos.info(16, 12), frame="camera", topic="/camera/camera_info")
    values = photos.raw(photos.room(16, 12)[0], "rgb8")
    bench.send(photos.RAW, values, frame="camera", topic="/camera/image_raw")
    bench.turn()
    bench.settle()


def cameras(bench: DisplayBench) -> None:
    """Two depth images of different ranges, by a camera with distortion; detections on /found."""
    _detect(bench)
    bench.transform("map", "camera", (1.0, 0.0, 0.0))
    bend = {"distortion_model": "plumb_bob", "d": [-0.1, 0.0, 0.0, 0.0, 0.0]}
    for topic in ("/camera/camera_info", "/info"):
        values = photos.info(16, 12, **bend)
        bench.send(photos.INFO, values, frame="camera", topic=topic)
    for scale in (0.5, 1.0):
        values = photos.raw(scale * photos.room(16, 12)[1], "32FC1")
        bench.send(photos.RAW, values, frame="camera", topic="/camera/image_raw")
        bench.turn()


def depth_clouds(bench: DisplayBench) -> None:
    """Depths with a camera info and a colour image, of a tilted camera."""
    bench.transform("map", "camera", (1.0, 0.0, 0.0), (0.5, 0.5, 0.5, 0.5))
    colors, depths = photos.room(16, 12)
    for topic in ("/camera/depth/camera_info", "/info"):
        bench.send(photos.INFO, photos.info(16, 12), frame="camera", topic=topic)
    for scale in (2.0, 1.0):  # the second hides the first
        values, topic = photos.raw(scale * depths, "32FC1"), "/camera/depth/image_rect_raw"
        bench.send(photos.RAW, values, frame="camera", topic=topic)
        bench.send(photos.RAW, photos.raw(colors, "rgb8"), frame="camera", topic="/color")
        bench.turn(0.1)
        bench.settle()


def frames(bench: DisplayBench) -> None:
    """One frame that stands still and one that moved twice in a short time, 10 s ago."""
    bench.transform("map", "robot", (1.0, 2.0, 0.0))
    for x in (1.0, 2.0):
        bench.transform("robot", "arm", (x, 0.0, 0.0), stamp_ns=bench.now_ns)
        bench.turn(0.05)
    bench.turn(10.0)


def maps(bench: DisplayBench) -> None:
    """A map of all kinds of cells, and an update, in a frame that moved on."""
    for age, x in ((1, 1.0), (0, 2.0)):
        bench.transform("map", "room", (x, 0.0, 0.0), stamp_ns=bench.now_ns - age * SECOND)
    grid = {
        "info": {"resolution": 0.5, "width": 3, "height": 2, "origin": {"orientation": {"w": 1.0}}},
        "data": [0, 30, 60, 98, 100, -1],
    }
    stamp_ns = bench.now_ns - SECOND
    bench.send("nav_msgs/msg/OccupancyGrid", grid, frame="room", stamp_ns=stamp_ns, topic="/map")
    bench.turn()
    update = {"x": 1, "width": 1, "height": 1, "data": [77]}
    type_name, topic = "map_msgs/msg/OccupancyGridUpdate", "/map_updates"
    bench.send(type_name, update, frame="room", stamp_ns=stamp_ns, topic=topic)
    bench.turn()


ROBOT = """
<robot name="one">
  <link name="base">
    <visual><geometry><box size="1 1 1"/></geometry></visual>
    <visual><geometry><mesh filename="package://somewhere/part.stl"/></geometry></visual>
    <collision><geometry><sphere radius="1"/></geometry></collision>
    <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <link name="rider"><visual><geometry><box size="1 1 1"/></geometry></visual></link>
  <joint name="slide" type="prismatic">
    <parent link="base"/><child link="rider"/><limit lower="0" upper="9" effort="1" velocity="1"/>
  </joint>
</robot>
"""


def robots(bench: DisplayBench) -> None:
    bench.transform("map", "base", (1.0, 0.0, 0.0))
    bench.send("std_msgs/msg/String", {"data": ROBOT}, topic="/robot_description")
    state = {"name": ["slide"], "position": [1.5]}
    bench.send("sensor_msgs/msg/JointState", state, topic="/joint_states")
    for place in (1.0, 2.0):
        bench.transform("base", "rider", (place, 0.0, 0.0), stamp_ns=bench.now_ns)
        settle(bench)
        bench.turn(0.1)


def markers(bench: DisplayBench) -> None:
    """Two markers, one alone and one in an array, if the display takes both."""
    for name, topic in (("Marker", ""), ("MarkerArray", "_array")):
        marker = {
            "header": header("map", bench.now_ns),
            "ns": "robot",
            "id": len(topic),
            "type": 1,
            "pose": {"position": {"x": 2.0 * len(topic)}},
            "scale": {"x": 1.0, "y": 1.0, "z": 1.0},
            "color": {"a": 1.0},
        }
        values = {"markers": [marker]} if topic else marker
        topics = {each.name for _, _, each in inputs(bench.display)}
        if f"/visualization_marker{topic}" in topics or "" in topics:
            type_name = f"visualization_msgs/msg/{name}"
            bench.send(type_name, values, topic=f"/visualization_marker{topic}")
    bench.turn()


def interactive_markers(bench: DisplayBench) -> None:
    """A marker with an arrow, if the display has a namespace."""
    bench.transform("map", "robot")
    bench.offer("/arm/update", "visualization_msgs/msg/InteractiveMarkerUpdate")
    control = {"interaction_mode": 3, "name": "along x"}
    marker = {"header": {"frame_id": "robot"}, "description": "Hand", "controls": [control]}
    response = {"markers": [marker]}
    service = "visualization_msgs/srv/GetInteractiveMarkers"
    bench.serve("/arm/get_interactive_markers", service, response)
    for _ in range(3):
        bench.turn(0.1)


def texts(bench: DisplayBench) -> None:
    """Messages with a long array and a number of many digits, some soon after the one before."""
    for number, seconds in enumerate((0.0, 0.07, 0.13, 0.06)):
        bench.turn(seconds)
        values = {"voltage": number + 0.3456789, "cell_voltage": [3.0] * 30}
        bench.send("sensor_msgs/msg/BatteryState", values, frame="robot", topic="/any")
        bench.turn()


OTHER_LINKS = [
    {"base": LinkSettings(enabled=False)},
    {"base": LinkSettings(alpha=0.5)},
    {"base": LinkSettings(show_axes=True)},
    {"rider": LinkSettings(show_trail=True)},
]
"""Each differs from no settings of links in one."""
