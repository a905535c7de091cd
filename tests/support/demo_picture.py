"""Makes the picture of the README anew: `python tests/support/demo_picture.py`."""

from __future__ import annotations

import io
import os
import random
import sys
import tempfile
from pathlib import Path

import numpy as np
import PIL.Image
from program import Program

from webviz.shell.pictures.browser import Page, launched
from webviz.shell.testing.comparing import store

PATH = Path(__file__).parents[1] / "pictures/demo.png"
WIDTH, HEIGHT = 1280, 800
SECONDS = 25.0
"""After these the robot is in the middle of the building, with its trail behind it."""

NO_RATES = ".wv-rates { visibility: hidden }"
"""Those of a browser without a graphics card say nothing."""
TROUBLED = "[role=treeitem]:is([data-level=warn], [data-level=error])"


def main() -> int:
    """Start the demo, look at it, and end it."""
    domain = str(random.SystemRandom().randrange(160, 220))
    env = {**os.environ, "ROS_DOMAIN_ID": domain, "PYTHONUNBUFFERED": "1"}
    with tempfile.TemporaryDirectory() as folder, launched() as browser:
        arguments = [sys.executable, "-m", "webviz", "demo", "--port", "0"]
        program = Program(arguments, env, Path(folder) / "output.txt")
        try:
            page = Page(browser, program.url(), WIDTH, HEIGHT)
            page.tab.emulate_media(color_scheme="dark")
            page.tab.wait_for_timeout(1000.0 * SECONDS)
            page.tab.add_style_tag(content=NO_RATES)
            page.tab.locator(TROUBLED).first.wait_for(state="detached")
            picture = PIL.Image.open(io.BytesIO(page.tab.screenshot()))
            page.close()
        finally:
            program.end()
    store(np.asarray(picture.convert("RGB")), PATH, few_colors=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
