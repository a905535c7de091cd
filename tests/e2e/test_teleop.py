"""Driving with real keys in a real browser, heard by another node over DDS."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import playwright.sync_api as playwright
import pytest
from pages import COARSE, open_pages
from processes import command_lines, send
from program import Program
from waiting import until
from websockets.asyncio.server import ServerConnection

pytest.importorskip("rclpy", reason="needs rclpy")

import rclpy
from geometry_msgs.msg import Twist
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor

import webviz
from webviz.commands import AddDisplay
from webviz.engine.driving.velocity_controller import TAIL
from webviz.files.config import Config
from webviz.files.opening import parse
from webviz.server.channel.channel import Channel
from webviz.shell.pictures.browser import FLAGS, Page, executable_of

PATIENCE_S = 60.0
FULL = 0.5
"""The highest speed of the tool in m/s."""


class VelocityListener:
    """Hears /cmd_vel in a thread of its own."""

    def __init__(self) -> None:
        self.commands: list[tuple[float, Twist]] = []
        """Each command and when it came."""
        self._context = Context()
        rclpy.init(context=self._context)
        self._node = rclpy.create_node("robot", context=self._context)
        self._node.create_subscription(Twist, "/cmd_vel", self._hear, 100)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._thread = threading.Thread(target=self._executor.spin)
        self._thread.start()

    def _hear(self, twist: Twist) -> None:
        self.commands.append((time.monotonic(), twist))

    def close(self) -> None:
        self._executor.shutdown()
        self._thread.join()
        self._node.destroy_node()
        self._context.try_shutdown()

    def publishers(self) -> int:
        return self._node.count_publishers("/cmd_vel")

    def speeds(self) -> list[float]:
        return [twist.linear.x for _, twist in self.commands]

    def has_stopped(self) -> bool:
        """Return whether a drive ended with a zero; of several, waiting ones make way in turn."""
        return any(self.speeds()) and self.speeds()[-1] == 0.0


@pytest.fixture(scope="module")
def robot(ros_env: dict[str, str]) -> Iterator[VelocityListener]:
    robot = VelocityListener()
    yield robot
    robot.close()


@pytest.fixture(autouse=True)
def nothing_heard(robot: VelocityListener) -> None:
    robot.commands.clear()


def empty(*_: object) -> Config:
    return parse("displays: []\n", "x.yaml")


@pytest.fixture(scope="module")
def channels() -> Iterator[list[ServerConnection]]:
    """The connections over which pages drive."""
    channels: list[ServerConnection] = []
    serve = Channel.serve

    def noting(channel: Channel, connection: Any, *args: Any) -> Any:
        channels.append(connection)
        return serve(channel, connection, *args)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Channel, "serve", noting)
        yield channels


@pytest.fixture(scope="module")
def viewer(robot: VelocityListener, channels: list[ServerConnection]) -> Iterator[webviz.Viewer]:
    with webviz.Viewer(port=0, read=empty) as viewer:
        yield viewer


@pytest.fixture(scope="module")
def pages(browser: playwright.Browser, viewer: webviz.Viewer) -> Iterator[list[Page]]:
    with open_pages(browser, viewer.url, 700, 500) as open_tabs:
        yield open_tabs


@pytest.fixture
def page(pages: list[Page], robot: VelocityListener) -> Iterator[Page]:
    """A page that may drive, and nobody else."""
    choose(pages[0], robot)
    yield pages[0]
    for each in pages:
        each.tab.keyboard.up("w")
        each.tab.keyboard.press("Escape")


def choose(page: Page, robot: VelocityListener) -> None:
    """Select the tool, and wait until nobody drives."""
    page.wait_for(lambda: page.tab.get_by_role("button", name="Teleop").count() == 1, "the tool")
    if page.tab.locator(".wv-teleop").count() == 0:
        page.tab.keyboard.press("t")
    page.wait_for(lambda: page.evaluate(DRIVER_OF) == [True, None], "nobody drives", PATIENCE_S)
    page.wait_for(lambda: robot.publishers() > 0, "the publisher", PATIENCE_S)


DRIVER_OF = """async () => {
  const { state } = await import("webviz/features/driving/teleop.js");
  return [state()?.beat > 0, state()?.driver];
}"""


def hold(page: Page, robot: VelocityListener) -> None:
    """Hold a key until the robot is at full speed."""
    page.tab.keyboard.down("w")
    page.wait_for(lambda: robot.speeds()[-1:] == [FULL], "full speed", PATIENCE_S)


def wait_until_stopped(page: Page, robot: VelocityListener) -> None:
    page.wait_for(robot.has_stopped, "zeros", PATIENCE_S)


@contextmanager
def blocked(viewer: webviz.Viewer) -> Iterator[None]:
    """The frame loop stands still during the block."""
    begun, done = threading.Event(), threading.Event()

    def wait(_: str) -> None:
        begun.set()
        done.wait(PATIENCE_S)

    adding = threading.Thread(target=viewer.do, args=(AddDisplay("Axes", {}, "", wait),))
    adding.start()
    assert begun.wait(PATIENCE_S)
    yield
    done.set()
    adding.join()


def test_a_held_key_drives_and_letting_go_ends_in_silence_while_the_frame_loop_stands_still(
    page: Page, robot: VelocityListener, viewer: webviz.Viewer
) -> None:
    with blocked(viewer):
        pressed = time.monotonic()
        hold(page, robot)
        page.tab.keyboard.up("w")
        wait_until_stopped(page, robot)
        until(lambda: robot.speeds()[-TAIL:] == [0.0] * TAIL)
        page.tab.wait_for_timeout(100)
        speeds = robot.speeds()
        # 1 m/s² from the first step of 50 ms on; a busy machine leaves out commands.
        assert all(twist.linear.x <= at - pressed + 0.05 for at, twist in robot.commands)
        page.tab.wait_for_timeout(300)
        assert robot.speeds() == speeds
        assert {(twist.linear.y, twist.angular.z) for _, twist in robot.commands} == {(0.0, 0.0)}


def cut(page: Page, channels: list[ServerConnection]) -> None:
    for each in channels:
        each.loop.call_soon_threadsafe(each.transport.abort)


@contextmanager
def stalled(channels: list[ServerConnection]) -> Iterator[None]:
    """No page receives anything during the block, as behind a full buffer."""
    for each in channels:
        each.loop.call_soon_threadsafe(each.pause_writing)
    yield
    for each in channels:
        each.loop.call_soon_threadsafe(each.resume_writing)


def freeze(page: Page, channels: list[ServerConnection]) -> Callable[[], object]:
    session = page.tab.context.new_cdp_session(page.tab)
    session.send("Debugger.enable")
    session.send("Debugger.pause")
    return lambda: session.send("Debugger.disable")


def hide(page: Page, channels: list[ServerConnection]) -> None:
    page.evaluate("""() => {
      Object.defineProperty(document, "hidden", { get: () => true, configurable: true });
      document.dispatchEvent(new Event("visibilitychange"));
      delete document.hidden;
    }""")


def blur(page: Page, channels: list[ServerConnection]) -> None:
    page.evaluate("() => window.dispatchEvent(new Event('blur'))")


def leave(page: Page, channels: list[ServerConnection]) -> None:
    page.tab.keyboard.press("Escape")


@pytest.mark.parametrize("cause", [cut, freeze, hide, blur, leave])
def test_the_robot_stops_although_the_key_is_still_held(
    page: Page,
    robot: VelocityListener,
    viewer: webviz.Viewer,
    channels: list[ServerConnection],
    cause: Callable[[Page, list[ServerConnection]], Callable[[], object] | None],
) -> None:
    hold(page, robot)
    with blocked(viewer):
        end = cause(page, channels)
        page.wait_for(lambda: 0.0 in robot.speeds(), "zero", PATIENCE_S)
        if end is not None:
            end()
    if cause is not freeze:  # a page that goes on sees that the key is held
        wait_until_stopped(page, robot)


def test_the_robot_stops_while_the_page_sends_but_receives_nothing(
    page: Page, robot: VelocityListener, channels: list[ServerConnection]
) -> None:
    hold(page, robot)
    with stalled(channels):
        wait_until_stopped(page, robot)
        note = "The connection to webviz is too slow to drive."
        page.wait_for(lambda: note in page.tab.locator(".wv-teleop").inner_text(), "a reason")
        assert robot.has_stopped()
    page.wait_for(lambda: robot.speeds()[-1:] == [FULL], "full speed", PATIENCE_S)


def test_the_first_of_two_drivers_keeps_control_and_the_second_sees_its_number(
    page: Page, pages: list[Page], robot: VelocityListener
) -> None:
    other = pages[1]
    choose(other, robot)
    hold(page, robot)
    number = page.evaluate("() => window.webviz.browser")
    other.tab.keyboard.down("s")
    other.wait_for(
        lambda: f"Browser {number} is driving." in other.tab.locator(".wv-teleop").inner_text(),
        "who drives",
    )
    page.tab.keyboard.up("w")
    other.wait_for(lambda: robot.speeds()[-1] == -FULL, "the other one to drive", PATIENCE_S)
    other.tab.keyboard.up("s")
    speeds = robot.speeds()
    assert 0.0 in speeds[: next(i for i, speed in enumerate(speeds) if speed < 0.0)]
    wait_until_stopped(other, robot)


def test_zeros_come_last_after_the_viewer_ends_and_after_a_browser_is_killed(
    start: Callable[..., Program], browser: playwright.Browser, robot: VelocityListener
) -> None:
    """The page of the viewer that ends finds the next one on its port."""
    program = start("webviz", "--port", "0")
    url, kind, before = program.url(), browser.browser_type, {*command_lines()}
    other = kind.launch(executable_path=executable_of(kind), args=[*FLAGS])
    page = Page(other, url, 600, 400, resolution=COARSE)
    choose(page, robot)
    hold(page, robot)
    assert program.end(signal.SIGTERM) == 0
    until(lambda: robot.publishers() == 0)
    assert robot.speeds()[-1] == 0.0
    page.tab.keyboard.up("w")
    robot.commands.clear()
    with webviz.Viewer(port=int(url.rpartition(":")[2]), read=empty):
        choose(page, robot)
        hold(page, robot)
        send(signal.SIGKILL, {*command_lines()} - before)
        until(robot.has_stopped)
