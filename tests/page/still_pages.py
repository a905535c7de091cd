"""Pages in which no time passes, for their pictures.

Letters are drawn in the font `FONT`.
"""

from __future__ import annotations

import io
import time
from typing import Any

import numpy as np
import PIL.Image
import pytest

from tests.page.page_bench import PageBench
from tests.page.tabs import ViewerTab
from webviz.shell.pictures.browser import Pixels

FINE: dict[str, Any] = {"timezone_id": "UTC", "locale": "en-US", "smooth": True}
TOLERANCE = 0.0001
"""Share of pixels that may differ: less than the dot of a row that has another colour."""
FONT = "DejaVu Sans"
# The rates of the page, in frames per second, are those of the machine.
STILL = f"""
  * {{ transition: none !important; animation: none !important; caret-color: transparent !important;
    font-family: "{FONT}", sans-serif !important }}
  .wv-rates {{ width: 110px; min-width: 0; height: 28px; visibility: hidden }}
"""
NOW_NS = 1_764_000_000_000_000_000
"""Time of all pictures in ns."""
FREEZE = "window.setTime = (ms) => { Date.now = () => ms }; setTime(1_764_000_000_000)"
HAS_FONT = f"""() => {{
  const pen = document.createElement("canvas").getContext("2d");
  const width = (fallback) => {{
    pen.font = `40px "{FONT}", ${{fallback}}`;
    return pen.measureText("Wide Il1").width;
  }};
  return width("serif") === width("monospace");
}}"""
TIMED = (
    "tests.page.page_bench",
    "webviz.engine.parts.time",
    "webviz.engine.pipeline.input_subscription",
    "webviz.scene.adapter.greeting",
    "webviz.sources.player",
    "webviz.sources.recording.entries_history",
    "webviz.sources.recording.recent",
    "webviz.sources.recording.recorder",
)
"""Modules whose times are in pictures: of messages, of the memory, of recordings and of clocks."""


class StillClock:
    """The clocks of a machine, in the place of the module `time`: a test lets them go on."""

    sleep = staticmethod(time.sleep)

    def __init__(self) -> None:
        self.now_ns = NOW_NS

    def time_ns(self) -> int:
        """Wall time in ns."""
        return self.now_ns

    def time(self) -> float:
        """Wall time in seconds."""
        return self.now_ns / 1e9

    def monotonic_ns(self) -> int:
        """Nanoseconds since the machine was started, a day before `NOW_NS`."""
        return self.now_ns - NOW_NS + 86_400 * 10**9

    def monotonic(self) -> float:
        """Return the same in seconds."""
        return self.monotonic_ns() / 1e9

    def hold(self, patch: pytest.MonkeyPatch) -> None:
        """Have the modules of `TIMED` read this clock."""
        for module in TIMED:
            patch.setattr(f"{module}.time", self)

    def go_on(self, viewer: PageBench, until_ns: int) -> None:
        """Let all clocks go on, with those of a viewer."""
        passed_ns, self.now_ns = until_ns - self.now_ns, until_ns
        viewer.pass_time(passed_ns / 1e9)
        viewer.source.now = until_ns


def capture(tab: ViewerTab) -> Pixels:
    """The page once nothing moves: two equal pictures in a row."""
    before = b""
    for _ in range(40):
        tab.turn()
        now = tab.page.screenshot()
        if now == before:
            with PIL.Image.open(io.BytesIO(now)) as image:
                return np.asarray(image.convert("RGB"))
        before = now
        tab.page.wait_for_timeout(150)
    raise AssertionError("The page does not stand still.")
