"""Pictures of a viewer at work, by a headless browser that joins its page for a moment."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

from webviz.api.errors import Error
from webviz.api.views import View
from webviz.edges.scene import Scene
from webviz.engine.state import State
from webviz.shell.pictures.browser import BrowserDied, NoBrowser, Page, Pixels, launched
from webviz.shell.pictures.offline_viewer import LOADING
from webviz.shell.pictures.sizes import check_size

PATIENCE_S = 60.0
"""A browser without a GPU needs seconds for the meshes of some robots."""


class Snapshots:
    """Takes pictures one at a time, each by a browser of its own.

    Args:
        scene: of the viewer.
        draw: brings the scene up to date, once the browser looks, and tells of it; from any thread.
        look: puts the camera of a browser where a view says; from any thread.
    """

    def __init__(
        self, scene: Scene, draw: Callable[[], State], look: Callable[[View, int], None]
    ) -> None:
        self._scene = scene
        self._draw = draw
        self._look = look
        # playwright needs a thread without an event loop, which a notebook has in its own.
        self._pool = ThreadPoolExecutor(1, thread_name_prefix="webviz-snapshot")

    def take(self, url: str, size: tuple[int, int], view: View | None = None) -> Pixels:
        """What a browser that joins now shows.

        Args:
            url: of the page.
            size: width and height in pixels.
            view: instead of the one that browsers begin with.

        Returns:
            uint8 (height, width, 3).

        Raises:
            Error: there is no browser, or it does not come to an end; one sentence.
        """
        return self._pool.submit(self._take, url, size, view).result()

    def close(self) -> None:
        """End what is under way."""
        self._pool.shutdown(cancel_futures=True)

    def _take(self, url: str, size: tuple[int, int], view: View | None) -> Pixels:
        check_size(size)
        try:
            with launched() as browser, contextlib.closing(Page(browser, url, *size)) as page:
                self._fit(page, size)
                page.pixels()  # the first picture of a tab has another smoothing
                client = page.evaluate(_BROWSER)
                if view is not None:
                    self._look(view, client)
                page.wait_for(self._is_loaded, "all is loaded", PATIENCE_S)
                self._scene.link.acknowledge(PATIENCE_S, client)
                page.settle(PATIENCE_S)
                return page.pixels()
        except (NoBrowser, BrowserDied, TimeoutError) as error:
            raise Error(str(error)) from error

    def _is_loaded(self) -> bool:
        """Whether all is drawn; the meshes of a robot are read when somebody looks."""
        return not any(LOADING in row.statuses for row in self._draw().rows)

    def _fit(self, page: Page, size: tuple[int, int]) -> None:
        """Make the page so large that the picture beside the panel has the size."""
        canvas = page.evaluate(_CANVAS)
        outer = [2 * wanted - now for wanted, now in zip(size, canvas, strict=True)]
        page.resize(*outer)
        page.wait_for(lambda: page.evaluate(_CANVAS) == list(size), f"a picture of {size} pixels")


_CANVAS = """() => {
  const {canvas} = window.__viserMutable;
  return [canvas.width, canvas.height];
}"""

# By which id the scene knows the browser; a page that has a view is connected.
_BROWSER = "() => window.webviz.browser"
