"""A page that looks back asks for whom, in real browsers."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import playwright.sync_api as playwright
import pytest
from playwright.sync_api import expect

from tests.support.memory_viewer import MemoryViewer
from webviz.shell.pictures.browser import Page

SHOW = "async (view) => (await import('webviz/act.js')).act('ShowView', { view })"
QUESTION = "Look back for whom?"
VIEW = {"type": "Orbit", "distance": 7.0, "yaw": -2.0, "pitch": 0.4}


@pytest.fixture
def enter(memory: MemoryViewer, browser: playwright.Browser) -> Iterator[Callable[[], Page]]:
    pages: list[Page] = []

    def enter() -> Page:
        pages.append(Page(browser, memory.viewer.url, 1000, 600))
        expect(pages[-1].tab.get_by_role("slider", name="Time")).to_be_visible(timeout=60_000)
        return pages[-1]

    yield enter
    for page in pages:
        page.close()
        assert page.errors == []


def distance(memory: MemoryViewer, page: Page) -> float | None:
    view = memory.viewer.fact("views").get(page.evaluate("() => window.webviz.browser"))
    return getattr(view, "distance", None)


def is_live(memory: MemoryViewer) -> bool:
    return memory.viewer.fact("playback").is_live is True


def test_the_only_page_looks_back_without_a_question(
    memory: MemoryViewer, enter: Callable[[], Page]
) -> None:
    page = enter()
    page.tab.keyboard.press("Shift+ArrowLeft")
    page.wait_for(lambda: not is_live(memory), "the past")
    expect(page.tab.get_by_text(QUESTION)).to_have_count(0)
    # Until the page knows of the past, the key does nothing.
    expect(page.tab.locator(".wv-rewound-banner")).to_be_visible(timeout=60_000)
    page.tab.keyboard.press("l")
    page.wait_for(lambda: is_live(memory), "live topics")


def test_for_me_the_others_stay_live_and_the_page_comes_back_as_it_was(
    memory: MemoryViewer, enter: Callable[[], Page], caplog: pytest.LogCaptureFixture
) -> None:
    page, other = enter(), enter()
    page.evaluate(SHOW, VIEW)
    page.wait_for(lambda: distance(memory, page) == pytest.approx(7.0), "the view")
    page.tab.keyboard.press("Shift+ArrowLeft")
    expect(page.tab.get_by_text(QUESTION)).to_be_visible()
    page.tab.keyboard.press("Enter")
    banner = page.tab.get_by_role("button", name="Your own past")
    expect(banner).to_be_visible(timeout=60_000)
    assert "/past/" in page.tab.url
    expect(page.tab).to_have_title("Own past · webviz")
    expect(page.tab.locator(".wv-time .wv-badge")).to_have_text("past")
    assert is_live(memory)
    expect(other.tab.locator(".wv-rewound-banner")).to_be_hidden()
    banner.click()
    page.tab.wait_for_function("window.webviz?.hasView() && window.webviz.browser !== null")
    assert "/past/" not in page.tab.url
    assert "Refused" not in caplog.text, "an operator's page asks for nothing that owners see"
    page.wait_for(lambda: distance(memory, page) == pytest.approx(7.0), "the same view")


def test_other_pages_see_who_looks_back_for_everybody_and_return_to_live(
    memory: MemoryViewer, enter: Callable[[], Page]
) -> None:
    page, other = enter(), enter()
    page.tab.keyboard.press("Shift+ArrowLeft")
    page.tab.get_by_label("Don't ask again in this tab").check()
    page.tab.get_by_role("button", name="For everybody").click()
    page.wait_for(lambda: not is_live(memory), "the past")
    banner = other.tab.locator(".wv-rewound-banner")
    expect(banner).to_contain_text("Another page looks back · ", timeout=60_000)
    expect(page.tab.locator(".wv-rewound-banner")).not_to_contain_text("looks back")
    banner.click()
    page.wait_for(lambda: is_live(memory), "live topics")
    page.tab.keyboard.press("Shift+ArrowLeft")
    page.wait_for(lambda: not is_live(memory), "the past, without a question")
    expect(page.tab.get_by_text(QUESTION)).to_have_count(0)


def test_a_question_that_is_cancelled_changes_nothing(
    memory: MemoryViewer, enter: Callable[[], Page]
) -> None:
    page, _ = enter(), enter()
    page.tab.keyboard.press("Shift+ArrowLeft")
    expect(page.tab.get_by_text(QUESTION)).to_be_visible()
    page.tab.keyboard.press("Escape")
    expect(page.tab.get_by_text(QUESTION)).to_have_count(0)
    assert is_live(memory)
