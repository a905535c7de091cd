"""A scene, a server and a tab of a headless browser that draws it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from webviz.api.nodes import Rgb
from webviz.api.views import View
from webviz.edges.scene import Scene, open_server, set_background
from webviz.edges.scene.server import BACKGROUND
from webviz.shell.pictures.browser import Page, Pixels

if TYPE_CHECKING:
    import playwright.sync_api as playwright

PATIENCE_S = 60.0
"""A browser without a GPU needs seconds for the meshes of some robots."""


class StudioScene(Scene):
    """A scene that is only kept up to date while a picture is wanted."""

    is_watched = True
    """Whether the page counts as a watcher; without one, viewers draw nothing."""

    def has_watchers(self) -> bool:
        """Whether anybody looks."""
        return self.is_watched and super().has_watchers()


class Studio:
    """Draws `scene`, which anybody may fill, as a browser shows it to people.

    It opens in seconds, so use one for many pictures. All methods belong to the thread that
    launched the browser.

    Args:
        browser: from `webviz.shell.pictures.browser.launched`.
        width, height: of pictures in pixels.
        background: what lies behind the scene.
    """

    def __init__(
        self, browser: playwright.Browser, width: int, height: int, background: Rgb = BACKGROUND
    ) -> None:
        self.server = open_server(port=0)
        self._page: Page | None = None
        try:
            self.scene = StudioScene(self.server)
            self.set_background(background)
            self._page = Page(browser, f"http://127.0.0.1:{self.server.get_port()}", width, height)
            self._page.wait_for(self.server.get_clients, "the page is connected")
            self._page.hold()
            self.capture()  # the first picture of a tab has another smoothing
        except BaseException:
            self.close()
            raise

    @property
    def page(self) -> Page:
        """The tab."""
        assert self._page is not None, "the studio is being opened"
        return self._page

    def close(self) -> None:
        """Close the tab and end the server."""
        if self._page is not None:
            self._page.close()
        self.server.stop()

    def look(self, view: View) -> None:
        """Put the camera where a view says."""
        self.scene.cameras.start_with(view)  # for a page that connects again
        self.scene.cameras.show(view)

    def set_background(self, rgb: Rgb) -> None:
        """Change what lies behind the scene."""
        set_background(self.server, rgb)

    def resize(self, width: int, height: int) -> None:
        """Make pictures of another size in pixels."""
        self.page.resize(width, height)
        self.page.wait_for(
            lambda: self.page.evaluate(
                """([width, height]) => {
                  const {canvas} = window.__viserMutable;
                  return canvas.width === width && canvas.height === height;
                }""",
                [width, height],
            ),
            f"the picture has {width} x {height} pixels",
        )

    def clear(self) -> None:
        """Remove everything from the scene."""
        self.scene.clear()
        self.scene.flush()

    def settle(self) -> None:
        """Wait until the browser has applied, unpacked and drawn all that was flushed.

        Raises:
            TimeoutError: it takes longer than a minute.
            BrowserDied: it never will.
        """
        self.scene.acknowledge(PATIENCE_S)
        self.page.settle(PATIENCE_S)

    def capture(self, transparent: bool = False) -> Pixels:
        """What the browser draws once it has everything that was flushed.

        Args:
            transparent: leave the background out.

        Returns:
            uint8 (height, width, 3), or (height, width, 4) if transparent, with alpha that is not
            multiplied into the colours.

        Raises:
            TimeoutError: it takes longer than a minute.
            BrowserDied: the browser ended.
        """
        self.settle()
        return self.page.pixels(transparent)
