"""Statuses and properties of a display."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import playwright.sync_api as playwright
import pytest

from tests.page.everything import Everything, named
from tests.page.page_bench import SCAN, PageBench
from tests.page.properties_pane import MOUNT, PropertiesPane
from tests.page.tabs import ViewerTab
from tests.page.trees import Tree
from webviz.api.declared import Topic, make
from webviz.api.registry import display_types
from webviz.api.status import Level, Remedy, Status
from webviz.commands import SetBackground, SetFixedFrame, SetFrameRate
from webviz.engine.forms import values_of
from webviz.engine.parts.display_properties import IN_THE_TREE
from webviz.shell.testing.messages import header
from webviz_displays.markers import MarkerArray
from webviz_displays.point_cloud2 import PointCloud2
from webviz_displays.tf import TF

BROKEN = """(labels) => labels.flatMap((label) => {
  const text = label.firstChild;
  const range = document.createRange();
  return [...text.data.matchAll(/\\S+/g)].filter(({ 0: word, index }) => {
    range.setStart(text, index);
    range.setEnd(text, index + word.length);
    return range.getClientRects().length > 1;
  }).map(([word]) => word);
})"""


@pytest.fixture
def pane(viewer: PageBench, viewer_tab: ViewerTab) -> Iterator[PropertiesPane]:
    viewer.show(*named("a"))
    yield from mounted(viewer_tab)


def mounted(tab: ViewerTab) -> Iterator[PropertiesPane]:
    """The properties of the display that is shown."""
    tab.page.evaluate("localStorage.clear()")
    yield PropertiesPane(tab).mount()
    tab.page.evaluate("ended(); document.querySelector('#bench').remove()")


@pytest.fixture
def pane_of_frames(viewer: PageBench, viewer_tab: ViewerTab) -> Iterator[PropertiesPane]:
    """The properties of a TF display with 303 frames."""
    links = [f"arm/link_{i:03}" for i in range(300)]
    viewer.link("map", *links, "<img src=x onerror=alert(1)>")
    viewer.show(TF(name="a", frames={"gone": False}))
    yield from mounted(viewer_tab)


def test_switches_of_hundreds_of_frames_are_searched_and_set_together(
    pane_of_frames: PropertiesPane,
) -> None:
    pane = pane_of_frames
    row = pane.row("frames")
    options = row.get_by_role("option")
    pane.tab.wait_for(lambda: row.get_by_placeholder("Filter 304 frames").count() == 1)
    assert options.count() < 30
    row.get_by_role("searchbox").fill("link_29")
    playwright.expect(options).to_have_count(10)
    options.nth(3).click()
    pane.wait_for_set("frames", {"gone": False, "arm/link_293": False})
    pane.keyboard.press("ArrowDown")
    pane.keyboard.press("Space")
    pane.wait_for_set("frames", {"gone": False, "arm/link_293": False, "arm/link_294": False})
    row.get_by_role("button", name="All", exact=True).click()
    pane.wait_for_set("frames", {"gone": False})

    pane.row("all_enabled").locator("input").uncheck()
    pane.wait_for_set("all_enabled", False)
    playwright.expect(options.nth(3)).to_have_attribute("aria-checked", "false")
    options.nth(3).click()
    pane.wait_for_set("frames", {"gone": False, "arm/link_293": True})


@pytest.fixture
def pane_of_markers(viewer: PageBench, viewer_tab: ViewerTab) -> Iterator[PropertiesPane]:
    """The properties of a MarkerArray display with 16 markers."""
    viewer.show(MarkerArray(name="a", namespaces={"gone": False}))
    names = ["lanes"] * 12 + ["<b>cones</b>"] * 3 + [""]
    markers = [
        {
            "header": header("map", viewer.source.now),
            "ns": name,
            "id": number,
            "type": 2,
            "scale": {"x": 1.0, "y": 1.0, "z": 1.0},
            "color": {"a": 1.0},
            "pose": {"orientation": {"w": 1.0}},
        }
        for number, name in enumerate(names)
    ]
    topic = viewer.display_named("a").topic.name
    viewer.publish(topic, "visualization_msgs/msg/MarkerArray", {"markers": markers})
    viewer.turn()
    yield from mounted(viewer_tab)


def test_switches_by_names_of_the_display_tell_how_many_things_have_each(
    pane_of_markers: PropertiesPane,
) -> None:
    pane = pane_of_markers
    row = pane.row("namespaces")
    options = row.get_by_role("option")
    pane.tab.wait_for(lambda: options.count() == 4)
    playwright.expect(options).to_have_text(["(no name)1", "<b>cones</b>3", "gone", "lanes12"])
    options.nth(3).click()
    pane.wait_for_set("namespaces", {"gone": False, "lanes": False})


def test_each_kind_of_property_has_its_control(pane: PropertiesPane) -> None:
    pane.field("topic.name").fill("/front")
    pane.keyboard.press("Enter")
    pane.wait_for_set("topic.name", "/front")
    pane.enter("frame", "base_link")
    pane.wait_for_set("frame", "base_link")
    pane.enter("size", "0.25")
    pane.wait_for_set("size", 0.25)
    pane.enter("count", "12")
    pane.wait_for_set("count", 12)
    pane.field("style").fill("Boxes")
    pane.field("style").press("Enter")
    pane.wait_for_set("style", "Boxes")
    pane.field("filled").uncheck()
    pane.wait_for_set("filled", False)
    pane.enter("channel", "ring")
    pane.wait_for_set("channel", "ring")
    pane.enter("offset", "2")
    pane.wait_for_set("offset", [2, 0.5, 0])
    pane.enter("prefixes", "front\nrear left", "Tab")
    pane.wait_for_set("prefixes", ["front", "rear left"])
    pane.enter("shown", "base_link: true\na:b: false", "Control+Enter")
    pane.wait_for_set("shown", {"base_link": True, "a:b": False})
    pane.enter("arrow.length", "1")
    pane.wait_for_set("arrow.length", 1)
    pane.field("alpha").focus()
    pane.keyboard.press("ArrowLeft")
    pane.wait_for_set("alpha", 0.99)


def test_what_the_viewer_has_is_shown(pane: PropertiesPane) -> None:
    values: dict[str, Any] = {
        "frame": "odom",
        "size": 0.125,
        "style": "Boxes",
        "color": (1, 2, 3),
        "offset": (1.5, 0.0, -2.0),
        "prefixes": ["a", "b"],
        "shown": {"base_link": False},
    }
    pane.change(**values)
    pane.wait_for_value("size", "0.125")
    assert pane.field("frame").input_value() == "odom"
    assert pane.field("style").input_value() == "Boxes"
    assert pane.field("color").input_value() == "#010203"
    assert pane.row("color").locator("[type=text]").input_value() == "1, 2, 3"
    inputs = pane.row("offset").locator("input").all()
    assert [each.input_value() for each in inputs] == ["1.5", "0", "-2"]
    assert pane.field("prefixes").input_value() == "a\nb"
    assert pane.field("shown").input_value() == "base_link: false"


def test_what_differs_from_the_default_is_marked_and_can_be_reset(pane: PropertiesPane) -> None:
    reset = pane.row("count").get_by_role("button", name="Reset Count")
    assert not reset.is_visible()
    pane.enter("count", "7")
    pane.tab.wait_for(reset.is_visible)
    assert pane.row("count").get_attribute("data-changed") is not None
    reset.click()
    pane.wait_for_set("count", 3)
    pane.wait_for_value("count", "3")
    pane.tab.wait_for(lambda: not reset.is_visible())


def test_what_does_not_apply_is_hidden(pane: PropertiesPane) -> None:
    assert "Edge" not in pane.labels()
    pane.field("style").fill("Boxes")
    pane.field("style").press("Enter")
    pane.tab.wait_for(lambda: "Edge" in pane.labels())


def test_units_ranges_and_help_can_be_read(pane: PropertiesPane) -> None:
    assert pane.row("size").locator(".wv-number-unit").inner_text() == "m"
    assert pane.field("size").get_attribute("title") == (
        "Edge of each point.\nRange: > 0 m.\nDefault: 0.01 m."
    )
    assert "Range: 0 to 1." in (pane.field("alpha").get_attribute("title") or "")


def test_what_is_refused_says_why_below_the_field_and_stays(pane: PropertiesPane) -> None:
    pane.enter("size", "-1")
    refusal = pane.row("size").get_by_role("alert")
    pane.tab.wait_for(refusal.is_visible)
    assert "> 0" in refusal.inner_text()
    assert pane.field("size").input_value() == "-1"
    pane.keyboard.press("Escape")
    assert not refusal.is_visible()
    pane.tab.wait_for(lambda: pane.field("size").input_value() == "0.01")
    pane.enter("size", "0.5")
    pane.wait_for_set("size", 0.5)


@pytest.mark.parametrize(
    ("path", "text", "reason"),
    [
        ("size", "much", "“much” is not a number"),
        ("count", "2.5", "a whole number"),
        ("color", "red", "from 0 to 255"),
        ("shown", "base_link: yes", "is not valid"),
    ],
)
def test_what_means_nothing_is_not_sent(
    pane: PropertiesPane, path: str, text: str, reason: str
) -> None:
    field = pane.row(path).locator("input:not([type=color]), textarea").first
    field.fill(text)
    field.blur()
    assert reason in pane.row(path).get_by_role("alert").inner_text()
    pane.tab.turn()
    assert pane.viewer.commands == []


def test_a_text_without_end_is_refused(pane: PropertiesPane) -> None:
    pane.field("channel").evaluate("(field) => { field.value = 'x'.repeat(1_000_000) }")
    pane.field("channel").press("End")
    pane.keyboard.type("x")
    pane.keyboard.press("Enter")
    assert "at most 100,000 characters" in pane.row("channel").get_by_role("alert").inner_text()
    pane.keyboard.press("Escape")
    assert pane.field("channel").input_value() == "intensity"


def test_a_number_can_be_typed_with_its_unit(pane: PropertiesPane) -> None:
    pane.enter("size", "5 cm")
    pane.wait_for_set("size", 0.05)


def test_numbers_go_by_steps_that_suit_their_size(pane: PropertiesPane) -> None:
    pane.field("size").click()
    pane.keyboard.press("ArrowUp")
    pane.wait_for_set("size", 0.011)
    pane.keyboard.press("Shift+ArrowUp")
    pane.wait_for_set("size", 0.021)
    pane.field("count").click()
    for _ in range(4):
        pane.keyboard.press("ArrowDown")
    pane.wait_for_set("count", 1)  # not below its bound


def test_a_number_can_be_dragged_sideways(pane: PropertiesPane) -> None:
    box = pane.field("count").bounding_box()
    assert box
    mouse = pane.page.mouse
    mouse.move(box["x"] + 40, box["y"] + 10)
    mouse.down()
    mouse.move(box["x"] + 60, box["y"] + 10, steps=4)
    mouse.move(box["x"] + 80, box["y"] + 10, steps=4)
    pane.wait_for_set("count", 13)
    mouse.move(box["x"] - 200, box["y"] + 10, steps=4)
    pane.wait_for_set("count", 1)
    mouse.up()
    pane.wait_for_value("count", "1")


def test_a_number_can_be_dragged_by_its_label_and_coarser_and_finer(pane: PropertiesPane) -> None:
    label = pane.row("count").locator(".wv-property-label")
    box = label.bounding_box()
    assert box
    x, y = box["x"] + 10, box["y"] + box["height"] / 2
    mouse = pane.page.mouse
    mouse.move(x, y)
    mouse.down()
    mouse.move(x + 20, y, steps=4)
    pane.wait_for_set("count", 8)
    pane.keyboard.down("Shift")
    mouse.move(x + 40, y, steps=4)
    pane.wait_for_set("count", 58)
    pane.keyboard.up("Shift")
    mouse.up()
    assert not pane.field("count").evaluate("e => e === document.activeElement")
    label.click()
    playwright.expect(pane.field("count")).to_be_focused()

    field = pane.row("offset").locator("input").nth(1)
    box = field.bounding_box()
    assert box
    x, y = box["x"] + 10, box["y"] + 10
    mouse.move(x, y)
    mouse.down()
    pane.keyboard.down("Alt")
    mouse.move(x + 40, y, steps=4)
    pane.wait_for_set("offset", [0, 0.51, 0])
    pane.keyboard.up("Alt")
    mouse.up()


def test_a_slider_sends_while_it_is_dragged(pane: PropertiesPane) -> None:
    box = pane.field("alpha").bounding_box()
    assert box
    mouse = pane.page.mouse
    mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    mouse.down()
    pane.wait_for_set("alpha", 0.5)
    mouse.move(box["x"] + 1, box["y"] + box["height"] / 2, steps=5)
    pane.wait_for_set("alpha", 0)
    mouse.up()
    number = pane.row("alpha").get_by_role("spinbutton")
    pane.tab.wait_for(lambda: number.input_value() == "0")


def test_a_colour_is_picked_or_typed_as_rviz_writes_it(pane: PropertiesPane) -> None:
    pane.field("color").fill("#0080ff")
    pane.wait_for_set("color", [0, 128, 255])
    text = pane.row("color").locator("[type=text]")
    text.fill("1; 2; 3")
    text.press("Enter")
    pane.wait_for_set("color", [1, 2, 3])


def test_what_comes_from_elsewhere_waits_while_somebody_types(pane: PropertiesPane) -> None:
    pane.field("channel").fill("half")
    pane.change(channel="other", count=9)
    pane.wait_for_value("count", "9")
    assert pane.field("channel").input_value() == "half"
    pane.keyboard.press("Escape")
    pane.wait_for_value("channel", "other")


def test_a_field_ends_with_what_the_viewer_made_of_it(pane: PropertiesPane) -> None:
    pane.enter("count", "5")
    pane.wait_for_set("count", 5)
    pane.change(count=6)
    pane.wait_for_value("count", "6")


def test_sections_fold_and_this_browser_remembers_it(pane: PropertiesPane) -> None:
    assert "Length" in pane.labels()
    pane.element.get_by_role("button", name="Arrow", exact=True).click()
    assert "Length" not in pane.labels()
    pane.page.evaluate("ended()")
    pane.page.evaluate("document.querySelector('#bench').remove()")
    pane.mount()
    assert "Length" not in pane.labels()


@pytest.fixture
def pane_with_topics(viewer: PageBench, viewer_tab: ViewerTab) -> Iterator[PropertiesPane]:
    """The properties of a display, while four topics are live."""
    viewer.offer("/scans", SCAN, "/driver")
    viewer.offer("/rear", SCAN, "/driver", "/bag")
    viewer.offer("/bad", SCAN, "/x", problem="The types differ.")
    viewer.offer("/plan", "nav_msgs/msg/Path", "/nav")
    viewer.show(Everything(name="a", topic=Topic("/scans")))
    viewer.stream_scans("/scans", 40.0)
    yield from mounted(viewer_tab)


def test_the_topics_of_the_type_are_offered_with_what_is_known_of_them(
    pane_with_topics: PropertiesPane,
) -> None:
    pane = pane_with_topics
    pane.tab.wait_for(lambda: "40 Hz" in pane.text())
    assert "auto (best effort)" in pane.text()
    pane.field("topic.name").click()
    options = pane.row("topic.name").get_by_role("option")
    pane.tab.wait_for(lambda: options.count() == 3)
    assert options.all_inner_texts() == [
        "/bad\nThe types differ.",
        "/rear\n2 publishers",
        "/scans\n40 Hz · 1 publisher · shown by a",
    ]
    options.nth(1).click()
    pane.wait_for_set("topic.name", "/rear")


def test_the_qos_is_folded_under_one_line(pane: PropertiesPane) -> None:
    assert "Reliability" not in pane.labels()
    pane.element.get_by_role("button", name="QoS").click()
    pane.field("topic.reliability").fill("reliable")
    pane.field("topic.reliability").press("Enter")
    pane.wait_for_set("topic.reliability", "reliable")
    pane.enter("topic.depth", "20")
    pane.wait_for_set("topic.depth", 20)
    pane.tab.wait_for(lambda: "reliable, depth 20" in pane.text())


def test_frames_are_offered(pane: PropertiesPane) -> None:
    pane.field("frame").click()
    options = pane.row("frame").get_by_role("option")
    pane.tab.wait_for(lambda: options.all_inner_texts() == ["<Fixed Frame>", "base_link", "map"])
    options.last.click()
    pane.wait_for_set("frame", "map")


def test_statuses_are_folded_while_all_is_well(pane: PropertiesPane) -> None:
    well = {"Topic": Status(Level.OK, "5 messages"), "Transform": Status(Level.OK, "fine")}
    pane.viewer.report(a=well)
    pane.tab.wait_for(lambda: "OK" in pane.text())
    assert "5 messages" not in pane.text()
    pane.element.get_by_role("button", name="Status").click()
    pane.tab.wait_for(lambda: "Topic: 5 messages" in pane.text())
    pane.element.get_by_role("button", name="Status").click()
    bad = {**well, "Message": Status(Level.ERROR, "<b>It</b> is broken.")}
    pane.viewer.report(a=bad)
    pane.tab.wait_for(lambda: "Message: <b>It</b> is broken." in pane.text())


def test_a_status_offers_what_a_click_can_do_about_it(pane: PropertiesPane) -> None:
    remedy = Remedy("topic.name", "/front/scan")
    status = Status(Level.WARN, "No publisher on /scan.", remedy)
    pane.viewer.report(a={"Topic": status})
    link = pane.element.get_by_role("button", name="Use it")
    pane.tab.wait_for(link.is_visible)
    link.click()
    pane.wait_for_set("topic.name", "/front/scan")


def test_nothing_on_the_page_changes_while_nothing_changes(pane: PropertiesPane) -> None:
    pane.page.evaluate("""() => {
      window.changes = 0;
      const observer = new MutationObserver((records) => { changes += records.length });
      const all = { subtree: true, childList: true, attributes: true, characterData: true };
      observer.observe(document.querySelector("#bench"), all);
    }""")
    for _ in range(30):
        pane.tab.turn()
    assert pane.page.evaluate("changes") == 0


@pytest.mark.parametrize("name", sorted(display_types()))
def test_every_property_of_every_display_has_a_control(viewer_tab: ViewerTab, name: str) -> None:
    tab, display = viewer_tab, make(display_types()[name], {"name": "b"})
    tab.viewer.show(display)
    tab.page.evaluate("localStorage.clear()")
    tab.page.evaluate(MOUNT, tab.viewer.id("b"))
    values = values_of(display, IN_THE_TREE)
    rows = tab.page.locator("#bench .wv-property")
    tab.wait_for(lambda: rows.count() == len(values))
    paths = rows.evaluate_all("(rows) => rows.map((row) => row.dataset.path)")
    assert set(paths) == values.keys()
    assert tab.page.locator("#bench [data-changed], #bench [aria-invalid]").count() == 0
    tab.page.evaluate("ended(); document.querySelector('#bench').remove()")


def test_untrusted_names_are_text(pane: PropertiesPane) -> None:
    name = "<img src=x onerror=alert(1)>\u202e" + "x" * 10_000
    status = Status(Level.ERROR, name)
    pane.viewer.report(a={name: status})
    pane.viewer.offer(name, SCAN, "/x")
    pane.change(channel=name, frame=name, shown={name: True})
    pane.wait_for_value("channel", name)
    pane.field("topic.name").click()
    pane.tab.wait_for(lambda: pane.row("topic.name").get_by_role("option").count() == 1)
    assert pane.element.evaluate("(element) => element.scrollWidth <= element.clientWidth")


@pytest.fixture
def options(viewer_tab: ViewerTab) -> Iterator[PropertiesPane]:
    tab = viewer_tab
    tab.page.evaluate("localStorage.clear()")
    tab.page.evaluate(MOUNT, "")
    pane = PropertiesPane(tab)
    tab.wait_for(lambda: pane.labels() == ["Fixed Frame", "Background", "Frame Rate", "Robots"])
    yield pane
    tab.page.evaluate("ended(); document.querySelector('#bench').remove()")


def test_what_holds_for_the_whole_viewer_is_edited(options: PropertiesPane) -> None:
    viewer = options.viewer
    viewer.link("map", "odom")
    options.field("fixed_frame").click()
    odom = options.page.get_by_role("option", name="odom")
    options.tab.wait_for(odom.is_visible)
    assert options.row("fixed_frame").get_by_role("option").count() == 3
    odom.click()
    options.tab.wait_for_command(SetFixedFrame("odom"))
    assert viewer.settings.fixed_frame == "odom"
    options.field("background").fill("#0a0b0c")
    options.tab.wait_for_command(SetBackground((10, 11, 12)))
    assert viewer.settings.background == (10, 11, 12)
    text = options.row("background").get_by_role("textbox", name="Background, as text")
    playwright.expect(text).to_have_value("10, 11, 12")
    text.fill("")
    text.press("Enter")
    options.tab.wait_for_command(SetBackground(None))
    playwright.expect(text).to_have_attribute("placeholder", "automatic")
    rate = options.row("frame_rate").get_by_role("spinbutton")
    rate.fill("30 Hz")
    rate.press("Enter")
    options.tab.wait_for_command(SetFrameRate(30.0))
    assert (viewer.settings.background, viewer.settings.frame_rate) == (None, 30.0)


def test_what_is_wrong_with_the_viewer_is_said_above(options: PropertiesPane) -> None:
    options.viewer.do(SetFixedFrame("<b>earth</b>"))
    options.tab.wait_for(
        lambda: 'Fixed Frame: Fixed frame "<b>earth</b>" does not exist.' in options.text()
    )
    assert options.field("fixed_frame").input_value() == "<b>earth</b>"
    assert options.row("fixed_frame").get_attribute("data-changed") is not None


def test_words_of_labels_stay_whole_in_a_panel_of_320_pixels(viewer_tab: ViewerTab) -> None:
    tab = viewer_tab
    tab.viewer.show(PointCloud2(name="a"))
    tree = Tree(tab)
    tree.click("a")
    labels = tab.page.locator(".wv-property-label:visible")
    tab.wait_for(lambda: labels.count() > 5)
    assert labels.evaluate_all(BROKEN) == [], "below the tree"
    tab.button("Close properties").click()
    tab.wait_for(lambda: labels.count() == 0)
    tree.fold("a")
    tab.wait_for(lambda: labels.count() > 5)
    assert labels.evaluate_all(BROKEN) == [], "in the tree"
    tab.button("List options").click()
    tab.page.get_by_text("Properties below the tree").click()
    tree.fold("a")
