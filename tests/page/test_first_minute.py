"""The page of a newcomer: while it connects, words below tools, and things to try."""

from __future__ import annotations

from collections.abc import Iterator

import playwright.sync_api as playwright
import pytest
from pages import COARSE

from tests.page.page_bench import SCAN, PageBench
from tests.page.tabs import HEIGHT, WIDTH, ViewerTab
from tests.page.trees import height_of

BEFORE = """() => ["::before", "::after"].map((part) => {
  const { content, display } = getComputedStyle(document.documentElement, part);
  return display === "none" ? "none" : content;
})"""
BYTES_PER_S = 100_000


@pytest.fixture
def tab(viewer_tab: ViewerTab) -> Iterator[ViewerTab]:
    yield viewer_tab
    viewer_tab.page.keyboard.press("Escape")
    viewer_tab.page.set_viewport_size({"width": WIDTH, "height": HEIGHT})


def test_a_page_that_connects_says_so_before_any_script_runs(tab: ViewerTab) -> None:
    page = tab.page.context.new_page()
    network = page.context.new_cdp_session(page)
    network.send("Network.enable")
    slow = {"offline": False, "latency": 0, "uploadThroughput": -1}
    network.send("Network.emulateNetworkConditions", slow | {"downloadThroughput": BYTES_PER_S})
    page.goto(
        f"http://127.0.0.1:{tab.viewer.server.get_port()}/?fixedDpr={COARSE}", wait_until="commit"
    )
    page.wait_for_function(f"() => ({BEFORE})()[1].includes('Connecting')")
    assert page.evaluate("() => document.documentElement.dataset.wvShown") is None
    network.send("Network.emulateNetworkConditions", slow | {"downloadThroughput": -1})
    page.get_by_role("tablist").first.wait_for()
    tab.wait_for(lambda: page.evaluate(BEFORE) == ["none", "none"])
    page.close()


def test_tools_have_words_until_three_were_chosen(tab: ViewerTab) -> None:
    tab.page.set_viewport_size({"width": 1600, "height": HEIGHT})
    words = tab.page.locator(".wv-tool-name")
    select = tab.page.get_by_role("toolbar").get_by_role("button", name="Select", exact=True)
    tab.wait_for(words.get_by_text("Select", exact=True).is_visible)
    for _ in range(3):
        select.click()
    assert words.get_by_text("Select", exact=True).is_visible()  # nothing jumps while one clicks
    select.click()
    tab.page.reload()
    tab.wait_for(select.is_visible)
    playwright.expect(words.get_by_text("Select", exact=True)).to_be_hidden()
    tab.page.evaluate("localStorage.clear()")
    tab.page.reload()
    tab.wait_for(words.get_by_text("Select", exact=True).is_visible)


def test_words_that_do_not_fit_beside_the_view_have_a_row_of_their_own(tab: ViewerTab) -> None:
    tab.page.set_viewport_size({"width": 1600, "height": HEIGHT})
    bar = tab.page.get_by_role("toolbar")
    word = bar.locator(".wv-tool-name").get_by_text("Select", exact=True)
    tab.wait_for(word.is_visible)
    one_row = height_of(bar)
    for width in range(1500, 600, -100):
        tab.page.set_viewport_size({"width": width, "height": HEIGHT})
        tab.wait_for(lambda: not bar.evaluate("(bar) => bar.scrollWidth > bar.clientWidth"))
        if height_of(bar) > one_row:
            break
    assert height_of(bar) > one_row
    assert word.is_visible()


def test_the_robot_of_the_demo_brings_three_things_to_try_until_they_are_closed(
    viewer: PageBench, tab: ViewerTab
) -> None:
    card = tab.page.get_by_role("region", name="Three things to try")
    viewer.offer("/scan", SCAN, "/driver")
    tab.show_tab("Topics")
    tab.wait_for(lambda: "/scan" in tab.text())
    assert not card.is_visible()
    tab.show_tab("Displays")
    viewer.offer("/odom", "nav_msgs/msg/Odometry", "/sim")
    viewer.offer("/scan", SCAN, "/sim")
    tab.wait_for(card.is_visible)
    assert card.get_by_role("listitem").count() == 3
    card.get_by_role("button", name="Commands").click()
    playwright.expect(tab.page.get_by_role("dialog")).to_be_visible()
    tab.page.keyboard.press("Escape")
    card.get_by_role("button", name="Close").click()
    playwright.expect(card).to_be_hidden()
    tab.page.reload()
    tab.wait_for(tab.button("Menu").is_visible)
    playwright.expect(card).to_be_hidden()


def test_the_list_of_keys_has_those_of_another_moment(tab: ViewerTab) -> None:
    tab.page.keyboard.press("?")
    row = tab.page.locator(".wv-keys div").filter(has_text="Return to live").last
    playwright.expect(row.locator("kbd")).to_have_text("L")
