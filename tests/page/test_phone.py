"""The page on a phone, which is touched and has little space."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import playwright.sync_api as playwright
import pytest
from pages import bounds

from tests.page.everything import group, named
from tests.page.page_bench import SCAN, PageBench, PageServer
from tests.page.tabs import ViewerTab
from tests.page.test_rewinding import look_back, remembering
from tests.page.test_teleop import LIMITS, card, open_card, wait_for_share
from tests.page.test_timeline import bag as bag
from tests.page.test_timeline import play as play
from tests.page.test_toolbar import GOAL, POINT, overflow, toolbar
from tests.page.test_tree_drag import at
from tests.page.trees import Tree
from webviz.api.vehicle import STILL
from webviz.commands import MoveDisplay, Save, SaveMemory
from webviz.tools.goal_pose import GoalPose
from webviz.tools.publish_point import PublishPoint

WIDTH, HEIGHT = 390, 844
FINGER_PX = 40
HIT = """(element) => {
  const { left, right, top, bottom } = element.getBoundingClientRect();
  const [x, y] = [(left + right) / 2, (top + bottom) / 2];
  const reach = [...Array(61).keys()].map((i) => i - 30);
  const isHit = (x, y) => element.contains(document.elementFromPoint(x, y));
  return [reach.filter((d) => isHit(x + d, y)).length, reach.filter((d) => isHit(x, y + d)).length];
}"""
"""Width and height of an element for a finger."""
SAVE_LAST = re.compile(r"Save last \d+ s")


@pytest.fixture(scope="module")
def lasting_phone(open_lasting_viewer_tab: Callable[..., ViewerTab]) -> ViewerTab:
    return open_lasting_viewer_tab(WIDTH, HEIGHT, has_touch=True, is_mobile=True)


@pytest.fixture
def phone(viewer: PageBench, viewer_tab: ViewerTab, lasting_phone: ViewerTab) -> ViewerTab:
    """A phone with the panels closed."""
    lasting_phone.page.set_viewport_size({"width": WIDTH, "height": HEIGHT})
    lasting_phone.page.keyboard.press("Escape")
    # They may just be closing.
    lasting_phone.button("Hide the panels").evaluate_all(
        "found => found.forEach((one) => one.click())"
    )
    return lasting_phone


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    """The path of a config file."""
    return tmp_path / "lab.yaml"


def side(phone: ViewerTab) -> playwright.Locator:
    return phone.page.get_by_role("complementary", name="Panels")


def test_the_scene_is_free_until_the_side_is_opened_over_it(phone: ViewerTab, lab: Path) -> None:
    phone.viewer.show(*named("a"), path=lab)
    playwright.expect(side(phone)).to_be_hidden()
    assert phone.page.locator(".mantine-Paper-root:visible").count() == 0
    canvas = phone.page.locator("#root canvas").first.bounding_box()
    phone.button("Show the panels").tap()
    phone.wait_for(lambda: "lab.yaml" in side(phone).inner_text())
    sheet = bounds(side(phone))
    assert (sheet["x"], sheet["width"]) == (0, WIDTH)
    assert 0.25 * HEIGHT < sheet["y"] < 0.45 * HEIGHT
    assert phone.page.locator("#root canvas").first.bounding_box() == canvas
    phone.page.touchscreen.tap(200, 200)  # beside it
    playwright.expect(side(phone)).to_be_hidden()


def test_buttons_can_be_hit_with_a_finger(phone: ViewerTab, lab: Path) -> None:
    phone.viewer.show(path=lab)
    phone.button("Show the panels").tap()
    for name in ("Menu", "Commands", "Hide the panels", "Show the panels"):
        box = bounds(phone.button(name))
        assert box["height"] >= FINGER_PX, name
        assert box["width"] >= FINGER_PX, name
        assert box["x"] >= 0, name
        assert box["x"] + box["width"] <= WIDTH, name
    phone.button("Menu").tap()
    item = phone.page.get_by_role("menuitem", name="Save Ctrl+S")
    box = bounds(item)
    assert box["height"] >= FINGER_PX
    item.tap()
    phone.wait_for_command(Save())
    assert lab.exists()


def test_rows_and_heads_of_panels_can_be_hit_with_a_finger(phone: ViewerTab) -> None:
    viewer = phone.viewer
    viewer.source.topics.clear()
    viewer.offer("/scan", SCAN, "/driver")
    phone.button("Show the panels").tap()
    phone.show_tab("Topics")
    phone.wait_for(lambda: phone.page.locator(".wv-topic").count() == 1)
    phone.page.locator(".wv-topic").tap()
    phone.wait_for(lambda: "/scan" in viewer.source.subscriptions)
    viewer.publish("/scan", SCAN, {})
    phone.wait_for(lambda: phone.page.locator(".wv-field-row").count() > 3)
    assert too_small(phone) == []
    phone.show_tab("TF")
    phone.wait_for(lambda: phone.page.locator(".wv-frame").count() == 2)
    assert too_small(phone) == []
    assert min(phone.page.locator(".wv-fold-mark").first.evaluate(HIT)) >= FINGER_PX - 1
    phone.show_tab("Displays")
    assert min(phone.page.locator(".wv-tree-fold").first.evaluate(HIT)) >= FINGER_PX - 1


def test_of_more_tabs_than_fit_the_open_one_is_in_sight(phone: ViewerTab) -> None:
    phone.page.set_viewport_size({"width": 250, "height": HEIGHT})
    phone.button("Show the panels").tap()
    tab = phone.page.get_by_role("tab").last
    first = phone.page.get_by_role("tab").first
    playwright.expect(first).to_be_visible()
    first.press("ArrowLeft")
    playwright.expect(tab).to_be_in_viewport(ratio=0.95)
    assert phone.page.evaluate("document.documentElement.scrollWidth") == 250
    phone.page.keyboard.press("ArrowRight")
    playwright.expect(first).to_be_in_viewport(ratio=0.95)
    first.hover()
    phone.page.mouse.wheel(0, 300)
    playwright.expect(tab).to_be_in_viewport(ratio=0.95)
    phone.button("All panels").tap()
    phone.page.get_by_role("menuitemradio", name="Displays").tap()
    playwright.expect(first).to_be_in_viewport(ratio=0.95)
    assert first.get_attribute("aria-selected") == "true"
    phone.page.set_viewport_size({"width": WIDTH, "height": HEIGHT})
    playwright.expect(phone.button("All panels")).to_be_hidden()


def too_small(phone: ViewerTab) -> list[str]:
    """Return the elements of the panel that can be tapped but are too low."""
    return phone.page.locator(".wv-panel").evaluate(
        """(panel, least) => [...panel.querySelectorAll("button, input, select, .wv-row")]
          .filter((one) => one.checkVisibility() && one.getBoundingClientRect().height < least)
          .map((one) => `${one.className} ${one.getBoundingClientRect().height}`)""",
        FINGER_PX,
    )


def test_dialogs_fit(
    page_server: PageServer, phone: ViewerTab, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "a folder" / ("with_a_long_name" * 10)
    folder.mkdir(parents=True)
    monkeypatch.chdir(folder)
    page_server.begin()
    phone.button("Show the panels").tap()
    phone.wait_for(lambda: "webviz" in side(phone).inner_text())
    phone.button("Menu").tap()
    phone.page.get_by_role("menuitem", name="Save as…").tap()
    assert "with_a_long_name" in phone.page.get_by_role("dialog").inner_text()
    box = bounds(phone.page.get_by_role("dialog"))
    assert box["x"] >= 0
    assert box["x"] + box["width"] <= WIDTH
    assert phone.page.evaluate("document.documentElement.scrollWidth") == WIDTH


@pytest.mark.parametrize("width", [360, 390, 430])
def test_everything_is_inside_the_toolbar(phone: ViewerTab, width: int) -> None:
    phone.page.set_viewport_size({"width": width, "height": HEIGHT})
    phone.wait_for(lambda: phone.page.evaluate("innerWidth") == width)
    phone.viewer.show(tools=[GoalPose(name=GOAL.name), PublishPoint(name=POINT.name)])
    bar = toolbar(phone)
    more = bar.get_by_role("button", name="More")
    phone.wait_for(lambda: bar.get_by_role("button", name="2D Goal Pose").is_visible())
    phone.wait_for(more.is_visible)
    assert overflow(bar) == []
    playwright.expect(bar.get_by_role("combobox", name="Follow")).to_be_in_viewport(ratio=1)
    rates = phone.page.locator(".wv-top-right").bounding_box()
    box = bounds(bar)
    assert rates is not None
    assert box["x"] + box["width"] <= width
    assert rates["y"] >= box["y"] + box["height"]


def right_edges(phone: ViewerTab, *names: str) -> list[float]:
    """Return the right edges of buttons, in pixels."""
    boxes = [phone.button(name).bounding_box() for name in names]
    return [box["x"] + box["width"] if box else 999.0 for box in boxes]


def test_the_track_and_buttons_of_a_recording_are_within_the_width(
    phone: ViewerTab, play: Callable[[Path], PageBench], bag: Path
) -> None:
    play(bag)
    phone.wait_for(lambda: phone.page.locator(".wv-track").count() == 1)
    names = ("Play", "Previous message", "Next message", "Rate", "Loop", "Topics")
    assert max(right_edges(phone, *names)) <= WIDTH
    box = phone.page.get_by_label("Go to time").bounding_box()
    assert box
    assert box["x"] + box["width"] <= WIDTH


@pytest.fixture
def live(page_server: PageServer, phone: ViewerTab) -> Iterator[PageBench]:
    """A viewer of live topics with a memory."""
    yield remembering(page_server)
    page_server.begin()


def test_what_just_happened_can_be_saved(
    phone: ViewerTab, live: PageBench, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    save = phone.page.get_by_role("button", name=SAVE_LAST)
    phone.wait_for(save.is_visible)
    name = save.get_attribute("aria-label") or ""
    assert max(right_edges(phone, "Pause", "Topics", "Record", name)) <= WIDTH
    look_back(live, 12.4)
    phone.wait_for(lambda: phone.button("Live (L)").is_visible())
    name = phone.page.locator(".wv-save-last").get_attribute("aria-label") or ""
    assert max(right_edges(phone, "Next message", "Live (L)", name)) <= WIDTH
    phone.button(name).click()
    phone.wait_for_command(SaveMemory())
    assert [*tmp_path.glob("*/*.mcap")]


def test_fingers_drive_ahead_and_sideways(phone: ViewerTab) -> None:
    open_card(phone, lateral=LIMITS.lateral)
    box = bounds(card(phone))
    assert box["x"] >= 0
    assert box["x"] + box["width"] <= WIDTH
    session = phone.page.context.new_cdp_session(phone.page)

    def touch(kind: str, *targets: tuple[str, float]) -> None:
        points = []
        for name, up in targets:
            place = bounds(phone.page.locator(name))
            x, y = place["x"] + place["width"] / 2, place["y"] + place["height"] / 2
            points.append({"x": x, "y": y - up, "id": len(points)})
        session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    touch("touchStart", (".wv-stick", 0))
    touch("touchMove", (".wv-stick", 300))
    wait_for_share(phone, 1, 0, 0)
    touch("touchEnd")
    wait_for_share(phone, *STILL)
    left = phone.button("Drive to the left")
    playwright.expect(left).to_be_visible()
    assert min((left.bounding_box() or {}).get(side, 0) for side in ("width", "height")) >= 40
    touch("touchStart", ("[aria-label='Drive to the left']", 0))
    wait_for_share(phone, 0, 1, 0)
    touch("touchEnd")
    wait_for_share(phone, *STILL)
    phone.page.keyboard.press("Escape")
    playwright.expect(card(phone)).to_have_count(0)


class Finger:
    """One finger on a touch screen."""

    def __init__(self, page: playwright.Page) -> None:
        self._page = page
        self._session = page.context.new_cdp_session(page)

    def _send(self, kind: str, *points: tuple[float, float]) -> None:
        touches: list[dict[str, Any]] = [{"x": x, "y": y} for x, y in points]
        self._session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": touches})

    def hold(self, x: float, y: float) -> None:
        """Rest on a place."""
        self._send("touchStart", (x, y))
        self._page.locator(".wv-tree-held").wait_for()

    def move(self, x: float, y: float) -> None:
        """Go to a place."""
        self._send("touchMove", (x, y))

    def lift(self) -> None:
        """Leave the screen."""
        self._send("touchEnd")


@pytest.fixture
def tree(phone: ViewerTab) -> Tree:
    """Open the tree on a tablet, where the panels are beside the scene."""
    phone.page.set_viewport_size({"width": 800, "height": 900})
    phone.viewer.show(group("g"), *named("d", "e"))
    tree = Tree(phone)
    tree.wait_for_names("g", "d", "e")
    return tree


def test_a_finger_that_rests_on_a_row_drags_it(viewer: PageBench, tree: Tree) -> None:
    move_command = MoveDisplay(viewer.id("e"), viewer.id("g"), "")
    finger = Finger(tree.tab.page)
    x, y = at(tree, "e", 0.5)
    finger.hold(x, y)
    for step in (0.3, 0.7, 1.0):
        finger.move(x, y + step * (at(tree, "g", 0.5)[1] - y))
    finger.lift()
    tree.tab.wait_for_command(move_command)
    assert viewer.outline() == "g(e) d"


def test_a_finger_that_rests_and_leaves_opens_the_menu(tree: Tree) -> None:
    finger = Finger(tree.tab.page)
    finger.hold(*at(tree, "d", 0.5))
    finger.lift()
    tree.item("Remove").wait_for()
    assert tree.selected() == ["d"]
    tree.tab.turn()
    assert tree.item("Remove").is_visible()
