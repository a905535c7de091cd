"""Pictures of a running viewer, by a headless browser that opens its page."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, Any, Protocol

from webviz.api.errors import Error
from webviz.api.status import LOADING
from webviz.api.views import View
from webviz.commands import Refresh
from webviz.engine.commands import Command
from webviz.engine.parts.visibility import hidden_in
from webviz.engine.state import Row
from webviz.scene import ViserScene
from webviz.shell.pictures.browser import Page, Pixels, check_size, launched
from webviz.shell.pictures.browser_scripts import CANVAS
from webviz.shell.pictures.dock import with_panes

if TYPE_CHECKING:
    import playwright.sync_api as playwright

WHOLE = ".wv-on #root { inset: 0 !important }"
"""Gives the scene the whole page, also what panels and time bar lie over."""
BEHIND = "body > :not(#root) { pointer-events: none !important; opacity: 0 !important }"
"""Lets clicks through to the scene."""
SELECTING_S = 3.0
"""Time for an answer; a click that hits nothing has none."""
PATIENCE_S = 60.0
"""A browser without a GPU needs seconds for the meshes of some robots."""


class DrawnViewer(Protocol):
    """The viewer, from any thread."""

    @property
    def rows(self) -> Sequence[Row]:
        """Its displays."""
        ...

    def do(self, command: Command) -> str:
        """Carry out a command, and draw its effect."""
        ...

    def fact(self, name: str, otherwise: Any = None) -> Any:
        """Return one field of its state."""
        ...


class Snapshots:
    """Takes pictures one after another, with a new browser whenever it is asked.

    Args:
        scene: of the viewer.
        viewer: draws it.
        look: shows a view in a browser; thread-safe.
        cookie: name and value of the one that lets the browser in, None if none is needed.
    """

    def __init__(
        self,
        scene: ViserScene,
        viewer: DrawnViewer,
        look: Callable[[View, int], None],
        cookie: tuple[str, str] | None,
    ) -> None:
        self._scene = scene
        self._viewer = viewer
        self._look = look
        self._cookie = cookie
        # playwright needs a thread without an event loop, unlike that of a notebook.
        self._pool = ThreadPoolExecutor(1, thread_name_prefix="webviz-snapshot")

    def take(self, url: str, size: tuple[int, int], views: Sequence[View | None]) -> list[Pixels]:
        """Return pictures of a new browser.

        Args:
            url: of the page.
            size: width and height in pixels.
            views: of each picture; None for the default view.

        Returns:
            uint8 (height, width, 3) each.

        Raises:
            Error: no browser is installed, or the browser does not finish.
        """
        return self._pool.submit(self._take, url, size, views).result()

    def select(
        self, url: str, size: tuple[int, int], view: View | None, at: tuple[int, int]
    ) -> Mapping[str, Any]:
        """Select what is at a pixel, as a click with the tool Select does.

        Args:
            url: of the page.
            size: width and height of the picture in pixels.
            view: overrides the default view.
            at: the pixel, from the top left.

        Returns:
            What its display says of it, see `Display.inspect`; empty if nothing is there.

        Raises:
            Error: no browser is installed, or the browser does not finish.
        """
        return self._pool.submit(self._select, url, size, view, at).result()

    def close(self) -> None:
        """Cancel pictures that have not started, and wait for the current one."""
        self._pool.shutdown(cancel_futures=True)

    def _take(self, url: str, size: tuple[int, int], views: Sequence[View | None]) -> list[Pixels]:
        by_number: dict[int, Pixels] = {}
        with self._page(url, size) as (page, client):
            # The default view is that of a new browser, hence first.
            for number in sorted(range(len(views)), key=lambda number: views[number] is not None):
                self._show(page, client, views[number])
                rows = self._rows()
                panes = self._scene.link.pictures.panes()
                by_number[number] = with_panes(page, page.pixels(), panes, hidden_in(rows, rows))
        return [by_number[number] for number in range(len(views))]

    def _select(
        self, url: str, size: tuple[int, int], view: View | None, at: tuple[int, int]
    ) -> Mapping[str, Any]:
        with self._page(url, size) as (page, client):
            self._show(page, client, view)
            page.tab.add_style_tag(content=BEHIND)
            page.tab.keyboard.press("s")
            page.tab.mouse.click(*at)
            with contextlib.suppress(TimeoutError):
                page.wait_for(lambda: self._selection(client), "a selection", SELECTING_S)
            return self._selection(client)

    @contextlib.contextmanager
    def _page(self, url: str, size: tuple[int, int]) -> Iterator[tuple[Page, int]]:
        """Provide a new page, and the id of its browser."""
        check_size(size)
        try:
            with launched() as browser, self._open(browser, url, size) as page:
                page.tab.add_style_tag(content=WHOLE)
                page.wait_for(lambda: page.evaluate(CANVAS) == [*size], "a scene of its size")
                page.pixels()  # the first picture of a tab is smoothed differently
                yield page, page.evaluate("() => window.webviz.browser")
        except TimeoutError as error:
            raise Error(str(error)) from error

    def _show(self, page: Page, client: int, view: View | None) -> None:
        """Show a view, None for the present one, and wait until all of it is drawn."""
        if view is not None:
            self._look(view, client)
        page.wait_for(self._is_loaded, "all is loaded", PATIENCE_S)
        self._scene.link.acknowledge(PATIENCE_S, client)
        page.settle(PATIENCE_S)

    def _open(
        self, browser: playwright.Browser, url: str, size: tuple[int, int]
    ) -> contextlib.closing[Page]:
        return contextlib.closing(Page(browser, url, *size, cookie=self._cookie))

    def _is_loaded(self) -> bool:
        """Return whether no display is loading; meshes are read once a browser is connected."""
        return not any(LOADING in row.statuses for row in self._rows())

    def _rows(self) -> Sequence[Row]:
        self._viewer.do(Refresh())
        return self._viewer.rows

    def _selection(self, client: int) -> Mapping[str, Any]:
        self._viewer.do(Refresh())
        return self._viewer.fact("selections", {}).get(client, {})
