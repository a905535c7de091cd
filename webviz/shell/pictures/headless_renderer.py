"""A scene that a headless browser draws."""

from __future__ import annotations

import contextlib
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from webviz.api import pictures
from webviz.api.decoded import opened
from webviz.api.nodes import Rgb
from webviz.api.views import View
from webviz.engine.pipeline.browsers import NoBrowsers
from webviz.scene import ViserScene, open_server
from webviz.scene.schemes import BACKGROUND
from webviz.shell.pictures.browser import Page, Pixels
from webviz.shell.pictures.dock import with_panes

if TYPE_CHECKING:
    import playwright.sync_api as playwright

PATIENCE_S = 60.0
"""A browser without a GPU needs seconds for the meshes of some robots."""


class RenderedScene(ViserScene):
    """A scene that is updated only while a picture is wanted."""

    is_watched = True
    """True if the page counts as a browser; without one, viewers draw nothing."""

    def has_watchers(self) -> bool:
        """Return whether the scene has to be updated."""
        return self.is_watched and super().has_watchers()

    def is_unseen(self, display: str) -> bool:
        """Return False: its page has no panes, which pictures have nevertheless."""
        return False


class HeadlessRenderer:
    """Makes pictures of `scene`, which may be filled by any code.

    Opening takes seconds, so reuse it for many pictures. All methods belong to the thread that
    launched the browser.

    Args:
        browser: from `webviz.shell.pictures.browser.launched`.
        width, height: of pictures in pixels.
        background: colour of the background.
    """

    def __init__(
        self, browser: playwright.Browser, width: int, height: int, background: Rgb = BACKGROUND
    ) -> None:
        with contextlib.ExitStack() as stack:
            self.server = open_server(port=0)
            stack.callback(self.server.stop)
            self.scene = RenderedScene(self.server)
            self.scene.browsers = NoBrowsers()  # it has no user, and needs no graphics card
            self.scene.set_background(background)
            self.page = Page(browser, f"http://127.0.0.1:{self.server.get_port()}", width, height)
            stack.callback(self.page.close)
            self.page.wait_for(self.server.get_clients, "the page is connected")
            self.page.hold()
            self.capture()  # the first picture of a tab is smoothed differently
            self._stack = stack.pop_all()

    def close(self) -> None:
        """Close the tab and stop the server."""
        self._stack.close()

    def look(self, view: View) -> None:
        """Show a view."""
        self.scene.cameras.start_with(view)  # in case the page reconnects
        self.scene.cameras.show(view)

    def resize(self, width: int, height: int) -> None:
        """Change the size of pictures, in pixels."""
        self.page.resize_picture(width, height)

    def clear(self) -> None:
        """Remove everything from the scene."""
        self.scene.clear()
        self.scene.flush()

    def settle(self) -> None:
        """Wait until the browser has applied, decoded and drawn everything that was flushed.

        Raises:
            TimeoutError: it takes longer than a minute.
            BrowserDied: the browser crashed.
        """
        self.scene.acknowledge(PATIENCE_S)
        self.page.settle(PATIENCE_S)

    def image(self) -> Pixels | None:
        """Return the picture of a pane at its own size, uint8 (H, W, 3).

        None without a still one.
        """
        for pane in self.scene.link.pictures.panes().values():
            if isinstance(pane.picture, pictures.Pixels | pictures.Encoded):
                return np.asarray(opened(pane.picture).convert("RGB"))
        return None

    def capture(
        self, transparent: bool = False, hidden: Mapping[str, Sequence[str]] = MappingProxyType({})
    ) -> Pixels:
        """Return the picture of everything that was flushed.

        Args:
            transparent: omit the background.
            hidden: ids of the displays that a pane leaves out, by its display.

        Returns:
            uint8 (height, width, 3), or (height, width, 4) with straight alpha if transparent.

        Raises:
            TimeoutError, BrowserDied: as `settle`.
        """
        self.settle()
        whole = self.page.pixels(transparent)
        return with_panes(self.page, whole, self.scene.link.pictures.panes(), hidden)
