"""A static frame that is tried in another pose."""

from __future__ import annotations

import math
import re
from collections.abc import Callable

import building
import pytest
from examining import HERE, display

from webviz.api.errors import Error
from webviz.api.handles import Drag
from webviz.api.nodes import Pose
from webviz.commands import DragHandle, EndTrial, FindFrame, MoveFrame, RemoveDisplay, TryFrame
from webviz.data.rotations import from_rpy, to_rpy, w_first
from webviz.features.what_if import ID, WhatIfFeature, WhatIfStore
from webviz.features.what_if.frame_handle import KEY
from webviz.shell.testing.harness import Harness
from webviz.shell.testing.messages import header
from webviz_displays.laser_scan import LaserScan
from webviz_displays.map import Map

Make = Callable[..., Harness]
WRONG_YAW, WRONG_X = 0.4, 0.3


@pytest.fixture
def robot(webviz_harness: Make) -> Harness:
    """A robot whose transforms say that its laser is turned and ahead of where it is."""
    stage = webviz_harness(LaserScan(name="Scan"), Map(), fixed_frame="map")
    now = stage.source.now
    stage.transform("map", "base_link", (HERE.x, HERE.y, 0.0), stamp_ns=now)
    mount(stage, WRONG_YAW)
    grid = {"header": header("map", now)} | building.grid()
    stage.publish("/map", "nav_msgs/msg/OccupancyGrid", grid)
    scan = {"header": header("laser", now)} | building.scan(HERE)
    stage.publish("/scan", "sensor_msgs/msg/LaserScan", scan)
    stage.turn()
    return stage


def mount(stage: Harness, yaw: float) -> None:
    """Publish where the laser is said to be."""
    w, x, y, z = from_rpy(0.0, 0.0, yaw)
    stage.transform("base_link", "laser", (WRONG_X, 0.0, 0.2), (x, y, z, w))


def share(stage: Harness) -> float:
    """The share of points on walls, as pages see it."""
    stage.clock += 1.1
    stage.turn()
    stage.viewer.snapshot()
    return int(re.findall(r"Scan: (\d+)%", what_if_store(stage).fits[0])[0]) / 100.0


def what_if_store(stage: Harness) -> WhatIfStore:
    """The store of the frame that is tried."""
    store = stage.viewer.get(WhatIfFeature).what_if("")
    assert store is not None
    return store


def mounting(stage: Harness) -> Pose:
    """The tried pose of the laser on the robot."""
    tried = stage.viewer.buffer.lookup("base_link", "laser", 0)
    w, x, y, z = w_first(tried.rotation).tolist()
    return Pose(tried.translation, wxyz=(w, x, y, z))


def drag(stage: Harness, kind: str, pose: Pose | None = None) -> None:
    """Do something with the arrow along x."""
    stage.do(DragHandle(ID, Drag(KEY, 0, kind, pose)))  # pyright: ignore[reportArgumentType]


def pose_of_laser(stage: Harness) -> Pose:
    """The laser in the map."""
    pose = stage.viewer.buffer.lookup("map", "laser", 0)
    return Pose(pose.translation)


def test_a_frame_is_found_and_returns(robot: Harness) -> None:
    robot.do(TryFrame("laser"))
    assert share(robot) < 0.4
    robot.do(FindFrame())
    assert share(robot) > 0.95
    store, tried = what_if_store(robot), mounting(robot)
    assert tried.position == pytest.approx((0.0, 0.0, 0.2), abs=0.03)
    assert to_rpy(tried.wxyz) == pytest.approx((0.0, 0.0, 0.0), abs=0.01)
    x = f"{round(tried.position[0], 4):g}"
    assert store.urdf.startswith(f'<origin xyz="{x} ')
    assert store.command.startswith("ros2 run tf2_ros static_transform_publisher --x ")
    assert store.command.endswith(" --frame-id base_link --child-frame-id laser")
    # The scan may have been compared before the trial, too, which is said then.
    assert re.search(r"points on walls of /map( \(\d+% before\))?$", store.fits[0])
    robot.do(EndTrial())
    assert robot.viewer.get(WhatIfFeature).what_if("") is None
    assert not robot.viewer.snapshot().handles
    assert pose_of_laser(robot).position[0] == pytest.approx(HERE.x + WRONG_X)


def test_a_trial_yaw_shows_the_match_before_and_after(robot: Harness) -> None:
    robot.clock += 1.1
    robot.turn()
    robot.viewer.snapshot()  # compares the scan as it is published
    robot.do(TryFrame("laser", -WRONG_YAW))
    assert to_rpy(mounting(robot).wxyz) == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)
    assert mounting(robot).position == (WRONG_X, 0.0, 0.2)
    share(robot)
    after, before = (int(each) for each in re.findall(r"(\d+)%", what_if_store(robot).fits[0]))
    assert before < 40 < after
    robot.do(EndTrial())
    with pytest.raises(Error, match="not a number"):
        robot.do(TryFrame("laser", math.nan))


def test_dragging_moves_child_frames(robot: Harness) -> None:
    robot.do(TryFrame("laser"))
    ((key, (handle, _)),) = robot.viewer.snapshot().handles.items()
    assert key == (ID, KEY)
    assert (handle.name, handle.frame) == ("laser", "base_link")
    before = share(robot)
    drag(robot, "press")
    drag(robot, "move", Pose((0.0, 0.0, 0.2)))
    assert pose_of_laser(robot).position == pytest.approx((HERE.x, HERE.y, 0.2))
    assert share(robot) > 0.95 > before
    drag(robot, "release")
    assert mounting(robot).position == (0.0, 0.0, 0.2)


def test_numbers_place_the_frame(robot: Harness) -> None:
    with pytest.raises(Error, match="No frame is being tried"):
        robot.do(MoveFrame(0.0, 0.0, 0.2, 0.0, 0.0, 0.0))
    robot.do(TryFrame("laser"))
    assert what_if_store(robot).pose == pytest.approx((WRONG_X, 0.0, 0.2, 0.0, 0.0, WRONG_YAW))
    robot.do(MoveFrame(0.0, 0.0, 0.2, 0.0, 0.0, 0.0))
    assert share(robot) > 0.95
    robot.do(MoveFrame(0.1, 0.2, 0.3, 0.1, -0.2, 3.0))
    assert what_if_store(robot).pose == pytest.approx((0.1, 0.2, 0.3, 0.1, -0.2, 3.0))
    for wrong in (math.nan, math.inf, 1e300):
        with pytest.raises(Error, match="Not moved"):
            robot.do(MoveFrame(wrong, 0.0, 0.0, 0.0, 0.0, 0.0))
    assert what_if_store(robot).pose == pytest.approx((0.1, 0.2, 0.3, 0.1, -0.2, 3.0))


def test_transforms_published_during_a_trial_apply_afterwards(robot: Harness) -> None:
    robot.do(TryFrame("laser"))
    drag(robot, "press")
    drag(robot, "move", Pose((5.0, 0.0, 0.0)))
    mount(robot, math.pi)
    robot.turn()
    assert pose_of_laser(robot).position[0] == pytest.approx(HERE.x + 5.0)
    robot.do(EndTrial())
    turned = robot.viewer.buffer.lookup("map", "laser", 0).rotation
    assert abs(turned[2]) == pytest.approx(1.0)


def test_a_frame_that_begins_to_move_ends_it(robot: Harness) -> None:
    robot.do(TryFrame("laser"))
    robot.transform("base_link", "laser", (1.0, 0.0, 0.0), stamp_ns=robot.source.now)
    robot.turn()
    robot.do(EndTrial())
    assert robot.viewer.get(WhatIfFeature).what_if("") is None
    assert pose_of_laser(robot).position[0] == pytest.approx(HERE.x + 1.0)


def test_refusals(robot: Harness) -> None:
    for frame in ("base_link", "nothing"):
        with pytest.raises(Error, match="does not have a static transform"):
            robot.do(TryFrame(frame))
    with pytest.raises(Error, match="No frame is being tried"):
        robot.do(FindFrame())
    robot.do(RemoveDisplay(display(robot, "Scan")))
    robot.do(TryFrame("laser"))
    with pytest.raises(Error, match="no laser scan of this frame"):
        robot.do(FindFrame())
