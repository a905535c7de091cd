"""Properties of several displays, edited together."""

from __future__ import annotations

from typing import Annotated

import playwright.sync_api as playwright
import pytest

from tests.page.everything import Everything, named
from tests.page.page_bench import PageBench
from tests.page.tabs import ViewerTab
from tests.page.trees import Tree
from webviz.api.declared import Color, Prop, Topic
from webviz.api.display import Display, Input
from webviz.commands import Redo, SetProperty, Undo


class Other(Display):
    """A display that has two properties and the QoS in common with `Everything`."""

    topic: Annotated[Topic, Input("nav_msgs/msg/Path")] = Topic("/plan")
    alpha: Annotated[float, Prop(ge=0, le=1)] = 0.7
    color: Color = (255, 25, 0)
    count: str = "also a count, but a text"


@pytest.fixture
def tree(viewer_tab: ViewerTab) -> Tree:
    return Tree(viewer_tab)


def select(tree: Tree, *names: str) -> None:
    tree.click(names[0])
    for name in names[1:]:
        tree.click(name, modifiers=["Control"])
    playwright.expect(tree.details.get_by_role("heading")).to_have_text(f"{len(names)} displays")


def field(tree: Tree, path: str) -> playwright.Locator:
    return tree.details.locator(f"[data-path='{path}']").locator("input, select, textarea").first


def changed(viewer: PageBench, path: str, a: object, b: object) -> list[SetProperty]:
    """The commands that set a property of the displays a and b."""
    return [SetProperty(viewer.id(name), path, value) for name, value in (("a", a), ("b", b))]


def test_a_common_value_is_changed_in_all_as_one_step(viewer: PageBench, tree: Tree) -> None:
    sizes = {"a": 0.5, "b": 0.25, "c": 4.0}
    viewer.show(*(Everything(name=name, size=size) for name, size in sizes.items()))
    select(tree, "a", "b")
    size = field(tree, "size")
    tree.tab.wait_for(lambda: size.count() == 1)  # the loop turns, which `expect` does not
    playwright.expect(size).to_have_value("")
    playwright.expect(size).to_have_attribute("placeholder", "Mixed")
    playwright.expect(field(tree, "count")).to_have_value("3")
    for value in (0.75, 0.8):
        size.fill(str(value))
        tree.press("Enter")
        both = changed(viewer, "size", value, value)
        tree.tab.wait_for(lambda both=both: viewer.commands[-2:] == both)
        assert viewer.values("size") == [value, value, 4.0]
    assert len({sender.step for sender in viewer.senders}) == 1
    assert viewer.senders[0].step
    playwright.expect(size).to_have_value("0.8")
    field(tree, "count").fill("5")
    tree.press("Enter")
    tree.tab.wait_for(lambda: viewer.commands[-2:] == changed(viewer, "count", 5, 5))
    assert viewer.senders[-1].step != viewer.senders[0].step
    viewer.do(Undo())
    assert viewer.values("count") == [3, 3, 3]
    viewer.do(Undo())
    assert viewer.values("size") == [0.5, 0.25, 4.0]
    viewer.do(Redo(2))

    size.fill("-1")
    tree.press("Enter")
    refusal = tree.details.get_by_role("alert")
    tree.tab.wait_for(refusal.is_visible)
    assert refusal.inner_text().startswith("a: ")
    tree.press("Escape")


def test_mixed_values_are_marked_in_each_kind_of_control(viewer: PageBench, tree: Tree) -> None:
    second = {
        "frame": "odom",
        "alpha": 0.5,
        "style": "Boxes",
        "color": (1, 2, 3),
        "filled": False,
        "prefixes": ["x"],
    }
    viewer.show(*named("a"), Everything(name="b", offset=(0.0, 0.5, 2.0), **second))
    select(tree, "a", "b")
    tree.tab.wait_for(lambda: field(tree, "frame").count() == 1)
    for path in ("frame", "prefixes", "style"):
        playwright.expect(field(tree, path)).to_have_attribute("placeholder", "Mixed")
        playwright.expect(field(tree, path)).to_have_value("")
    row = tree.details.locator("[data-path='color']")
    playwright.expect(row.get_by_label("Color, as text")).to_have_attribute("placeholder", "Mixed")
    playwright.expect(field(tree, "alpha")).to_have_attribute("aria-valuetext", "Mixed")
    assert field(tree, "filled").evaluate("e => e.indeterminate")
    assert field(tree, "edge").is_hidden()  # which belongs to one of the styles

    offset = tree.details.locator("[data-path='offset'] input")
    assert [each.input_value() for each in offset.all()] == ["0", "0.5", ""]
    offset.nth(0).fill("1")
    tree.press("Enter")
    both = changed(viewer, "offset", [1, 0.5, 0.0], [1, 0.5, 2.0])
    tree.tab.wait_for(lambda: viewer.commands[-2:] == both)
    assert viewer.values("offset") == [(1.0, 0.5, 0.0), (1.0, 0.5, 2.0)]


def test_displays_of_other_types_share_what_they_declare_alike(
    viewer: PageBench, tree: Tree
) -> None:
    viewer.show(*named("a"), Other(name="b"))
    select(tree, "a", "b")
    rows = tree.details.locator(".wv-property")
    tree.tab.wait_for(lambda: rows.count() == 6)
    paths = [row.get_attribute("data-path") for row in rows.all()]
    qos = ["topic.depth", "topic.reliability", "topic.durability", "topic.filter_size"]
    assert sorted(map(str, paths)) == sorted([*qos, "alpha", "color"])
    number = tree.details.locator("[data-path='alpha']").get_by_role("spinbutton")
    number.fill("0.5")
    tree.press("Enter")
    tree.tab.wait_for(lambda: viewer.commands[-2:] == changed(viewer, "alpha", 0.5, 0.5))
    assert viewer.values("alpha") == [0.5, 0.5]


def test_several_are_selected_without_keys(viewer: PageBench, tree: Tree) -> None:
    viewer.show(*named("a", "b", "c"))
    tree.click("a")
    for expected in (["a", "c"], ["b"]):
        tree.tab.button("List options").click()
        tree.tab.page.get_by_role("menu").get_by_text("Select several").click()
        tree.click(expected[-1])
        assert tree.selected() == expected
