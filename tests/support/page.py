"""A tab of a real browser with a viewer in it."""

from __future__ import annotations

import base64
import io
import shutil
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import PIL.Image
import playwright.sync_api as playwright
import pytest
from numpy.typing import NDArray

BROWSERS = ("chromium", "chromium-browser", "google-chrome")
FLAGS = (
    # WebGL in software, and none of the traffic that a fresh Chromium starts by itself.
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
)

Pixels = NDArray[np.uint8]


@contextmanager
def launched() -> Iterator[playwright.Browser]:
    """A headless Chromium; the test is skipped where there is none."""
    executable = next(filter(None, map(shutil.which, BROWSERS)), None)
    if executable is None:
        pytest.skip(f"no browser: none of {', '.join(BROWSERS)} is on PATH")
    with playwright.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=executable, args=list(FLAGS))
        yield browser
        browser.close()


class Page:
    """One tab.

    Args:
        browser: where to open it.
        url: of the viewer.
        width, height: of the whole page in pixels.
    """

    def __init__(self, browser: playwright.Browser, url: str, width: int, height: int) -> None:
        self.errors: list[str] = []
        self._context = browser.new_context(viewport={"width": width, "height": height})
        self.tab = self._context.new_page()
        self.tab.on("pageerror", lambda error: self.errors.append(str(error)))
        self.tab.goto(f"{url}/?fixedDpr=1")
        self.tab.wait_for_function("window.__viserMutable?.scene?.webviz", timeout=60_000)

    def close(self) -> None:
        """Close the tab."""
        self._context.close()

    def evaluate(self, source: str, argument: Any = None) -> Any:
        """Call a JavaScript function in the page."""
        return self.tab.evaluate(source, argument)

    def wait_for(
        self, condition: Callable[[], Any], what: str = "it", seconds: float = 30.0
    ) -> Any:
        """Wait until a condition holds while the page runs, and return it."""
        deadline = time.monotonic() + seconds
        while time.monotonic() < deadline:
            if result := condition():
                return result
            self.tab.wait_for_timeout(50)
        raise AssertionError(f"not within {seconds} s: {what}")

    def draw(self, count: int = 3) -> None:
        """Let the page draw some frames."""
        self.evaluate(
            """async (count) => {
              for (let i = 0; i < count; i++) {
                window.__viserMutable.requestRender();
                await new Promise(requestAnimationFrame);
              }
            }""",
            count,
        )

    def pixels(self) -> Pixels:
        """The scene as drawn last: uint8 (height, width, 3)."""
        url = self.evaluate("() => window.__viserMutable.canvas.toDataURL('image/png')")
        png = base64.b64decode(url.split(",")[1])
        return np.asarray(PIL.Image.open(io.BytesIO(png)).convert("RGB"))

    def pixel_of(self, x: float, y: float, z: float = 0.0) -> tuple[float, float]:
        """Column and row at which a point of the fixed frame is drawn."""
        return tuple(
            self.evaluate(
                """(point) => {
                  const {camera, canvas, nodeRefFromName} = window.__viserMutable;
                  const root = nodeRefFromName["/webviz"];
                  root.updateWorldMatrix(true, false);
                  camera.updateMatrixWorld();
                  const p = root.position.clone().set(...point).applyMatrix4(root.matrixWorld);
                  p.project(camera);
                  return [(p.x + 1) / 2 * canvas.width, (1 - p.y) / 2 * canvas.height];
                }""",
                [x, y, z],
            )
        )

    def text(self) -> str:
        """All text of the page that can be seen."""
        return self.tab.inner_text("body")
