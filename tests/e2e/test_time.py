"""Time over DDS: a /clock awaited, paused and looping; bags without it; clocks that disagree."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator

import numpy as np
import pytest
from displays_panel import GLOBAL_OPTIONS, DisplaysPanel

from webviz.shell.pictures.browser import Page

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install ros-webviz[ros]")

from robot import TF, Robot, transforms

SECOND = 1_000_000_000
CONFIG = """\
fixed_frame: map
view: {distance: 14.0, yaw: -1.570796, pitch: 1.5697}
displays:
- {type: LaserScan, size: 0.5, color_transformer: FlatColor, color: [255, 0, 255]}
- {type: Map, topic: /map, alpha: 1.0}
"""
MAP = {
    "info": {
        "resolution": 1.0,
        "width": 2,
        "height": 2,
        "origin": {"position": {"y": 2.0}, "orientation": {"w": 1.0}},
    },
    "data": [100, 100, 100, 100],
}


@pytest.fixture
def make_robot(ros_env: dict[str, str]) -> Iterator[Callable[..., Robot]]:
    """Make nodes that publish, on the domain of the viewer."""
    robots: list[Robot] = []

    def make(name: str) -> Robot:
        with pytest.MonkeyPatch.context() as patch:
            patch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
            robots.append(Robot(int(ros_env["ROS_DOMAIN_ID"]), name))
        return robots[-1]

    yield make
    for robot in robots:
        robot.close()


@pytest.fixture(scope="module")
def lasting(view: Callable[..., Page]) -> Page:
    """The page of all tests whose viewer goes by the computer's clock."""
    page = view(CONFIG, resolution=0.4)
    DisplaysPanel(page).select(GLOBAL_OPTIONS)
    return page


@pytest.fixture
def page(lasting: Page) -> Page:
    """The page of a viewer that has heard nothing yet."""
    lasting.tab.get_by_role("button", name="Reset", exact=True).click()
    DisplaysPanel(lasting).select(GLOBAL_OPTIONS)
    return lasting


class DrivenBag:
    """A bag played by hand: a robot that drives along x at 1 m/s, seen by a scan and on a map."""

    def __init__(self, robot: Robot, first_s: int, *, with_clock: bool) -> None:
        self._robot = robot
        self._first_s = first_s
        self._with_clock = with_clock
        robot.static("base_link", "laser")
        stamp = {"frame_id": "map", "stamp": {"sec": first_s}}
        robot.publish("/map", "nav_msgs/msg/OccupancyGrid", {"header": stamp, **MAP}, latched=True)

    def play(self, begin_s: float, end_s: float, rate: float = 1.0) -> None:
        """Play from one time to another, counted from its first message."""
        step_s = 0.05
        for k in range(round((end_s - begin_s) / step_s)):
            x = begin_s + k * step_s
            stamp_ns = self._first_s * SECOND + round(x * SECOND)
            if self._with_clock:
                sec, nanosec = divmod(stamp_ns, SECOND)
                clock = {"clock": {"sec": sec, "nanosec": nanosec}}
                self._robot.publish("/clock", "rosgraph_msgs/msg/Clock", clock)
            self._robot.publish("/tf", TF, transforms(("map", "base_link", stamp_ns, x)))
            self._robot.scan("/scan", "laser", stamp_ns)
            time.sleep(step_s / rate)


def scan_at(page: Page) -> float:
    """The x of the robot by the points of its scan in the picture, NaN without one."""
    page.draw()
    red, green, blue = np.moveaxis(page.pixels().astype(int), -1, 0)
    rows, columns = np.nonzero((red > 230) & (green < 60) & (blue > 230))
    if not len(rows):
        return float("nan")
    zero, one = page.pixel_of(0, 0)[0], page.pixel_of(1, 0)[0]
    return float((columns.mean() - zero) / (one - zero)) - 1.0  # each point is 1 m ahead


def has_map(page: Page) -> bool:
    page.draw()
    column, row = page.pixel_of(1.0, 3.0)
    return bool(page.pixels()[int(row), int(column)].max() < 40)


def wait_for(page: Page, *words: str, seconds: float = 60.0) -> None:
    DisplaysPanel(page).wait_for(*words, seconds=seconds)


def test_a_bag_that_loops_without_a_clock_is_reset_by_itself(
    make_robot: Callable[..., Robot], page: Page
) -> None:
    bag = DrivenBag(make_robot("player"), 1_700_000_000, with_clock=False)
    page.wait_for(lambda: has_map(page), "the map")
    bag.play(0.0, 4.0, 2.0)
    page.wait_for(lambda: 3.5 < scan_at(page) < 4.1, "the scan at the end of the bag")
    wait_for(
        page, "the time of this computer, as those of a replayed bag are", "use_sim_time:=true"
    )
    bag.play(0.0, 2.9)
    page.wait_for(lambda: 2.4 < scan_at(page) < 3.0, "the scan of the new loop")
    wait_for(page, "The transforms started over in the past: everything was reset.")
    page.wait_for(lambda: has_map(page), "the latched map again")


def test_a_machine_whose_clock_is_two_seconds_ahead_is_named_until_it_is_set_right(
    make_robot: Callable[..., Robot], page: Page
) -> None:
    robot, camera = make_robot("base"), make_robot("camera")
    robot.links = {("map", "base_link"): 0.0}
    camera.links = {("base_link", "camera"): 2.0}
    wait_for(
        page,
        'The transforms of "camera" are stamped 2.0 s ahead of the clock of this computer, the '
        "others are not. Synchronise the clocks",
    )
    camera.links = {("base_link", "camera"): 0.0}
    page.wait_for(lambda: "synchronise" not in page.text(), "that it clears", 60)


def test_two_static_publishers_of_one_frame_are_reported_with_both_parents_and_their_nodes(
    make_robot: Callable[..., Robot], page: Page
) -> None:
    first, second = make_robot("first"), make_robot("second")
    first.links = {("map", "base_link"): 0.0, ("map", "mast"): 0.0}
    first.static("base_link", "laser")
    second.static("mast", "laser")
    wait_for(page, '"laser" has two parents in static transforms', "/tf_static: /first, /second")
    assert '"base_link"' in page.text()
    assert '"mast"' in page.text()
    second.close()
    page.wait_for(lambda: "two parents" not in page.text(), "that it clears", 60)


def test_a_static_publisher_that_restarts_with_another_pose_is_followed_without_a_word(
    make_robot: Callable[..., Robot], page: Page
) -> None:
    first = make_robot("mount")
    first.static("map", "laser", 1.0)
    wait_for(page, "Fixed Frame: OK")
    first.close()
    again = make_robot("mount")
    again.static("map", "laser", 2.0)

    def follows() -> bool:
        again.scan("/scan", "laser", time.time_ns())
        return 1.7 < scan_at(page) < 2.3

    page.wait_for(follows, "the scan at the new pose")
    assert "Transforms:" not in page.text()


def test_two_moving_publishers_with_different_parents_are_reported_until_one_stops(
    make_robot: Callable[..., Robot], page: Page
) -> None:
    first, second = make_robot("amcl"), make_robot("slam")
    first.links = {("map", "odom"): 0.0}
    second.links = {("world", "odom"): 0.0}
    wait_for(page, '"odom" changed its parent', '"map" and "world"', "/tf: /amcl, /slam")
    second.links = {}
    page.wait_for(lambda: "changed its parent" not in page.text(), "that it clears", 60)


def test_with_use_sim_time_it_waits_for_the_clock_follows_it_and_shows_each_loop(
    make_robot: Callable[..., Robot], view: Callable[..., Page]
) -> None:
    page = view(CONFIG, "--ros-args", "-p", "use_sim_time:=true", resolution=0.4)
    DisplaysPanel(page).select(GLOBAL_OPTIONS)
    wait_for(page, "Waiting for /clock: use_sim_time is set, but it has no publisher")
    player = make_robot("player")
    bag = DrivenBag(player, 100, with_clock=True)
    bag.play(0.0, 1.0)
    topics = ("/clock", "/tf", "/scan")
    page.wait_for(lambda: all(map(player.node.count_subscribers, topics)), "the viewer listens")
    bag.play(1.0, 3.0)
    page.wait_for(lambda: 2.5 < scan_at(page) < 3.1, "the scan at the end of the bag")
    assert has_map(page)
    assert "Waiting" not in page.text()

    wait_for(page, "Simulated time has stopped at 103.0 s: /player is paused")
    DisplaysPanel(page).select("LaserScan")
    wait_for(page, "Transform OK")
    assert "No message for" not in page.text()
    assert 2.5 < scan_at(page) < 3.1
    assert has_map(page)

    bag.play(0.0, 1.0)  # the bag loops
    page.wait_for(lambda: 0.5 < scan_at(page) < 1.1, "the scan of the new loop")
    wait_for(page, "Transform OK")
    DisplaysPanel(page).select(GLOBAL_OPTIONS)
    wait_for(page, "Time went back by", "s: everything was reset.")
    page.wait_for(lambda: has_map(page), "the latched map again")
