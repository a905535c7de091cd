"""The panel "TF"."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from msgspec.structs import replace

from tests.page.conftest import Loop, Tab
from tests.support.stand_ins import stand_in
from webviz.commands import FocusFrame, InspectTransforms
from webviz.data.transforms import Diagnosis, FrameReport
from webviz.features.transforms import Between, TransformsFeature, pair_of

HOSTILE = "<img src=x onerror=alert(1)>"
ODOM = FrameReport("odom", "map", False, ("/slam",), 20.04, 1, 123_000_000, None, 200, 10, ())
BASE = replace(ODOM, frame="base", parent="odom", publishers=("/robot",), age_ns=4_000_000_000)
LASER = FrameReport("laser", "base", True, ("/robot",), 0.0, 0, None, None, 1, 0, ())
TREE = Diagnosis(("map",), (), (ODOM, BASE, LASER))


@pytest.fixture
def panel(tab: Tab) -> Iterator[Tab]:
    """The tab with the panel open, and nothing remembered of earlier tests."""
    tab.page.evaluate(
        "['tf-between', 'tf-folded'].map((k) => localStorage.removeItem(`webviz.${k}`))"
    )
    tab.show_tab("TF")
    # By then it gets what the others show.
    tab.wait_for_command(InspectTransforms(tree=True))
    yield tab
    tab.show_tab("Displays")
    # Else the next test may open it before anybody noticed.
    tab.wait_for_command(InspectTransforms(tree=False))


def rows(tab: Tab) -> list[str]:
    """Return the texts of the rows, from top to bottom."""
    texts = tab.page.locator(".wv-frame").all_inner_texts()
    return [" ".join(text.split()) for text in texts]


def test_the_tree_is_made_while_a_page_shows_it(loop: Loop, panel: Tab) -> None:
    panel.wait_for_command(InspectTransforms(tree=True))
    loop.show(transforms=Diagnosis((), (), ()))
    panel.wait_for(lambda: "No transforms yet on /tf or /tf_static." in panel.text())
    panel.show_tab("Displays")
    panel.wait_for_command(InspectTransforms(tree=False))


def test_each_frame_has_its_publisher_rate_and_age(loop: Loop, panel: Tab) -> None:
    loop.show(transforms=TREE)
    panel.wait_for(
        lambda: (
            rows(panel)
            == [
                "map",
                "odom /slam 20.0 Hz 120 ms",
                "base /robot 20.0 Hz 4.0 s",
                "laser /robot static",
            ]
        )
    )
    levels = panel.page.locator(".wv-frame").evaluate_all(
        "rows => rows.map((row) => row.getAttribute('aria-level'))"
    )
    assert levels == ["1", "2", "3", "4"]


def test_a_click_on_a_frame_tells_of_it_and_a_button_looks_at_it(loop: Loop, panel: Tab) -> None:
    loop.show(transforms=TREE)
    frame = panel.page.locator(".wv-frame-name").get_by_text("base", exact=True)
    frame.click()
    panel.wait_for(lambda: "base: in odom, 20.0 Hz, 4.0 s old, from /robot." in panel.text())
    assert not any(isinstance(each, FocusFrame) for each in loop.commands)
    panel.page.get_by_role("button", name="Look at").click()
    panel.wait_for_command(FocusFrame("base"))
    assert loop.senders[-1].browser is not None


@pytest.mark.parametrize("way", ["double click", "Enter"])
def test_frames_and_roots_are_looked_at(loop: Loop, panel: Tab, way: str) -> None:
    loop.show(transforms=TREE)
    root = panel.page.locator(".wv-frame-name").get_by_text("map", exact=True)
    if way == "Enter":
        root.click()
        panel.page.keyboard.press("Enter")
    else:
        root.dblclick()
    panel.wait_for_command(FocusFrame("map"))


def test_problems_are_marked_and_told(loop: Loop, panel: Tab) -> None:
    stale = replace(BASE, problems=(f'"base" has stopped {HOSTILE}.',))
    loop.show(transforms=Diagnosis(("map", "moon"), (), (ODOM, stale)))
    panel.wait_for(lambda: "No transform connects the 2 trees" in panel.text())
    row = panel.page.get_by_role("treeitem", name="base")
    assert row.locator(".wv-dot").get_attribute("data-level") == "warn"
    row.locator(".wv-frame-name").click()
    panel.wait_for(lambda: f'"base" has stopped {HOSTILE}.' in panel.text())


def test_frames_in_a_loop_are_shown_once(loop: Loop, panel: Tab) -> None:
    a, b = replace(ODOM, frame="a", parent="b"), replace(ODOM, frame="b", parent="a")
    loop.show(transforms=Diagnosis((), (("a", "b", "a"),), (a, b)))
    panel.wait_for(lambda: [row.split(" /")[0] for row in rows(panel)] == ["a", "b", "a (loop)"])


def test_frames_are_found_with_the_way_to_them(loop: Loop, panel: Tab) -> None:
    side = replace(ODOM, frame="side", parent="map")
    loop.show(transforms=Diagnosis(("map",), (), (ODOM, BASE, LASER, side)))
    panel.page.get_by_role("searchbox").fill("BASE")
    panel.wait_for(lambda: [row.split()[0] for row in rows(panel)] == ["map", "odom", "base"])
    panel.page.get_by_role("searchbox").fill("nothing")
    panel.wait_for(lambda: "No matching frames." in panel.text())


def test_a_frame_is_folded_by_its_mark_and_by_keys(loop: Loop, panel: Tab) -> None:
    loop.show(transforms=TREE)
    panel.wait_for(lambda: len(rows(panel)) == 4)
    panel.page.locator(".wv-fold-mark").nth(1).click()
    panel.wait_for(lambda: len(rows(panel)) == 2)
    assert not any(isinstance(each, FocusFrame) for each in loop.commands)
    panel.page.get_by_role("tree", name="Frames").focus()
    for key in ("End", "ArrowRight"):
        panel.page.keyboard.press(key)
    panel.wait_for(lambda: len(rows(panel)) == 4)
    panel.page.keyboard.press("ArrowLeft")
    panel.wait_for(lambda: len(rows(panel)) == 2)


def choose(tab: Tab, label: str, frame: str) -> None:
    field = tab.page.get_by_role("combobox", name=label, exact=True)
    field.fill(frame)
    field.press("Enter")


def test_the_transform_between_two_frames_is_read_out(loop: Loop, panel: Tab) -> None:
    loop.show(transforms=TREE)
    choose(panel, "Frame", "base")
    choose(panel, "In frame", "map")
    pair = ("map", "base")
    panel.wait_for_command(InspectTransforms(tree=True, between=frozenset({pair})))
    turned = (0.0, 0.0, 0.70711, 0.70711)
    loop.show(transforms=TREE, between={pair: Between((3.0, -4.0, 0.0), turned, 0.02)})
    panel.wait_for(lambda: "5.000 m" in panel.text())
    text = " ".join(panel.text().split())
    for part in ("3.000 −4.000 0.000 m", "0.0000 0.0000 0.7071 0.7071", "0.0° 0.0° 90.0°"):  # noqa: RUF001
        assert part in text
    assert "At the newest common time, 20 ms ago." in text
    loop.show(transforms=TREE, between={pair: Between(problem="No transform connects them.")})
    panel.wait_for(lambda: "No transform connects them." in panel.text())
    assert "5.000 m" not in panel.text()
    panel.button("Swap the frames").click()
    swapped = frozenset({("base", "map")})
    panel.wait_for_command(InspectTransforms(tree=True, between=swapped))


@pytest.mark.parametrize("argument", ["", "map", '["map"]', '["map", 1]', "[" * 5000, '{"a": 1}'])
def test_what_names_no_two_frames_is_ignored(argument: str) -> None:
    assert pair_of(argument) is None
    shown = stand_in(TransformsFeature, transform_between=lambda pair: None)
    assert shown.between(argument) is None


@pytest.fixture
def picture(loop: Loop, panel: Tab) -> Iterator[Tab]:
    """The tab with the tree of a thousand frames as a picture."""
    links = [
        replace(LASER, frame=f"link_{n}", parent="base" if n < 10 else f"link_{n // 3}")
        for n in range(1000)
    ]
    stale = replace(BASE, problems=("It has stopped.",))
    loop.show(transforms=Diagnosis(("map",), (), (ODOM, stale, *links)))
    panel.page.get_by_role("button", name="Show the tree as a picture").click()
    yield panel
    panel.page.get_by_role("dialog").get_by_role("button", name="Close").click()


def test_the_tree_is_a_picture_in_which_frames_are_found(loop: Loop, picture: Tab) -> None:
    dialog = picture.page.get_by_role("dialog", name="Transform tree")
    canvas = dialog.get_by_role("img", name="Tree of 1003 frames, 1 of them with faults")
    picture.wait_for(canvas.is_visible)
    search = dialog.get_by_role("searchbox", name="Find frames")
    search.fill("base")
    picture.wait_for(lambda: "1 of 1003" in dialog.inner_text())
    search.press("Enter")
    picture.wait_for(lambda: "base: in odom, 20.0 Hz" in dialog.inner_text())
    assert "It has stopped." in dialog.inner_text()
    search.fill("odom")
    search.press("Enter")  # it is in the middle then
    picture.wait_for(lambda: "odom: in map" in dialog.inner_text())
    box = canvas.bounding_box()
    assert box is not None
    canvas.click(position={"x": box["width"] / 2, "y": 2})
    picture.wait_for(lambda: "Click a frame for details." in dialog.inner_text())
    canvas.click(position={"x": box["width"] / 2, "y": box["height"] / 2})
    picture.wait_for(
        lambda: "odom: in map, 20.0 Hz, 120 ms old, from /slam." in dialog.inner_text()
    )


def test_names_in_the_picture_are_no_markup(loop: Loop, panel: Tab) -> None:
    loop.show(transforms=Diagnosis(("map",), (), (replace(ODOM, frame=HOSTILE),)))
    panel.page.get_by_role("button", name="Show the tree as a picture").click()
    dialog = panel.page.get_by_role("dialog", name="Transform tree")
    search = dialog.get_by_role("searchbox", name="Find frames")
    search.fill("onerror")
    panel.wait_for(lambda: "1 of 2" in dialog.inner_text())
    search.press("Enter")
    panel.wait_for(lambda: f"{HOSTILE}: in map" in dialog.inner_text())
    assert dialog.locator("img[src]").count() == 0
    panel.page.get_by_role("dialog").get_by_role("button", name="Close").click()
