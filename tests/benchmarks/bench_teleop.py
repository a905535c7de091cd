"""From a key press in a browser to the first /cmd_vel at another node over DDS.

webviz takes turns with what a web page usually has: JSON in rosbridge's protocol over a websocket
to a program that publishes it with rclpy. Run it with the number of presses: `bench_teleop.py 100`.
"""

from __future__ import annotations

import os
import random
import statistics
import subprocess
import sys
import threading
import time
from collections.abc import Callable

import playwright.sync_api as playwright
import rclpy
from geometry_msgs.msg import Twist
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor

from webviz.shell.pictures.browser import launched

PRESSES = 50
PATIENCE_S = 60.0
BRIDGE = """
import asyncio, json
import rclpy, rclpy.signals
import websockets.asyncio.server as websocket
from geometry_msgs.msg import Twist

rclpy.init(signal_handler_options=rclpy.signals.SignalHandlerOptions.NO)  # it ends at once
node = rclpy.create_node("bridge")
publisher = node.create_publisher(Twist, "/cmd_vel", 1)

async def serve(connection):
    async for text in connection:
        said, twist = json.loads(text), Twist()
        for part, axes in said["msg"].items():
            for axis, value in axes.items():
                setattr(getattr(twist, part), axis, float(value))
        publisher.publish(twist)

async def main():
    async with websocket.serve(serve, "127.0.0.1", 0) as server:
        port = server.sockets[0].getsockname()[1]
        print(f"http://127.0.0.1:{port}", flush=True)
        await asyncio.Future()

asyncio.run(main())
"""
PLAIN_PAGE = """(url) => {
  const socket = new WebSocket(url.replace("http", "ws"));
  const publish = (x) => socket.send(JSON.stringify(
    {op: "publish", topic: "/cmd_vel", msg: {linear: {x, y: 0, z: 0}, angular: {x: 0, y: 0, z: 0}}},
  ));
  window.addEventListener("keydown", (event) => event.repeat || publish(0.5));
  window.addEventListener("keyup", () => publish(0));
  return new Promise((resolve) => (socket.onopen = resolve));
}"""
NOTE = """() => window.addEventListener("keydown", (event) => {
  if (!event.repeat) window.pressed = performance.timeOrigin + performance.now();
}, true)"""


class Robot:
    """Hears /cmd_vel, and notes when it first moves and when it stands."""

    def __init__(self) -> None:
        self.moved: float | None = None
        self.stands = True
        self._context = Context()
        rclpy.init(context=self._context)
        self._node = rclpy.create_node("robot", context=self._context)
        self._node.create_subscription(Twist, "/cmd_vel", self._hear, 100)
        executor = SingleThreadedExecutor(context=self._context)
        executor.add_node(self._node)
        threading.Thread(target=executor.spin, daemon=True).start()

    def publishers(self) -> int:
        return self._node.count_publishers("/cmd_vel")

    def _hear(self, twist: Twist) -> None:
        self.stands = twist.linear.x == 0.0
        if not self.stands and self.moved is None:
            self.moved = time.time()


def until(page: playwright.Page, condition: Callable[[], object]) -> None:
    """Wait while the page runs."""
    deadline = time.monotonic() + PATIENCE_S
    while not condition():
        if time.monotonic() > deadline:
            raise TimeoutError
        page.wait_for_timeout(5)


def press(page: playwright.Page, robot: Robot) -> float:
    """Milliseconds from a press to the first command that moves the robot."""
    page.bring_to_front()
    page.wait_for_timeout(random.uniform(200.0, 300.0))  # whatever the phase of periods
    robot.moved = None
    page.keyboard.down("w")
    until(page, lambda: robot.moved is not None)
    page.keyboard.up("w")
    until(page, lambda: robot.stands)
    page.wait_for_timeout(300)  # the zeros of the end
    assert robot.moved is not None
    return robot.moved * 1000.0 - page.evaluate("window.pressed")


def main() -> None:
    """Print p50 and p99 of both."""
    presses = int(sys.argv[1]) if len(sys.argv) > 1 else PRESSES
    os.environ |= {
        "ROS_DOMAIN_ID": str(random.randrange(110, 200)),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        "PYTHONUNBUFFERED": "1",
    }
    commands = {
        "webviz": ["-m", "webviz", "--port", "0", "--no-autosave"],
        "JSON bridge": ["-c", BRIDGE],
    }
    programs = {
        name: subprocess.Popen([sys.executable, *command], stdout=subprocess.PIPE, text=True)
        for name, command in commands.items()
    }
    robot = Robot()
    taken: dict[str, list[float]] = {name: [] for name in programs}
    try:
        with launched() as browser:
            pages = {}
            for name, program in programs.items():
                assert program.stdout is not None
                url = program.stdout.readline().replace("webviz: open ", "").split()[0]
                page = pages[name] = browser.new_page(viewport={"width": 700, "height": 500})
                if name == "webviz":
                    page.goto(url)
                    page.get_by_role("button", name="Teleop").click(timeout=60_000)
                else:
                    page.evaluate(PLAIN_PAGE, url)
                page.evaluate(NOTE)
            until(pages["webviz"], lambda: robot.publishers() == len(programs))
            for _ in range(presses):
                for name, page in pages.items():
                    taken[name].append(press(page, robot))
    finally:
        for program in programs.values():
            program.terminate()
            program.wait()
    for name, times in taken.items():
        cuts = statistics.quantiles(times, n=100, method="inclusive")
        print(f"{name:>12}: p50 {cuts[49]:.1f} ms, p99 {cuts[98]:.1f} ms, {len(times)} presses")


if __name__ == "__main__":
    main()
