"""Makes the picture of the README anew: `python tests/support/demo_picture.py`."""

from __future__ import annotations

import io
import os
import random
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import PIL.Image
from program import Program

from webviz.shell.pictures.browser import Page, launched

PATH = Path(__file__).parents[1] / "pictures/demo.webp"
WIDTH, HEIGHT = 1280, 800
SIZE = 960, 600
FRAMES, INTERVAL_S, SHOWN_MS = 60, 0.5, 120
"""The picture plays about four times as fast as the robot drives."""
QUALITY = 60

NO_RATES = ".wv-rates { visibility: hidden }"
"""Style that hides rates, as those of a browser without a graphics card say nothing."""
TROUBLED = "[role=treeitem]:is([data-level=warn], [data-level=error])"
GOAL = (700, 590), (760, 560)
"""Points at which the mouse presses and releases, in the big room in front."""


def main() -> int:
    """Start the demo, record it, and end it."""
    domain = str(random.SystemRandom().randrange(160, 220))
    env = {**os.environ, "ROS_DOMAIN_ID": domain, "PYTHONUNBUFFERED": "1"}
    with tempfile.TemporaryDirectory() as folder, launched() as browser:
        arguments = [sys.executable, "-m", "webviz", "demo", "--port", "0", "--no-autosave"]
        program = Program(arguments, env, Path(folder) / "output.txt")
        try:
            page = Page(browser, program.url(), WIDTH, HEIGHT)
            save(record(page, FRAMES, INTERVAL_S), PATH)
            page.close()
        finally:
            program.end()
    return 0


def record(page: Page, frames: int, interval_s: float) -> list[PIL.Image.Image]:
    """Pictures of a page of the demo, while the robot drives its tour and then to a goal."""
    tab = page.tab
    tab.emulate_media(color_scheme="dark")
    tab.add_style_tag(content=NO_RATES)
    tab.locator(TROUBLED).first.wait_for(state="detached")
    (x, y), (to_x, to_y) = GOAL
    gestures: dict[int, Callable[[], None]] = {
        frames // 4: lambda: (tab.keyboard.press("g"), tab.mouse.move(x, y), tab.mouse.down())[-1],
        frames // 4 + 1: lambda: tab.mouse.move((x + to_x) / 2, (y + to_y) / 2),
        frames // 4 + 2: lambda: tab.mouse.move(to_x, to_y),
        frames // 4 + 4: tab.mouse.up,
    }
    pictures = []
    for number in range(frames):
        due = time.monotonic() + interval_s
        gestures.get(number, lambda: None)()
        pictures.append(PIL.Image.open(io.BytesIO(tab.screenshot())).convert("RGB"))
        tab.wait_for_timeout(max(0.0, 1000.0 * (due - time.monotonic())))
    return pictures


def save(pictures: list[PIL.Image.Image], path: Path) -> None:
    """Write an animation that repeats."""
    small = [picture.resize(SIZE, PIL.Image.Resampling.LANCZOS) for picture in pictures]
    small[0].save(
        path,
        save_all=True,
        append_images=small[1:],
        duration=SHOWN_MS,
        loop=0,
        quality=QUALITY,
        method=6,
    )


if __name__ == "__main__":
    sys.exit(main())
