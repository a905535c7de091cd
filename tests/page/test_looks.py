"""Appearance of the page: themes, contrast, tooltips, and states with something missing."""

from __future__ import annotations

import itertools

import playwright.sync_api as playwright
import pytest
from pages import COARSE, bounds

from tests.page.everything import Everything, named
from tests.page.page_bench import SCAN, PageBench
from tests.page.tabs import ViewerTab
from webviz.server.channel.messages import Shell

SURFACES = ("back", "raised", "field", "chosen", "hover")
LETTERS = ("text", "quiet", "accent", "ok", "warn", "error")
COLOR = """(name) => {
  const probe = document.createElement("i");
  probe.style.color = `var(--wv-${name})`;
  document.getElementById("webviz").append(probe);
  const color = getComputedStyle(probe).color;
  probe.remove();
  return color.match(/[\\d.]+/g).slice(0, 3).map(Number);
}"""

WATCH = """
  window.seen = new Set();
  window.unseenFrames = 0;
  const { clear } = WebGL2RenderingContext.prototype;
  WebGL2RenderingContext.prototype.clear = function (mask) {
    if (!("wvShown" in document.documentElement.dataset)) window.unseenFrames += 1;
    clear.call(this, mask);
  };
  (function look() {
    for (const one of document.querySelectorAll("#root *")) {
      const nodes = [...one.childNodes].filter((node) => node.nodeType === 3);
      const words = nodes.map((node) => node.data);
      const isSeen = words.join("").trim() && one.checkVisibility({ visibilityProperty: true });
      if (isSeen) window.seen.add(words.join(""));
    }
    requestAnimationFrame(look);
  })();
"""
"""Notes the words of viser's page that are seen in any frame, and counts the frames before."""


@pytest.fixture
def tab(viewer_tab: ViewerTab) -> ViewerTab:
    return viewer_tab


@pytest.fixture
def silent(viewer: PageBench, tab: ViewerTab) -> ViewerTab:
    """A tab of a viewer in which no node publishes anything."""
    viewer.source.topics.clear()
    return tab


def theme(tab: ViewerTab) -> str:
    return tab.page.evaluate("document.documentElement.dataset.wvTheme")


def choose_theme(tab: ViewerTab, name: str) -> None:
    tab.button("Menu").click()
    tab.page.get_by_role("menuitemradio", name=f"Theme: {name}").click()


def luminance(color: list[float]) -> float:
    """Return the luminance of sRGB from 0 to 255, as WCAG defines it."""
    linear = [c / 3294.6 if c <= 10 else ((c / 255 + 0.055) / 1.055) ** 2.4 for c in color]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def test_the_theme_is_the_systems_until_another_is_chosen(tab: ViewerTab) -> None:
    try:
        tab.page.emulate_media(color_scheme="light")
        tab.wait_for(lambda: theme(tab) == "light")
        tab.page.emulate_media(color_scheme="dark")
        tab.wait_for(lambda: theme(tab) == "dark")
        choose_theme(tab, "light")
        assert theme(tab) == "light"
    finally:
        choose_theme(tab, "as the system")
    assert theme(tab) == "dark"


@pytest.mark.parametrize("name", ["dark", "light"])
def test_all_letters_can_be_read_on_all_surfaces(tab: ViewerTab, name: str) -> None:
    choose_theme(tab, name)
    colors = {each: luminance(tab.page.evaluate(COLOR, each)) for each in SURFACES + LETTERS}
    choose_theme(tab, "as the system")
    too_faint = []
    for letters, surface in itertools.product(LETTERS, SURFACES):
        low, high = sorted((colors[letters], colors[surface]))
        if (high + 0.05) / (low + 0.05) < 4.5:
            too_faint.append((letters, surface))
    assert too_faint == []


def test_nothing_published_is_explained_until_a_topic_appears(silent: ViewerTab) -> None:
    viewer = silent.viewer
    card = silent.page.get_by_role("region", name="Nothing is published")
    viewer.offer("/rosout", "rcl_interfaces/msg/Log", "/driver")
    viewer.offer("/goal_pose", "geometry_msgs/msg/PoseStamped", "/webviz")
    silent.wait_for(card.is_visible)
    assert "webviz-sim" in card.inner_text()
    viewer.offer("/scan", SCAN, "/driver")
    silent.wait_for(card.is_hidden)


def test_the_scene_below_the_first_hint_takes_the_mouse_and_its_button_closes_it(
    silent: ViewerTab,
) -> None:
    tab = silent
    card = tab.page.get_by_role("region", name="Nothing is published")
    tab.wait_for(card.is_visible)
    box = bounds(card.get_by_text("Start your robot"))
    hit = "([x, y]) => document.elementFromPoint(x, y).tagName"
    assert tab.page.evaluate(hit, [box["x"] + 5, box["y"] + 5]) == "CANVAS"
    card.get_by_role("button", name="Close").click()
    playwright.expect(card).to_have_count(0)
    assert tab.page.evaluate("localStorage.getItem('webviz.knows-first-run')") == "true"


def test_a_new_page_shows_nothing_before_it_is_ours_and_no_hint_that_was_closed(
    silent: ViewerTab,
) -> None:
    tab = silent
    tab.page.evaluate("localStorage.setItem('webviz.knows-first-run', 'true')")
    page = tab.page.context.new_page()
    page.add_init_script(WATCH)
    page.goto(f"http://127.0.0.1:{tab.viewer.server.get_port()}/?fixedDpr={COARSE}")
    page.get_by_role("tablist").first.wait_for()
    assert page.evaluate("[...window.seen]") == []
    assert page.evaluate("window.unseenFrames") <= 2, "those before the page is ours"
    tab.wait_for(lambda: page.locator(".wv-file").inner_text() == "webviz")
    assert page.get_by_role("region", name="Nothing is published").count() == 0
    page.close()


def test_a_tooltip_appears_under_the_mouse_and_goes_with_it(tab: ViewerTab) -> None:
    tip = tab.page.get_by_role("tooltip")
    tab.button("Commands").hover()
    playwright.expect(tip).to_have_text("CommandsCtrl+K")
    playwright.expect(tip).to_have_css("pointer-events", "none")  # clicks go to what is below
    tab.page.mouse.move(500, 400)
    playwright.expect(tip).to_be_hidden()


def test_a_title_becomes_a_tooltip_and_stays_a_name(tab: ViewerTab) -> None:
    make = """() => {
      const button = document.createElement("button");
      button.title = "Turn <b>";
      button.id = "titled";
      button.innerHTML = "<svg width=9 height=9></svg>";
      document.querySelector(".wv-head").append(button);
    }"""
    tab.page.evaluate(make)
    button = tab.page.locator("#titled")
    button.hover()
    playwright.expect(tab.page.get_by_role("tooltip")).to_have_text("Turn <b>")
    playwright.expect(button).to_have_accessible_name("Turn <b>")
    button.evaluate("(button) => button.remove()")


def test_visers_panel_is_hidden_but_for_debugging(tab: ViewerTab) -> None:
    panel = tab.page.locator("#root .mantine-Paper-root").first
    playwright.expect(panel).to_be_hidden()
    tab.viewer.server.channel.send(Shell(debug=True))
    playwright.expect(panel).to_be_visible()
    tab.viewer.server.channel.send(Shell())
    playwright.expect(panel).to_be_hidden()


def test_nothing_changes_on_the_page_while_nothing_changes(tab: ViewerTab) -> None:
    tab.viewer.offer("/scan", SCAN, "/driver")
    watch = """() => {
      window.touched = [];
      const observer = new MutationObserver((records) => {
        window.touched.push(...records.map(({ target }) => target.className));
      });
      for (const part of document.querySelectorAll(".wv-side, .wv-toolbar")) {
        observer.observe(part, { subtree: true, childList: true, attributes: true,
          characterData: true });
      }
    }"""
    tab.page.evaluate(watch)

    def changes() -> list[str]:
        tab.page.evaluate("window.touched = []")
        for _ in range(40):
            tab.turn()
        return tab.page.evaluate("window.touched")

    # What was sent before still arrives on a slow machine.
    tab.wait_for(lambda: changes() == [])


EDGES = """() => {
  const boxes = (selector, range) => [...document.querySelectorAll(selector)]
    .filter((element) => element.checkVisibility())
    .map((element) => element.getBoundingClientRect());
  const left = ".wv-tree-search input, .wv-tree-fold svg, .wv-tree-add, .wv-details-title, " +
    ".wv-form > .wv-property > .wv-property-label, .wv-form > * > .wv-section-head svg:first-child";
  const right = ".wv-head > :last-child, .wv-tree-filter > .wv-icon, .wv-tree-dot, " +
    ".wv-details-head > :last-child, .wv-property-reset";
  return [
    boxes(left).map((box) => Math.round(box.left)),
    boxes(right).map((box) => Math.round((box.left + box.right) / 2)),
  ];
}"""


def test_filter_dots_and_buttons_stand_below_each_other(tab: ViewerTab) -> None:
    tab.viewer.show(Everything(name="a", size=0.5), *named("b"))
    row = tab.page.get_by_role("treeitem", name="a", exact=True)
    tab.wait_for(lambda: row.count() == 1)
    row.click()
    tab.wait_for(lambda: tab.button("Reset Size").is_visible())
    left, right = tab.page.evaluate(EDGES)
    assert len(left) > 10
    assert len(right) > 5
    assert len(set(left)) == 1
    assert len(set(right)) == 1
