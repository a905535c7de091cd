"""Tabs of a real browser, while a test turns the frame loop behind their pages."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import Any

import playwright.sync_api as playwright
from pages import COARSE

from tests.page.page_bench import PageBench, PageServer
from webviz.engine.commands import Command

WIDTH, HEIGHT = 900, 800
"""Width of a tab in pixels."""

CATCH_UP = """async () => {
  const { on, send } = await import("webviz/channel.js");
  const answered = new Promise((resolve) => on("Pong", resolve));
  send({ type: "Ping" });
  await answered;
}"""
"""Returns when the page shows what the server has sent before."""


class ViewerTab:
    """One browser tab, which shows the newest viewer of a server; its errors fail the test.

    Args:
        page: an empty one.
        page_server: of the page to open.
        resolution: pixels of the scene per pixel of the page.
        query: more of the address, as "&panel=topics".
    """

    def __init__(
        self,
        page: playwright.Page,
        page_server: PageServer,
        resolution: float = COARSE,
        query: str = "",
    ) -> None:
        self.page = page
        self._page_server = page_server
        self.errors: list[str] = []
        page.on("pageerror", lambda error: self.errors.append(str(error)))
        page.on("console", self._read_console)
        page.on("dialog", self._dismiss)
        page.goto(f"http://127.0.0.1:{page_server.server.get_port()}/?fixedDpr={resolution}{query}")
        self.wait_for(lambda: page.locator("#webviz").count() > 0)

    @property
    def viewer(self) -> PageBench:
        """The viewer."""
        return self._page_server.viewer

    @property
    def browser(self) -> int:
        """The id of its browser, once it is connected."""
        self.wait_for(lambda: self.page.evaluate("webviz.browser") is not None)
        return self.page.evaluate("webviz.browser")

    def paused(self) -> AbstractContextManager[None]:
        """Turn the loop only when the test does, and not while it waits for the browser."""
        return self._page_server.paused()

    def button(self, name: str) -> playwright.Locator:
        """A button by its exact name."""
        return self.page.get_by_role("button", name=name, exact=True)

    def show_tab(self, title: str) -> None:
        """Open a panel."""
        self.page.get_by_role("tab", name=title, exact=True).click()
        self.turn()

    def text(self) -> str:
        """All that can be read on the page."""
        return self.page.locator("#webviz").inner_text()

    def turn(self) -> None:
        """Let the page and the loop work for a moment."""
        self.page.wait_for_timeout(20)
        self.viewer.turn()

    def catch_up(self) -> None:
        """Wait until the server knows what the page has sent, and the page what it was sent.

        What the page has begun to watch comes with the next turn.
        """
        self.page.evaluate(CATCH_UP)

    def wait_for(self, condition: Callable[[], object], timeout: float = 60.0) -> None:
        """Wait until a condition holds while the page and the loop run."""
        for _ in range(int(timeout / 0.02)):
            self.viewer.turn()
            if condition():
                return
            self.page.wait_for_timeout(20)
        tabs = self.page.get_by_role("tab", include_hidden=True)
        boxes = tabs.evaluate_all(
            "(all) => all.map((one) => [one.id, one.hidden, one.offsetWidth])"
        )
        raise AssertionError(f"timed out; the tabs are {boxes}, and the page says {self.text()}")

    def wait_for_command(self, command: Command) -> None:
        """Wait until this command has come, after those that a test waited for before."""
        self.wait_for(lambda: self.viewer.has_received(command))

    def _dismiss(self, dialog: playwright.Dialog) -> None:
        self.errors.append(f"a script ran: {dialog.message}")
        dialog.dismiss()

    def _read_console(self, message: playwright.ConsoleMessage) -> None:
        if message.type == "error":
            self.errors.append(message.text)


def open_page(
    browser: playwright.Browser, width: int = WIDTH, height: int = HEIGHT, **options: Any
) -> playwright.Page:
    """An empty page in a browser session of its own."""
    return browser.new_context(viewport={"width": width, "height": height}, **options).new_page()
