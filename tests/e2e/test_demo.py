"""The whole path: the simulator, DDS, the viewer and a browser."""

from __future__ import annotations

import math
import re
import signal
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
import playwright.sync_api as playwright
import pytest
from displays_panel import GLOBAL_OPTIONS, DisplaysPanel
from pages import let_mouse_in
from program import Program

from webviz.shell.pictures.browser import Page

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install ros-webviz[ros]")

import rclpy
import rclpy.executors
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.context import Context
from rclpy.node import Node

# Seen from straight above, with colours that tell the displays apart.
CONFIG = """\
fixed_frame: map
view: {distance: 9.0, yaw: -1.570796, pitch: 1.5697}
displays:
- {type: Map, alpha: 1.0}
- {type: Axes, reference_frame: base_link, length: 0.01, radius: 0.001}
- {type: RobotModel}
- {type: LaserScan, size: 0.04, color_transformer: FlatColor, color: [255, 0, 255]}
"""
PROFILE = """\
<profiles xmlns="http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles">
  <participant profile_name="participant" is_default_profile="true">
    <rtps><builtin><discovery_config>
      <leaseDuration><sec>8</sec></leaseDuration>
      <leaseAnnouncement><sec>2</sec></leaseAnnouncement>
    </discovery_config></builtin></rtps>
  </participant>
</profiles>
"""
"""Profile of Fast DDS: others take a participant for dead after 8 s instead of 20 s."""
SPEED, SECONDS = 0.4, 2.5


@dataclass
class PictureContent:
    """Positions seen in a picture, in metres of the fixed frame."""

    robot: np.ndarray
    """Centre of the robot (2,), NaN if there is none."""
    scan: np.ndarray
    """Points of the scan (N, 2)."""
    walls: np.ndarray
    """Black cells of the map (N, 2)."""


def look(page: Page) -> PictureContent:
    """Find the displays in a picture by their colours."""
    page.draw()
    pixels = page.pixels().astype(int)
    columns_rows = np.array([page.pixel_of(0, 0), page.pixel_of(1, 0), page.pixel_of(0, 1)])
    to_metres = np.linalg.inv(np.column_stack([columns_rows[1:] - columns_rows[0]]).T)

    def where(mask: np.ndarray) -> np.ndarray:
        rows, columns = np.nonzero(mask)
        return (np.column_stack([columns, rows]) + 0.5 - columns_rows[0]) @ to_metres.T

    red, green, blue = np.moveaxis(pixels, -1, 0)
    # Wheels and body are grey; the map is white, black and, where nothing is known, greenish.
    is_grey = np.ptp(pixels, axis=-1) < 15
    robot = where(is_grey & (green > 40) & (green < 246))
    return PictureContent(
        robot.mean(axis=0) if len(robot) else np.full(2, math.nan),
        where((red > 230) & (green < 60) & (blue > 230)),
        where((red < 30) & (green < 30) & (blue < 30)),
    )


def share_on_walls(scan: np.ndarray, walls: np.ndarray, reach: float = 0.15) -> float:
    """The share of scan points with a wall within `reach` metres."""
    distances = np.linalg.norm(scan[::5, None] - walls[None, ::3], axis=2)
    return float((distances.min(axis=1) < reach).mean())


@pytest.fixture(scope="module")
def driver(ros_env: dict[str, str]) -> Iterator[Driver]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
        driver = Driver(int(ros_env["ROS_DOMAIN_ID"]))
        yield driver
        driver.close()


class Driver:
    """Drives the robot as a joystick would, and knows where it says it is."""

    def __init__(self, domain: int) -> None:
        self._context = Context()
        rclpy.init(context=self._context, domain_id=domain)
        self._node = Node("driver", context=self._context)
        self._publisher = self._node.create_publisher(Twist, "/cmd_vel", 1)
        self._node.create_subscription(Odometry, "/odom", self._hear, 10)
        self._executor = rclpy.executors.SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self.odometry: np.ndarray | None = None
        self.patience_s = 60.0

    def _hear(self, odometry: Odometry) -> None:
        position = odometry.pose.pose.position
        self.odometry = np.array([position.x, position.y])

    def where(self) -> np.ndarray:
        """Position by odometry, metres."""
        self.odometry = None
        deadline = time.monotonic() + self.patience_s
        while self.odometry is None:
            assert time.monotonic() < deadline, "no /odom"
            self._executor.spin_once(timeout_sec=0.1)
        return self.odometry

    def drive(self, speed: float, seconds: float) -> None:
        """Drive straight on, then stand; again if the simulator had no processor meanwhile."""
        start, rest = self.where(), seconds
        while rest > 0.1 * seconds:
            self._command(speed, rest)
            rest = seconds - float(np.linalg.norm(self.where() - start)) / abs(speed)

    def _command(self, speed: float, seconds: float) -> None:
        twist = Twist()
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            twist.linear.x = speed
            self._publisher.publish(twist)
            self._executor.spin_once(timeout_sec=0.05)
        twist.linear.x = 0.0
        for _ in range(5):
            self._publisher.publish(twist)
            time.sleep(0.1)
        before = self.where()
        while np.linalg.norm((now := self.where()) - before) > 0.001:
            before = now

    def close(self) -> None:
        self._executor.shutdown()
        self._node.destroy_node()
        self._context.try_shutdown()


@pytest.fixture(scope="module")
def simulator(start: Callable[..., Program], tmp_path_factory: pytest.TempPathFactory) -> Program:
    """The robot stands in the corridor until it is commanded; it is soon missed when it dies."""
    profile = tmp_path_factory.mktemp("dds") / "profile.xml"
    profile.write_text(PROFILE)
    pose, env = "start_pose:=[-1.0, 0.0, 0.0]", {"FASTRTPS_DEFAULT_PROFILES_FILE": str(profile)}
    return start("webviz_sim", "--ros-args", "-p", "tour:=false", "-p", pose, env=env)


@pytest.fixture(scope="module")
def page(simulator: Program, view: Callable[..., Page]) -> Page:
    """The simulator from above."""
    return view(CONFIG, resolution=0.7)


def choose_fixed_frame(page: Page, frame: str) -> None:
    side = DisplaysPanel(page)
    side.select(GLOBAL_OPTIONS)
    field = side.field("fixed_frame")
    field.fill(frame)
    field.press("Enter")
    side.wait_for("Fixed Frame: OK")


def settled(page: Page) -> PictureContent:
    """Return the positions in the picture once everything is drawn and the robot stands."""
    before: list[PictureContent] = []

    def at_rest() -> PictureContent | None:
        content = look(page)
        is_complete = len(content.scan) > 50 and len(content.walls) > 500
        stands = bool(before) and np.linalg.norm(content.robot - before.pop().robot) < 0.005
        before.append(content)
        return content if is_complete and stands else None

    resting = page.wait_for(at_rest, "robot, scan and map in the picture", 60)
    assert resting is not None
    return resting


def check_drive_in_map(page: Page, driver: Driver) -> None:
    before, start = settled(page), driver.where()
    driver.drive(SPEED, SECONDS)
    driven = driver.where() - start
    assert np.linalg.norm(driven) == pytest.approx(SPEED * SECONDS, abs=0.15)
    goal = pytest.approx(before.robot + driven, abs=0.06)
    page.wait_for(lambda: look(page).robot == goal, "the robot where it drove")
    after = settled(page)
    assert after.robot - before.robot == pytest.approx(driven, abs=0.06)
    # Walls that were black are black or under points of the scan.
    assert share_on_walls(before.walls, np.vstack([after.walls, after.scan]), 0.06) > 0.95
    for content in (before, after):
        assert share_on_walls(content.scan, content.walls) > 0.9
    # The scan is another one than before: what the robot passed is seen from elsewhere.
    assert share_on_walls(after.scan, before.scan, 0.03) < 0.95


def check_drive_in_base(page: Page, driver: Driver) -> None:
    before, start = settled(page), driver.where()
    driver.drive(-SPEED, SECONDS)
    walls = before.walls + (start - driver.where())
    inside = np.abs(walls).max(axis=1) < 2.5

    def are_where_they_should_be(content: PictureContent) -> bool:
        now = np.vstack([content.walls, content.scan])
        return share_on_walls(walls[inside], now, 0.06) > 0.95

    page.wait_for(lambda: are_where_they_should_be(look(page)), "the map has moved")
    after = settled(page)
    assert after.robot - before.robot == pytest.approx(0, abs=0.03)
    assert are_where_they_should_be(after)
    now = np.vstack([after.walls, after.scan])
    assert share_on_walls(before.walls[inside], now, 0.06) < 0.9
    assert share_on_walls(after.scan, after.walls) > 0.9


def test_robot_and_scan_move_by_the_commanded_amount_and_the_map_stands(
    page: Page, driver: Driver
) -> None:
    check_drive_in_map(page, driver)


def test_seen_from_the_robot_the_map_moves(page: Page, driver: Driver) -> None:
    choose_fixed_frame(page, "base_link")
    check_drive_in_base(page, driver)


def test_a_laser_that_is_moved_on_the_page_alone_is_found_again(page: Page) -> None:
    choose_fixed_frame(page, "map")
    settled(page)
    tab = page.tab
    tab.set_viewport_size({"width": 900, "height": 700})
    let_mouse_in(page)
    tab.get_by_role("tab", name="TF", exact=True).click()
    tab.locator(".wv-frame", has_text="base_scan").dblclick()
    tab.get_by_role("button", name="What if…").click()
    card = tab.get_by_role("region", name="What if")

    def fit() -> int:
        match = re.search(r"(\d+)% of \d+ points on walls of /map", card.inner_text())
        return int(match[1]) if match else -1

    page.wait_for(lambda: fit() > 90, "the fit of the scan", 60)

    def on_screen(y: float) -> list[float]:
        page.draw()
        return page.evaluate(
            """async (point) => {
              const { frameNode, projectionOf } = await import("webviz/scene/projection.js");
              const { all } = await import("webviz/features/handles/registry.js");
              const [handle] = all().values();
              return projectionOf(frameNode(handle.frame)).project(point);
            }""",
            [0.05, y, 0.2],
        )

    page.wait_for(lambda: on_screen(0.65) == pytest.approx(on_screen(0.65), abs=0.5), "the view")
    start, end = on_screen(0.65), on_screen(1.15)  # an arrow, and a place across the corridor
    tab.mouse.move(*start)
    page.draw()
    tab.mouse.down()
    tab.mouse.move(*end, steps=6)
    page.wait_for(lambda: 0 <= fit() < 90, "a worse fit while it is dragged", 60)
    tab.mouse.up()
    card.get_by_role("button", name="Find it").click()
    page.wait_for(lambda: fit() > 90, "the place that fits", 60)
    assert "--frame-id base_link --child-frame-id base_scan" in card.inner_text()
    tab.keyboard.press("Escape")
    playwright.expect(card).to_be_hidden()
    tab.get_by_role("tab", name="Displays", exact=True).click()


def test_a_dead_scan_publisher_fails_the_check_and_is_shown_on_the_page(
    page: Page, simulator: Program, driver: Driver
) -> None:
    choose_fixed_frame(page, "map")
    settled(page)
    side = DisplaysPanel(page)
    side.select("LaserScan")
    side.wait_for("from /sim (best effort, volatile)")
    simulator.end(signal.SIGKILL)
    side.wait_for("No publisher on /scan any more")
    driver.patience_s = 2.0
    with pytest.raises(AssertionError, match="no /odom"):
        check_drive_in_map(page, driver)
