"""Several browsers share one viewer."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import playwright.sync_api as playwright
import pytest
from viser_internals import cut_connections

from tests.page.conftest import DISMISS
from tests.page.everything import group, named
from tests.page.page_bench import PageBench
from tests.page.properties_pane import PropertiesPane
from tests.page.tabs import ViewerTab
from tests.page.test_plugin_panels import Frames, titles
from tests.page.trees import Tree
from webviz.api import registry
from webviz.commands import ChangeView, RemoveDisplay, SaveImage, SetProperty
from webviz.engine.commands import Sender
from webviz.tools.goal_pose import GoalPose

STRING = "std_msgs/msg/String"


@pytest.fixture(scope="module")
def other_tab(open_lasting_viewer_tab: Callable[[], ViewerTab]) -> ViewerTab:
    return open_lasting_viewer_tab()


@pytest.fixture
def mine(viewer: PageBench, viewer_tab: ViewerTab) -> Iterator[PropertiesPane]:
    viewer.show(*named("a"))
    yield from mounted(viewer_tab)


@pytest.fixture
def other(mine: PropertiesPane, other_tab: ViewerTab) -> Iterator[PropertiesPane]:
    yield from mounted(other_tab)


def mounted(tab: ViewerTab) -> Iterator[PropertiesPane]:
    pane = PropertiesPane(tab).mount()
    tab.page.evaluate(DISMISS)  # a late toast of another module would lie over it
    yield pane
    unmount(tab)


def unmount(tab: ViewerTab) -> None:
    tab.page.evaluate("ended(); document.querySelector('#bench').remove()")


@pytest.fixture
def mine_with_frames(viewer: PageBench, viewer_tab: ViewerTab) -> Iterator[PropertiesPane]:
    """The same, with a panel of a plug-in that shows the frames."""
    registry.register("tests", {"Frames": Frames})
    viewer.show(*named("a"), panels=[Frames(name="Frames")])
    yield from mounted(viewer_tab)
    registry.register("tests", {})


def test_a_browser_that_comes_late_sees_how_things_are_and_asks_for_itself(
    viewer: PageBench, mine_with_frames: PropertiesPane, request: pytest.FixtureRequest
) -> None:
    """The first test of this module, since the other browser is then the late one."""
    mine = mine_with_frames
    for path, value in (("count", 8), ("filled", False)):
        viewer.do(SetProperty(viewer.id("a"), path, value), Sender(10**6))
    viewer.link("map", "late_frame")
    mine.wait_for_value("count", "8")
    tab: ViewerTab = request.getfixturevalue("other_tab")
    late = PropertiesPane(tab).mount()
    late.wait_for_value("count", "8")
    assert not late.field("filled").is_checked()
    tab.wait_for(lambda: not tab.button("Undo").is_disabled())
    assert "in another browser" not in tab.text(), "of old steps"
    tab.wait_for(lambda: "Frames" in titles(tab))
    tab.show_tab("Frames")
    tab.wait_for(lambda: "late_frame" in tab.text())
    for each in (tab, mine.tab):
        each.show_tab("Displays")
    tab.page.keyboard.press("Control+k")
    tab.page.get_by_role("dialog", name="Commands").get_by_role("combobox").fill("save image")
    tab.page.keyboard.press("Enter")
    tab.wait_for_command(SaveImage())
    asking, watching = (each.tab.browser for each in (late, mine))
    assert viewer.senders[-1] == Sender(asking)
    assert asking != watching
    unmount(tab)


def test_two_who_edit_in_turns_see_the_same(mine: PropertiesPane, other: PropertiesPane) -> None:
    editor, watcher = mine, other
    for value in ("4", "15", "6", "17"):
        editor.enter("count", value)
        watcher.wait_for_value("count", value)
        editor, watcher = watcher, editor
    editor.field("filled").uncheck()
    watcher.tab.wait_for(lambda: not watcher.field("filled").is_checked())
    assert editor.field("count").input_value() == "17"


def test_two_who_edit_at_once_end_with_the_same(
    mine: PropertiesPane, other: PropertiesPane
) -> None:
    mine.field("channel").fill("mine")
    other.enter("channel", "other")
    other.wait_for_set("channel", "other")
    assert mine.field("channel").input_value() == "mine"
    mine.keyboard.press("Enter")
    other.wait_for_value("channel", "mine")
    other.field("channel").fill("half")
    mine.enter("channel", "again")
    mine.wait_for_set("channel", "again")
    other.keyboard.press("Escape")
    other.wait_for_value("channel", "again")
    mine.wait_for_value("channel", "again")


def test_a_field_that_was_left_or_has_the_focus_shows_what_another_has_entered(
    mine: PropertiesPane, other: PropertiesPane
) -> None:
    mine.enter("count", "0")
    mine.tab.wait_for(mine.row("count").get_by_role("alert").is_visible)
    mine.field("channel").focus()
    other.enter("count", "7")
    mine.wait_for_value("count", "7")
    assert mine.row("count").get_by_role("alert").is_hidden()
    mine.field("count").focus()
    other.enter("count", "8")
    mine.wait_for_value("count", "8")


def test_two_who_select_and_fold_do_so_for_themselves(
    viewer: PageBench, viewer_tab: ViewerTab, other_tab: ViewerTab
) -> None:
    tree, other = Tree(viewer_tab), Tree(other_tab)
    viewer.show(group("g", *named("a")), *named("b"))
    tree.wait_for_names("g", "a", "b")
    other.wait_for_names("g", "a", "b")
    tree.click("b")
    other.click("a")
    other.fold("g")
    other.wait_for_names("g", "b")
    assert tree.names() == ["g", "a", "b"]
    assert tree.selected() == ["b"]
    viewer.do(SetProperty(viewer.id("b"), "name", "renamed"))
    tree.wait_for_names("g", "a", "renamed")
    assert tree.selected() == ["renamed"]
    for name in ("a", "renamed"):
        viewer.do(RemoveDisplay(viewer.id(name)))
    tree.wait_for_names("g")
    assert tree.selected() == []


def test_two_who_look_have_views_of_their_own_with_their_numbers(
    viewer: PageBench, viewer_tab: ViewerTab, other_tab: ViewerTab
) -> None:
    for tab, changes in (
        (viewer_tab, {"type": "TopDownOrtho", "scale": 62.3}),
        (other_tab, {"type": "FPS", "yaw": 1.25}),
    ):
        for key, value in changes.items():
            viewer.do(ChangeView(key, value), Sender(tab.browser))
    for each, visible, hidden, path, value in (
        (viewer_tab, "Scale", "Position", "scale", "62.3"),
        (other_tab, "Position", "Scale", "yaw", "1.25"),
    ):
        each.show_tab("Views")
        panel = each.page.locator("#wv-panel")
        each.wait_for(lambda text=panel.inner_text, visible=visible: visible in text())
        assert hidden not in panel.inner_text()
        assert panel.locator(f"[data-path='{path}'] input").input_value() == value
        each.show_tab("Displays")


def test_a_browser_that_was_cut_off_comes_back_to_how_things_are_now(
    viewer: PageBench, mine: PropertiesPane
) -> None:
    mine.field("count").fill("5")
    cut_off = mine.tab.browser
    cut_connections(viewer.server)
    mine.tab.wait_for(lambda: mine.page.evaluate("webviz.browser") not in (None, cut_off))
    mine.change(count=9, channel="ring")
    mine.wait_for_value("channel", "ring")
    assert mine.field("count").input_value() == "5"
    mine.keyboard.press("Escape")
    mine.wait_for_value("count", "9")
    mine.enter("count", "4")
    mine.wait_for_set("count", 4)


def test_two_who_use_tools_select_them_and_are_answered_for_themselves(
    viewer: PageBench, viewer_tab: ViewerTab, other_tab: ViewerTab
) -> None:
    tab = viewer_tab
    viewer.show(*named("a"), tools=[GoalPose(name="Goal")])
    for each in (tab, other_tab):
        each.wait_for(lambda each=each: each.button("Goal").is_visible())
    tab.button("Goal").click()
    playwright.expect(tab.button("Goal")).to_have_attribute("aria-pressed", "true")
    playwright.expect(other_tab.button("Goal")).to_have_attribute("aria-pressed", "false")
    tab.page.mouse.move(600, 500)
    tab.page.mouse.down()
    tab.page.mouse.move(640, 500)
    tab.page.mouse.up()
    tab.wait_for(lambda: viewer.published())
    ((topic, goal),) = viewer.published()
    assert (topic, goal.header.frame_id) == ("/goal_pose", "map")
    tab.wait_for(lambda: "/goal_pose" in tab.page.locator(".wv-hint").inner_text())
    assert other_tab.page.locator(".wv-hint").inner_text() == ""


def test_two_who_look_into_topics_choose_for_themselves_until_one_leaves(
    viewer: PageBench, viewer_tab: ViewerTab, other_tab: ViewerTab
) -> None:
    """The last test of this module, since the other one is gone then."""
    tab = viewer_tab
    topics: tuple[str, ...] = ("/names", "/titles")
    for topic in topics:
        viewer.offer(topic, STRING, "/driver")
    for each, topic in ((other_tab, "/titles"), (tab, "/names")):
        each.show_tab("Topics")
        each.page.locator(".wv-cell-name").get_by_text(topic, exact=True).click()

    def inspected() -> set[str]:
        return {topic for topic in topics if topic in viewer.source.subscriptions}

    tab.wait_for(lambda: inspected() == set(topics))
    for topic, data in zip(topics, ("mine", "yours"), strict=True):
        viewer.publish(topic, STRING, {"data": data})
    tab.wait_for(lambda: "mine" in tab.text())
    other_tab.wait_for(lambda: "yours" in other_tab.text())
    assert "yours" not in tab.text()
    other_tab.page.close()
    tab.wait_for(lambda: inspected() == {"/names"})
    tab.page.locator(".wv-inspected").get_by_role("button", name="Close").click()
    tab.wait_for(lambda: inspected() == set())
