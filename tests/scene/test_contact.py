"""A picture that is no longer kept true says so."""

from __future__ import annotations

import re
import threading

import playwright.sync_api as playwright
import viser

from webviz.scene import ViserScene, open_server
from webviz.shell.pictures.browser import Page

BANNER = re.compile(
    r"Connection to webviz lost\. The picture is \d+ s old\. "
    r"Check that webviz is running; this page reconnects automatically\."
)


TWO_BEATS = """async () => {
  const { on } = await import("webviz/channel.js");
  let beats = 0;
  await new Promise((resolve) => on("Heartbeat", () => ++beats === 2 && resolve()));
}"""


def test_a_page_reports_a_lost_server_until_it_is_back(
    browser: playwright.Browser, server: viser.ViserServer, scene: ViserScene
) -> None:
    port = server.get_port()
    page = Page(browser, f"http://127.0.0.1:{port}", 600, 400)
    banner = page.tab.get_by_role("alert").filter(has_text=BANNER)
    page.tab.evaluate(TWO_BEATS)
    assert banner.count() == 0  # nothing happens, and all is well
    word = page.tab.get_by_text("Software WebGL rendering detected")  # of viser
    word.wait_for(state="attached")
    assert not word.is_visible()

    hanging = threading.Event()
    server.get_event_loop().call_soon_threadsafe(hanging.wait, 60.0)
    banner.wait_for()
    hanging.set()
    banner.wait_for(state="detached")

    server.stop()
    banner.wait_for()
    again = open_server(port=port)
    try:
        ViserScene(again)
        banner.wait_for(state="detached")
        page.wait_for(lambda: again.get_clients(), "the page is back")
    finally:
        page.close()
        again.stop()
