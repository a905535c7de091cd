"""Pictures of a scene as a real browser draws it, compared with pictures a person has looked at."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import PIL.Image
import PIL.ImageFilter
import playwright.sync_api as playwright
from bench import HandFedSource
from page import Page, Pixels
from ros_messages import header, serialized

from webviz.commands import SetFixedFrame, SetProperty
from webviz.config import Config, Settings
from webviz.display import Display
from webviz.scene import Scene, open_server
from webviz.sources import Offer, Publisher, Raw
from webviz.state import State
from webviz.viewer import Viewer
from webviz.views import View

TESTS = Path(__file__).parents[1]
REFERENCES = TESTS / "pictures"
OUTPUT = TESTS / "output"

WIDTH, HEIGHT = 400, 300
COLORS = 256
"""Of a stored picture: few enough for some kilobytes, and no person sees the difference."""

NOTICEABLE = 12
"""Steps of 255 by which a blurred pixel must differ to count."""
TOLERANCE = 0.0015
"""Share of pixels that may differ: edges, which each version of a browser draws a bit otherwise."""
PATIENCE_S = 15.0
"""A browser without a GPU needs seconds for the meshes of some robots."""

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


def turned(roll: float = 0.0, pitch: float = 0.0, yaw: float = 0.0) -> Quaternion:
    """A rotation (x, y, z, w) about the fixed axes x, y, z in this order, in radians."""
    (cr, sr), (cp, sp), (cy, sy) = (
        (math.cos(angle / 2), math.sin(angle / 2)) for angle in (roll, pitch, yaw)
    )
    return (
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )


def share_of_difference(one: Pixels, other: Pixels) -> float:
    """The share of pixels that a person would see differ."""
    return float(_differing(one, other).mean())


def difference_image(one: Pixels, other: Pixels) -> PIL.Image.Image:
    """The first picture, darkened, with red where the other one differs."""
    marked = one // 3
    marked[_differing(one, other)] = (255, 0, 0)
    return PIL.Image.fromarray(marked)


def _differing(one: Pixels, other: Pixels) -> np.ndarray:
    a, b = (
        np.asarray(PIL.Image.fromarray(p).filter(PIL.ImageFilter.BoxBlur(1)), np.int16)
        for p in (one, other)
    )
    return np.abs(a - b).max(axis=2) > NOTICEABLE


def load(name: str) -> Pixels:
    """A reference picture, by its path below `tests/pictures` without suffix."""
    return np.asarray(PIL.Image.open(REFERENCES / f"{name}.png").convert("RGB"))


def store(pixels: Pixels, path: Path) -> None:
    """Write a picture in few bytes."""
    path.parent.mkdir(parents=True, exist_ok=True)
    palette = PIL.Image.Quantize.FASTOCTREE  # of all the truest to rainbows
    image = PIL.Image.fromarray(pixels).quantize(COLORS, palette, dither=PIL.Image.Dither.NONE)
    image.save(path, optimize=True)


class Studio:
    """A server, a scene and a tab of a browser, in which one stage after another is set.

    Args:
        browser: where to open the tab.
        update: make new reference pictures instead of comparing.
    """

    def __init__(self, browser: playwright.Browser, update: bool = False) -> None:
        self.update = update
        self.server = open_server(port=0)
        self.scene = Scene(self.server)
        self.page = Page(browser, f"http://127.0.0.1:{self.server.get_port()}", WIDTH, HEIGHT)
        self.page.wait_for(self.scene.has_watchers, "the browser is connected")
        self.capture()  # the first picture of a tab has another smoothing

    def close(self) -> None:
        self.page.close()
        self.server.stop()

    def look(self, view: View) -> None:
        """Move the camera."""
        pitch = math.cos(view.pitch)
        direction = (math.cos(view.yaw) * pitch, math.sin(view.yaw) * pitch, math.sin(view.pitch))
        position = np.array(view.focal_point) + view.distance * np.array(direction)
        for client in self.server.get_clients().values():
            with client.atomic():
                client.camera.position = position
                client.camera.look_at = view.focal_point

    def capture(self) -> Pixels:
        """What is drawn once the browser has everything that was sent to it."""
        self.scene.link.acknowledge(timeout=30)
        self.page.draw()
        return self.page.pixels()


class Stage:
    """A viewer whose scene is drawn in the studio.

    Args:
        studio: where to draw.
        displays: from the first in the list to the last.
        view: of the camera.
        fixed_frame: frame id that everything is drawn in.
    """

    def __init__(
        self, studio: Studio, *displays: Display, view: View, fixed_frame: str = "map"
    ) -> None:
        self.source = HandFedSource()
        self.clock = 1000.0
        """Seconds, for the ages of messages."""
        self.patience = PATIENCE_S
        self.states: list[State] = []
        self._studio = studio
        config = Config(Settings(fixed_frame=fixed_frame), list(displays))
        self.viewer = Viewer(
            config,
            self.source,
            studio.scene,
            self.states.append,
            strict=True,
            clock=lambda: self.clock,
        )
        studio.look(view)
        self.turn()

    def close(self) -> None:
        """Leave the studio empty."""
        self.viewer._workers.close()
        self._studio.scene.clear()
        self._studio.scene.flush()

    def transform(
        self,
        parent: str,
        child: str,
        xyz: Vector = (0.0, 0.0, 0.0),
        xyzw: Quaternion = (0.0, 0.0, 0.0, 1.0),
        *,
        stamp_ns: int | None = None,
    ) -> None:
        """Publish a transform: static, unless it has a stamp."""
        transform = {
            "translation": dict(zip("xyz", xyz, strict=True)),
            "rotation": dict(zip("xyzw", xyzw, strict=True)),
        }
        stamped = {
            "header": header(parent, stamp_ns or 0),
            "child_frame_id": child,
            "transform": transform,
        }
        topic = "/tf_static" if stamp_ns is None else "/tf"
        self.publish(topic, "tf2_msgs/msg/TFMessage", {"transforms": [stamped]})

    def publish(
        self, topic: str, type_name: str, values: Mapping[str, Any], *, frame: str | None = None
    ) -> None:
        """Publish a message; with a frame it gets a header with the time that it is now."""
        if frame is not None:
            values = {**values, "header": header(frame, self.source.now)}
        self.publish_bytes(topic, type_name, serialized(type_name, values))

    def publish_bytes(self, topic: str, type_name: str, cdr: bytes) -> None:
        """Publish a message as it is in a bag."""
        publisher = Publisher("/test", type_name, "reliable", "volatile")
        self.source.known[topic] = Offer((publisher,), ("reliable", "volatile"))
        self.source.inbox.put(topic, Raw(cdr, self.source.now))

    def set(self, path: str, value: Any, display: int = 1) -> None:
        """Change a property of the first display or another one."""
        self.viewer.enqueue(SetProperty(f"display{display}", path, value))
        self.turn()

    def set_fixed_frame(self, frame: str) -> None:
        """Draw in another frame."""
        self.viewer.enqueue(SetFixedFrame(frame))
        self.turn()

    def turn(self) -> None:
        """One turn of the frame loop."""
        self.viewer.turn()

    def statuses(self, display: int = 1) -> dict[str, tuple[str, str]]:
        """Level and sentence by key of one display, as the panel shows them."""
        self.viewer._next_panel = 0.0
        self.turn()
        row = self.states[-1].rows[display - 1]
        return {key: (status.level.name, status.text) for key, status in row.statuses.items()}

    def settle(self) -> None:
        """Let slow work of the displays finish."""
        deadline = time.monotonic() + 60.0
        count = len(self.viewer.config().displays)
        while any("Loading" in self.statuses(i + 1) for i in range(count)):
            assert time.monotonic() < deadline, "a display still loads"
            time.sleep(0.02)
        self.turn()

    def check(self, name: str) -> None:
        """Compare what is drawn with a reference picture, or make that.

        Args:
            name: path of the picture below `tests/pictures`, without suffix.

        Raises:
            AssertionError: a person would see the difference; the text tells where to look.
        """
        self.settle()
        path = REFERENCES / f"{name}.png"
        if self._studio.update:
            pixels = self.still()
            # What still passes stays as it is: every version of a picture weighs on a clone.
            if not path.exists() or share_of_difference(pixels, load(name)) > TOLERANCE:
                store(pixels, path)
            return
        assert path.exists(), (
            f"there is no tests/pictures/{name}.png: run with --update-pictures, look at it, "
            "and commit it"
        )
        expected = load(name)
        share, actual = self.difference(expected, self.patience)
        if share > TOLERANCE:
            raise AssertionError(_complaint(name, share, actual, expected))

    def difference(self, expected: Pixels, seconds: float = PATIENCE_S) -> tuple[float, Pixels]:
        """How much what is drawn differs at last, and what that is.

        Browsers unpack meshes and pictures beside drawing, so what is not yet right may become so.
        """
        deadline = time.monotonic() + seconds
        while True:
            actual = self._studio.capture()
            share = share_of_difference(actual, expected)
            if share <= TOLERANCE or time.monotonic() > deadline:
                return share, actual
            self._studio.page.tab.wait_for_timeout(50)

    def still(self, seconds: float = 1.5) -> Pixels:
        """What is drawn once nothing has changed for some time."""
        pixels, since = self._studio.capture(), time.monotonic()
        while time.monotonic() - since < seconds:
            self._studio.page.tab.wait_for_timeout(100)
            newer = self._studio.capture()
            if (newer != pixels).any():
                pixels, since = newer, time.monotonic()
        return pixels


def _complaint(name: str, share: float, actual: Pixels, expected: Pixels) -> str:
    path = OUTPUT / f"{name}.png"
    path.parent.mkdir(parents=True, exist_ok=True)
    PIL.Image.fromarray(actual).save(path)
    marked = path.with_suffix(".difference.png")
    difference_image(actual, expected).save(marked)
    shown, where = (p.relative_to(TESTS.parent) for p in (path, marked))
    return (
        f"{100 * share:.2f} % of the picture differ from tests/pictures/{name}.png: look at "
        f"{shown} and {where}. If that is right, run with --update-pictures and look again."
    )
