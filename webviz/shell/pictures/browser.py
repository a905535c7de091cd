"""A headless browser and its tabs; the only module that imports playwright."""

from __future__ import annotations

import base64
import contextlib
import functools
import io
import os
import shutil
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, TypeVar

import msgspec
import numpy as np
import PIL.Image
from numpy.typing import NDArray

from webviz.api.errors import Error, UsageError
from webviz.api.nodes import Pane
from webviz.server.images.frames import camera_of, warp_of
from webviz.shell.cli.terminal import say
from webviz.shell.pictures.browser_scripts import (
    CANVAS,
    COUNT_UNPACKING,
    DRAW,
    HOLD,
    OPAQUE,
    PANE,
    PIXEL,
    SETTLE,
    TRANSPARENT,
)

if TYPE_CHECKING:
    import playwright.sync_api as playwright

VARIABLE = "WEBVIZ_BROWSER"
"""Environment variable with the path of the browser to use."""
NAMES = (
    # Made for this: others draw the window of a desktop around each page, though it is not seen.
    "chromium-headless-shell",
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
    "chrome",
)
FLAGS = (
    # WebGL in software, and no background traffic.
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
    # The processor composes the page itself: a graphics card in software would take twice as long.
    "--disable-gpu-compositing",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
)
HOW_TO_GET_ONE = (
    "Install Chromium or Google Chrome (`apt install chromium`), run `playwright install chromium`,"
    f" or set {VARIABLE} to the path of a browser."
)

PATIENCE_S = 60.0
"""Time in seconds for what a page does at once on a machine that does nothing else."""
SHORTEST_PAUSE_S, LONGEST_PAUSE_S = 0.05, 0.25
"""Pauses in seconds between two looks at a page for a state that is waited for."""
SMALLEST, LARGEST = 16, 8192
"""Edges of a picture in pixels; browsers without a GPU cannot draw larger ones."""

Pixels = NDArray[np.uint8]
T = TypeVar("T")


class NoBrowser(Error):
    """No working browser was found; the message says how to get one."""


class BrowserDied(Error):
    """The browser or its tab crashed or was closed."""


def check_size(size: tuple[int, int]) -> None:
    """Raise `UsageError` if a picture would be too small or too large."""
    if not all(SMALLEST <= edge <= LARGEST for edge in size):
        width, height = size
        raise UsageError(
            f"A picture must have {SMALLEST} to {LARGEST} pixels per side, not {width} x {height}."
        )


@contextmanager
def launched() -> Iterator[playwright.Browser]:
    """Provide a headless Chromium or Chrome, closed at the end of the block.

    It must be used in the thread that launches it, which must not run an asyncio loop.

    Raises:
        NoBrowser: playwright or a browser is missing, or the browser does not start.
    """
    try:
        import playwright.sync_api as playwright
    except ImportError:
        raise NoBrowser(
            "playwright is missing. Run `pip install 'ros-webviz[pictures]'`."
        ) from None
    with playwright.sync_playwright() as driver:
        executable = executable_of(driver.chromium)
        try:
            browser = driver.chromium.launch(executable_path=executable, args=list(FLAGS))
        except playwright.Error as error:
            reason = str(error).strip().splitlines()[0]
            raise NoBrowser(f"{executable} does not start ({reason}). {HOW_TO_GET_ONE}") from None
        try:
            yield browser
        finally:
            with contextlib.suppress(playwright.Error):  # it may have crashed
                browser.close()


def executable_of(kind: playwright.BrowserType) -> str:
    """Return the path of the installed browser, or else of playwright's own.

    Raises:
        NoBrowser: there is none.
    """
    chosen = os.environ.get(VARIABLE)
    if chosen:
        path = shutil.which(chosen)
        if path is None:
            raise NoBrowser(f"{VARIABLE} is {chosen!r}, which is not a program. Fix or unset it.")
        return path
    for name in (*NAMES, kind.executable_path):
        if path := shutil.which(name):
            return path
    raise NoBrowser(f"No browser found. {HOW_TO_GET_ONE}")


class Page:
    """A tab that shows a viewer.

    Args:
        browser: in which to open it.
        url: of the viewer.
        width, height: of the whole page in pixels.
        cookie: name and value of the one that lets the browser in, None if none is needed.
        resolution: pixels of the scene per pixel of the page.
    """

    def __init__(
        self,
        browser: playwright.Browser,
        url: str,
        width: int,
        height: int,
        cookie: tuple[str, str] | None = None,
        resolution: float = 1.0,
    ) -> None:
        self.errors: list[str] = []
        """Errors of scripts in the page."""
        self._crashed = False
        self._context = self._alive(
            lambda: browser.new_context(
                viewport=_size(width, height),
                device_scale_factor=1,
                color_scheme="dark",  # as RViz, where nothing else is asked for
                # On this machine, while the certificate names the address for others.
                ignore_https_errors=True,
            )
        )
        self._context.set_default_timeout(1000.0 * PATIENCE_S)
        if cookie is not None:
            name, value = cookie
            self._alive(
                lambda: self._context.add_cookies([{"name": name, "value": value, "url": url}])
            )
        self.tab: playwright.Page = self._alive(self._context.new_page)
        self.tab.on("pageerror", lambda error: self.errors.append(str(error)))
        self.tab.on("crash", lambda _: setattr(self, "_crashed", True))
        self._alive(lambda: self.tab.add_init_script(COUNT_UNPACKING))
        self._alive(lambda: self.tab.goto(f"{url}/?fixedDpr={resolution:g}"))
        self._alive(lambda: self.tab.wait_for_function("window.webviz?.hasView()"))

    def close(self) -> None:
        """Close the tab, if it has not crashed."""
        import playwright.sync_api as playwright

        with contextlib.suppress(playwright.Error):
            self._context.close()

    def resize_picture(self, width: int, height: int) -> None:
        """Resize the page so that the picture next to the panel has a size in pixels."""
        now, (old_width, old_height) = self.tab.viewport_size, self.evaluate(CANVAS)
        assert now is not None, "opened with a viewport"
        size = _size(now["width"] + width - old_width, now["height"] + height - old_height)
        self._alive(lambda: self.tab.set_viewport_size(size))
        self.wait_for(
            lambda: self.evaluate(CANVAS) == [width, height], f"a picture of {width} x {height}"
        )

    def evaluate(self, source: str, argument: Any = None) -> Any:
        """Call a JavaScript function in the page."""
        return self._alive(lambda: self.tab.evaluate(source, argument))

    def wait_for(
        self, condition: Callable[[], T], what: str = "it", seconds: float = PATIENCE_S
    ) -> T:
        """Wait until a condition holds, and return its value.

        Raises:
            TimeoutError: it does not hold within `seconds`.
        """
        start = time.monotonic()
        while (waited := time.monotonic() - start) < seconds:
            if result := condition():
                return result
            # What takes long is looked at less often, which leaves it the processor.
            pause_s = min(max(SHORTEST_PAUSE_S, 0.1 * waited), LONGEST_PAUSE_S)
            self._alive(functools.partial(self.tab.wait_for_timeout, 1000.0 * pause_s))
        raise TimeoutError(f"not within {seconds:g} s: {what}")

    def draw(self, count: int = 3) -> None:
        """Make the page draw some frames."""
        self.evaluate(DRAW, count)

    def hold(self) -> None:
        """Draw only in `pixels` from now on.

        Software rendering takes most of the time of a picture, and viser's page would draw for a
        quarter of a second after each change.
        """
        self.evaluate(HOLD)

    def settle(self, seconds: float = PATIENCE_S) -> None:
        """Wait until the page has decoded everything, and no frame requests another.

        Raises:
            TimeoutError: the page still changes after `seconds`.
        """
        if not self.evaluate(SETTLE, 1000.0 * seconds):
            raise TimeoutError(f"The browser did not finish drawing within {seconds:g} s.")

    def pixels(self, transparent: bool = False) -> Pixels:
        """Return the picture as drawn last, or drawn now after `hold`.

        Args:
            transparent: omit the background.

        Returns:
            uint8 (height, width, 3), or (height, width, 4) with straight alpha.
        """
        url = self.evaluate(TRANSPARENT if transparent else OPAQUE)
        png = base64.b64decode(url.split(",")[1])
        return np.asarray(PIL.Image.open(io.BytesIO(png)).convert("RGBA" if transparent else "RGB"))

    def pane(
        self,
        picture: PIL.Image.Image,
        pane: Pane,
        size: tuple[int, int],
        hidden: Sequence[str],
    ) -> PIL.Image.Image:
        """Return the picture of a pane with the scene over and under it, and with its marks.

        Args:
            picture: as the camera took it.
            pane: that it belongs to.
            size: width and height of the result in pixels.
            hidden: ids of displays to leave out.
        """
        file = io.BytesIO()
        picture.save(file, "PNG")
        url = f"data:image/png;base64,{base64.b64encode(file.getvalue()).decode()}"
        camera = pane.camera
        how = camera and camera_of(camera), camera and warp_of(camera.warp)
        arguments = msgspec.to_builtins([*size, *how, [*hidden], pane.marks, url])
        png = base64.b64decode(self.evaluate(PANE, arguments).split(",")[1])
        return PIL.Image.open(io.BytesIO(png)).convert("RGB")

    def pixel_of(self, x: float, y: float, z: float = 0.0) -> tuple[float, float]:
        """Column and row of a point of the fixed frame."""
        return tuple(self.evaluate(PIXEL, [x, y, z]))

    def text(self) -> str:
        """Return the visible text of the page."""
        return self._alive(lambda: self.tab.inner_text("body"))

    def _alive(self, call: Callable[[], T]) -> T:
        """Call a method of the tab, and distinguish its errors from a crash."""
        import playwright.sync_api as playwright

        try:
            return call()
        except playwright.Error as error:
            # playwright has one class for closed and crashed tabs and for errors in scripts.
            if self._crashed or "closed" in error.message or "crashed" in error.message:
                raise BrowserDied(
                    "The browser crashed while drawing, perhaps for lack of memory. Try again, or "
                    "make a smaller picture."
                ) from None
            raise


def _size(width: int, height: int) -> playwright.ViewportSize:
    return {"width": width, "height": height}


if __name__ == "__main__":  # the last step of `make install`
    try:
        with launched():
            pass
    except NoBrowser as error:
        say(f"webviz is ready, but cannot make pictures yet. {error}")
