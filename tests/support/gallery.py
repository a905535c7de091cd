"""Makes the pictures of the examples anew: `PYTHONPATH=. python tests/support/gallery.py`."""

from __future__ import annotations

import io
import math
import sys
import tempfile
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import PIL.Image
import playwright.sync_api as playwright
from bags import START_NS, Bag, ns
from doc_blocks import ROOT

import webviz
from tests.site.example import drive
from webviz.data.messages import encode, register
from webviz.shell.pictures.browser import Page, launched
from webviz.shell.testing import header
from webviz.shell.testing.remembering_graph import RememberingGraph
from webviz.shell.testing.source import HandFedSource

EXAMPLES = ROOT / "displays/docs/examples"
PICTURES = EXAMPLES / "pictures"
PLUGINS = tuple(
    EXAMPLES / f"{name}.py"
    for name in (
        *("camera_view", "point_2d", "compass", "spawn_turtle", "keep_out"),
        *("quiet_topics", "battery_dial", "speeding"),
    )
)
"""Plugins that show something on the page."""
SIZE, THUMBNAIL, QUALITY = (1100, 680), (468, 362), 70
SCENE: playwright.FloatRect = {"x": 320, "y": 0, "width": 780, "height": 604}
"""Area without panels and timeline."""
PANEL: playwright.FloatRect = {"x": 0, "y": 0, "width": 468, "height": 362}
DRIVE_S, STEP_S = 90.0, 0.05
GROUND = 700, 460
"""The point at which a tool is used, in pixels of the page."""
OUTLINE = [(90 * math.sin(i / 3), 45 * (1 - math.cos(i / 3))) for i in range(17)]
POINT = "rviz_plugin_tutorial_msgs/msg/Point2D"
CONFIG = """\
version: 1
fixed_frame: map
view: {distance: 6, yaw: -1.75, pitch: 0.8, target_frame: base_link}
displays:
- {type: Map, draw_behind: true}
- {type: RobotModel}
- {type: LaserScan, size: 0.07}
- {type: CameraView}
- {type: PointDisplay, style: sphere}
- {type: Compass}
- {type: Odometry, keep: 1, enabled: false}
- {type: Path}
"""


def run() -> Bag:
    """A drive of the simulated robot, with what the examples show besides."""
    bag = drive(DRIVE_S)
    types = {
        "/camera/image_raw": "sensor_msgs/msg/Image",
        "/camera/camera_info": "sensor_msgs/msg/CameraInfo",
        "/point": POINT,
        "/odom": "nav_msgs/msg/Odometry",
        "/battery_state": "sensor_msgs/msg/BatteryState",
    }
    for topic, type_name in types.items():
        bag.add(topic, type_name)
    lens = {"k": [320.0, 0.0, 320.0, 0.0, 320.0, 240.0, 0.0, 0.0, 1.0]}
    size = {"width": 640, "height": 480}
    ahead = {"x": -0.5, "y": 0.5, "z": -0.5, "w": 0.5}
    mounted = {"translation": {"z": 0.3}, "rotation": ahead}
    for at_s in np.arange(0.0, DRIVE_S, 0.2):
        stamp = START_NS + ns(at_s)
        camera = {"header": header("camera", stamp), **size}
        bag.put(at_s, "/camera/image_raw", camera)
        bag.put(at_s, "/camera/camera_info", camera | lens)
        place = header("base_link", stamp)
        frame = {"header": place, "child_frame_id": "camera", "transform": mounted}
        bag.put(at_s, "/tf", {"transforms": [frame]})
        fast = {"twist": {"linear": {"x": 1.8}}}
        bag.put(at_s, "/odom", {"header": header("base_link", stamp), "twist": fast})
        bag.put(at_s, "/battery_state", {"percentage": 0.62 - at_s / 1e3})
        bag.put(at_s, "/point", {"header": place, "x": 1.0, "y": 1.5})
    return bag


@contextmanager
def fed(source: HandFedSource, bag: Bag) -> Iterator[None]:
    """Play a bag into a source during the block."""
    ended = threading.Event()

    def feed() -> None:
        for at_s, topic, values in sorted(bag.messages, key=lambda each: each[0]):
            if (now := START_NS + ns(at_s)) > source.now:
                source.now = now
                if ended.wait(STEP_S):
                    return
            type_name = bag.topics[topic].type
            cdr = values if isinstance(values, bytes) else encode(type_name, values)
            source.put(topic, type_name, cdr)

    thread = threading.Thread(target=feed)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()


def save(tab: playwright.Page, name: str, clip: playwright.FloatRect = SCENE) -> None:
    """Write what the page shows."""
    tab.wait_for_timeout(1000)  # until tooltips and camera rest
    picture = PIL.Image.open(io.BytesIO(tab.screenshot(clip=clip))).convert("RGB")
    small = picture.resize(THUMBNAIL, PIL.Image.Resampling.LANCZOS)
    small.save(PICTURES / f"{name}.webp", quality=QUALITY, method=6)


def main() -> int:
    """Show each example in turn."""
    PICTURES.mkdir(exist_ok=True)
    register(POINT, "std_msgs/Header header\nfloat64 x\nfloat64 y\n")
    graph = RememberingGraph()
    graph.responses["/spawn"] = encode("std_msgs/msg/String", {"data": "turtle2"})  # the same bytes
    source = HandFedSource(graph=graph, now=START_NS - 1)
    with tempfile.TemporaryDirectory() as folder:
        config = Path(folder) / "gallery.yaml"
        config.write_text(CONFIG, encoding="utf-8")
        with (
            webviz.Viewer(config, port=0, source=source, plugins=PLUGINS) as viewer,
            fed(source, run()),
            launched() as browser,
        ):
            page = Page(browser, viewer.url, *SIZE)
            take(page.tab)
            page.close()
    return 0


def take(tab: playwright.Page) -> None:
    """Take all pictures."""
    tab.get_by_role("treeitem", name="CameraView").first.wait_for()
    tab.wait_for_timeout(4000)  # the robot begins to drive
    for name, display in (("camera_view", "CameraView"), ("point_2d", "PointDisplay")):
        tab.get_by_role("treeitem", name=display).first.click()
        save(tab, name)
    tab.get_by_role("treeitem", name="Compass").first.click()
    save(tab, "compass")
    tab.get_by_role("button", name="Spawn Turtle").click()
    tab.mouse.click(*GROUND)
    save(tab, "spawn_turtle")
    tab.get_by_role("button", name="Keep Out").click()
    tab.mouse.move(*GROUND)
    tab.mouse.down()
    for dx, dy in OUTLINE:
        tab.mouse.move(GROUND[0] + dx, GROUND[1] + dy)
    save(tab, "keep_out")
    tab.mouse.up()
    tab.get_by_role("checkbox", name="Show Odometry").check()
    for name, words, text in (
        ("quiet_topics", "Panel: Quiet topics", "no messages"),
        ("battery_dial", "Add panel: Battery", "warns below"),
        ("speeding", "Doctor", "The robot drives at"),
    ):
        tab.keyboard.press("Control+k")
        tab.get_by_role("combobox", name="Command").fill(words)
        tab.keyboard.press("Enter")
        tab.get_by_text(text).first.evaluate("(element) => element.scrollIntoView()")
        save(tab, name, PANEL)


if __name__ == "__main__":
    sys.exit(main())
