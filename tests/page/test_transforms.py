"""The panel "TF"."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from pages import bounds

from tests.page.page_bench import PageBench, PageServer
from tests.page.tabs import ViewerTab
from tests.support.stand_in import stand_in
from webviz.commands import FocusFrame
from webviz.data.rotations import Quaternion
from webviz.features.transforms import TransformsFeature, pair_of
from webviz.shell.testing.messages import Vector, stamped_transform
from webviz.shell.testing.source import SECOND

HOSTILE = "<img src=x onerror=alert(1)>"
MESSAGE = "tf2_msgs/msg/TFMessage"


@pytest.fixture
def viewer(page_server: PageServer, viewer_tab: ViewerTab) -> PageBench:
    """A viewer without transforms."""
    viewer = page_server.begin(is_linked=False)
    viewer_tab.catch_up()
    return viewer


@pytest.fixture
def panel(viewer: PageBench, viewer_tab: ViewerTab) -> Iterator[ViewerTab]:
    """The tab with the panel open, and nothing remembered of earlier tests."""
    viewer_tab.page.evaluate(
        "['tf-between', 'tf-folded'].map((k) => localStorage.removeItem(`webviz.${k}`))"
    )
    viewer_tab.show_tab("TF")
    yield viewer_tab
    viewer_tab.show_tab("Displays")


def move(
    viewer: PageBench,
    parent: str,
    frame: str,
    age_s: float = 0.123,
    samples: int = 20,
    xyz: Vector = (0.0, 0.0, 0.0),
    xyzw: Quaternion = (0.0, 0.0, 0.0, 1.0),
) -> None:
    """Publish transforms at 20 Hz, of which the newest is as old as said."""
    newest = viewer.source.now - round(age_s * SECOND)
    for number in reversed(range(samples)):
        stamp = newest - number * SECOND // 20
        stamped_transforms = [stamped_transform(parent, frame, stamp, xyz, xyzw)]
        viewer.publish("/tf", MESSAGE, {"transforms": stamped_transforms})
    viewer.turn()


@pytest.fixture
def tree(viewer: PageBench) -> PageBench:
    """The viewer with four frames in a row, the third of which has stopped."""
    viewer.offer("/tf", MESSAGE, "/slam")
    viewer.offer("/tf_static", MESSAGE, "/robot")
    move(viewer, "map", "odom", samples=100)
    move(viewer, "odom", "base", age_s=4.0, xyz=(7.0, 0.0, 0.0))
    viewer.link("base", "laser")
    return viewer


def rows(tab: ViewerTab) -> list[str]:
    """Return the texts of the rows, from top to bottom."""
    texts = tab.page.locator(".wv-frame").all_inner_texts()
    return [" ".join(text.split()) for text in texts]


def test_the_tree_is_made_while_a_page_shows_it(viewer: PageBench, panel: ViewerTab) -> None:
    panel.wait_for(lambda: viewer.states[-1].transforms is not None)
    panel.wait_for(lambda: "No transforms yet on /tf or /tf_static." in panel.text())
    viewer.link("map", "base_link")
    panel.wait_for(lambda: [row.split()[0] for row in rows(panel)] == ["map", "base_link"])
    panel.show_tab("Displays")
    panel.wait_for(lambda: viewer.states[-1].transforms is None)


def test_each_frame_has_its_publisher_rate_and_age(tree: PageBench, panel: ViewerTab) -> None:
    panel.wait_for(
        lambda: (
            rows(panel)
            == [
                "map",
                "odom /slam 20.0 Hz 120 ms",
                "base /slam 20.0 Hz 4.0 s",
                "laser /robot static",
            ]
        )
    )
    levels = panel.page.locator(".wv-frame").evaluate_all(
        "rows => rows.map((row) => row.getAttribute('aria-level'))"
    )
    assert levels == ["1", "2", "3", "4"]


def test_a_click_on_a_frame_tells_of_it_and_a_button_looks_at_it(
    tree: PageBench, panel: ViewerTab
) -> None:
    frame = panel.page.locator(".wv-frame-name").get_by_text("base", exact=True)
    frame.click()
    panel.wait_for(lambda: "base: in odom, 20.0 Hz, 4.0 s old, from /slam." in panel.text())
    assert not any(isinstance(each, FocusFrame) for each in tree.commands)
    panel.page.get_by_role("button", name="Look at").click()
    panel.wait_for_command(FocusFrame("base"))
    assert tree.senders[-1].browser == panel.browser
    assert tree.view(panel.browser).focal_point == pytest.approx((7.0, 0.0, 0.0))


@pytest.mark.parametrize("way", ["double click", "Enter"])
def test_frames_and_roots_are_looked_at(tree: PageBench, panel: ViewerTab, way: str) -> None:
    root = panel.page.locator(".wv-frame-name").get_by_text("map", exact=True)
    if way == "Enter":
        root.click()
        panel.page.keyboard.press("Enter")
    else:
        root.dblclick()
    panel.wait_for_command(FocusFrame("map"))
    assert tree.view(panel.browser).focal_point == pytest.approx((0.0, 0.0, 0.0))


def test_problems_are_marked_and_told(viewer: PageBench, panel: ViewerTab) -> None:
    move(viewer, "map", HOSTILE, age_s=4.0)
    viewer.link("moon", "crater")
    panel.wait_for(lambda: "No transform connects the 2 trees" in panel.text())
    row = panel.page.get_by_role("treeitem", name=HOSTILE)
    assert row.locator(".wv-dot").get_attribute("data-level") == "warn"
    row.locator(".wv-frame-name").click()
    panel.wait_for(lambda: f'"{HOSTILE}" has stopped: its last transform is' in panel.text())


def test_frames_in_a_loop_are_shown_once(viewer: PageBench, panel: ViewerTab) -> None:
    viewer.link("b", "a")
    viewer.link("a", "b")
    panel.wait_for(lambda: [row.split(" /")[0] for row in rows(panel)] == ["a", "b", "a (loop)"])


def test_frames_are_found_with_the_way_to_them(tree: PageBench, panel: ViewerTab) -> None:
    tree.link("map", "side")
    panel.wait_for(lambda: len(rows(panel)) == 5)
    panel.page.get_by_role("searchbox").fill("BASE")
    panel.wait_for(lambda: [row.split()[0] for row in rows(panel)] == ["map", "odom", "base"])
    panel.page.get_by_role("searchbox").fill("nothing")
    panel.wait_for(lambda: "No matching frames." in panel.text())


def test_a_frame_is_folded_by_its_mark_and_by_keys(tree: PageBench, panel: ViewerTab) -> None:
    panel.wait_for(lambda: len(rows(panel)) == 4)
    panel.page.locator(".wv-fold-mark").nth(1).click()
    panel.wait_for(lambda: len(rows(panel)) == 2)
    assert not any(isinstance(each, FocusFrame) for each in tree.commands)
    panel.page.get_by_role("tree", name="Frames").focus()
    for key in ("End", "ArrowRight"):
        panel.page.keyboard.press(key)
    panel.wait_for(lambda: len(rows(panel)) == 4)
    panel.page.keyboard.press("ArrowLeft")
    panel.wait_for(lambda: len(rows(panel)) == 2)


def choose(tab: ViewerTab, label: str, frame: str) -> None:
    field = tab.page.get_by_role("combobox", name=label, exact=True)
    field.fill(frame)
    field.press("Enter")


def test_the_transform_between_two_frames_is_read_out(viewer: PageBench, panel: ViewerTab) -> None:
    turned_left = (0.0, 0.0, 0.5**0.5, 0.5**0.5)
    move(viewer, "map", "base", age_s=0.02, xyz=(3.0, -4.0, 0.0), xyzw=turned_left)
    viewer.link("moon", "crater")
    choose(panel, "Frame", "base")
    choose(panel, "In frame", "map")
    panel.wait_for(lambda: "5.000 m" in panel.text())
    assert list(viewer.states[-1].between) == [("map", "base")]
    text = " ".join(panel.text().split())
    for part in ("3.000 −4.000 0.000 m", "0.0000 0.0000 0.7071 0.7071", "0.0° 0.0° 90.0°"):  # noqa: RUF001
        assert part in text
    assert "At the newest common time, 20 ms ago." in text
    choose(panel, "In frame", "moon")
    panel.wait_for(lambda: '"base" and "moon" are in two trees' in panel.text())
    assert "5.000 m" not in panel.text()
    panel.button("Swap the frames").click()
    panel.wait_for(lambda: list(viewer.states[-1].between) == [("base", "moon")])


@pytest.mark.parametrize("argument", ["", "map", '["map"]', '["map", 1]', "[" * 5000, '{"a": 1}'])
def test_what_names_no_two_frames_is_ignored(argument: str) -> None:
    assert pair_of(argument) is None
    feature = stand_in(TransformsFeature, transform_between=lambda pair: None)
    assert feature.between(argument) is None


@pytest.fixture
def picture(tree: PageBench, panel: ViewerTab) -> Iterator[ViewerTab]:
    """The tab with the tree of a thousand frames as a picture."""
    for n in range(999):
        above = "base" if n < 10 else f"link_{n // 3}"
        tree.transform(above, f"link_{n}", 0, static=True)
    tree.turn()
    panel.page.get_by_role("button", name="Show the tree as a picture").click()
    yield panel
    panel.page.get_by_role("dialog").get_by_role("button", name="Close").click()


def test_the_tree_is_a_picture_in_which_frames_are_found(picture: ViewerTab) -> None:
    dialog = picture.page.get_by_role("dialog", name="Transform tree")
    canvas = dialog.get_by_role("img", name="Tree of 1003 frames, 1 of them with faults")
    picture.wait_for(canvas.is_visible)
    search = dialog.get_by_role("searchbox", name="Find frames")
    search.fill("base")
    picture.wait_for(lambda: "1 of 1003" in dialog.inner_text())
    search.press("Enter")
    picture.wait_for(lambda: "base: in odom, 20.0 Hz" in dialog.inner_text())
    assert '"base" has stopped: ' in dialog.inner_text()
    search.fill("odom")
    search.press("Enter")  # it is in the middle then
    picture.wait_for(lambda: "odom: in map" in dialog.inner_text())
    box = bounds(canvas)
    canvas.click(position={"x": box["width"] / 2, "y": 2})
    picture.wait_for(lambda: "Click a frame for details." in dialog.inner_text())
    canvas.click(position={"x": box["width"] / 2, "y": box["height"] / 2})
    picture.wait_for(
        lambda: "odom: in map, 20.0 Hz, 120 ms old, from /slam." in dialog.inner_text()
    )


def test_names_in_the_picture_are_no_markup(viewer: PageBench, panel: ViewerTab) -> None:
    viewer.link("map", HOSTILE)
    panel.page.get_by_role("button", name="Show the tree as a picture").click()
    dialog = panel.page.get_by_role("dialog", name="Transform tree")
    search = dialog.get_by_role("searchbox", name="Find frames")
    search.fill("onerror")
    panel.wait_for(lambda: "1 of 2" in dialog.inner_text())
    search.press("Enter")
    panel.wait_for(lambda: f"{HOSTILE}: in map" in dialog.inner_text())
    assert dialog.locator("img[src]").count() == 0
    panel.page.get_by_role("dialog").get_by_role("button", name="Close").click()
