"""Properties of several displays, edited together."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated

import playwright.sync_api as playwright
import pytest

from tests.page.conftest import Tab
from tests.page.trees import Tree
from webviz.api.declared import Color, Prop, Topic
from webviz.api.display import Display, Input
from webviz.commands import SetProperty
from webviz.engine.state import Row

MakeRow = Callable[..., Row]


class Other(Display):
    """A display that has two properties and the QoS in common with `Everything`."""

    topic: Annotated[Topic, Input("nav_msgs/msg/Path")] = Topic("/plan")
    alpha: Annotated[float, Prop(ge=0, le=1)] = 0.7
    color: Color = (255, 25, 0)
    count: str = "also a count, but a text"


@pytest.fixture
def tree(tab: Tab) -> Tree:
    return Tree(tab)


def select(tree: Tree, *names: str) -> None:
    tree.click(names[0])
    for name in names[1:]:
        tree.click(name, modifiers=["Control"])
    playwright.expect(tree.details.get_by_role("heading")).to_have_text(f"{len(names)} displays")


def field(tree: Tree, path: str) -> playwright.Locator:
    return tree.details.locator(f"[data-path='{path}']").locator("input, select, textarea").first


def test_a_common_value_is_changed_in_all_as_one_step(tree: Tree, make_row: MakeRow) -> None:
    loop = tree.tab.loop
    loop.show(make_row("a", size=0.5), make_row("b", size=0.25), make_row("c", size=4.0))
    select(tree, "a", "b")
    size = field(tree, "size")
    tree.tab.wait_for(lambda: size.count() == 1)  # the loop turns, which `expect` does not
    playwright.expect(size).to_have_value("")
    playwright.expect(size).to_have_attribute("placeholder", "Mixed")
    playwright.expect(field(tree, "count")).to_have_value("3")
    for text in ("0.75", "0.8"):
        size.fill(text)
        tree.press("Enter")
        changed = [SetProperty(one, "size", float(text)) for one in "ab"]
        tree.tab.wait_for(lambda changed=changed: loop.commands[-2:] == changed)
    assert len({sender.step for sender in loop.senders}) == 1
    assert loop.senders[0].step
    playwright.expect(size).to_have_value("0.8")
    field(tree, "count").fill("5")
    tree.press("Enter")
    tree.tab.wait_for(lambda: loop.commands[-2:] == [SetProperty(one, "count", 5) for one in "ab"])
    assert loop.senders[-1].step != loop.senders[0].step

    size.fill("-1")
    tree.press("Enter")
    refusal = tree.details.get_by_role("alert")
    tree.tab.wait_for(refusal.is_visible)
    assert refusal.inner_text().startswith("a: ")
    tree.press("Escape")


def test_mixed_values_are_marked_in_each_kind_of_control(tree: Tree, make_row: MakeRow) -> None:
    second = {
        "frame": "odom",
        "alpha": 0.5,
        "style": "Boxes",
        "color": (1, 2, 3),
        "filled": False,
        "prefixes": ["x"],
    }
    loop = tree.tab.loop
    loop.show(make_row("a"), make_row("b", offset=(0.0, 0.5, 2.0), **second))
    select(tree, "a", "b")
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
    changed = [
        SetProperty("a", "offset", [1, 0.5, 0.0]),
        SetProperty("b", "offset", [1, 0.5, 2.0]),
    ]
    tree.tab.wait_for(lambda: loop.commands[-2:] == changed)


def test_displays_of_other_types_share_what_they_declare_alike(
    tree: Tree, make_row: MakeRow
) -> None:
    loop = tree.tab.loop
    other = Other(name="b")
    loop.show(make_row("a"), Row("b", "Other", other, "b", {}))
    select(tree, "a", "b")
    rows = tree.details.locator(".wv-property")
    playwright.expect(rows).to_have_count(6)
    paths = [row.get_attribute("data-path") for row in rows.all()]
    qos = ["topic.depth", "topic.reliability", "topic.durability", "topic.filter_size"]
    assert sorted(map(str, paths)) == sorted([*qos, "alpha", "color"])
    number = tree.details.locator("[data-path='alpha']").get_by_role("spinbutton")
    number.fill("0.5")
    tree.press("Enter")
    changed = [SetProperty(one, "alpha", 0.5) for one in "ab"]
    tree.tab.wait_for(lambda: loop.commands[-2:] == changed)


def test_several_are_selected_without_keys(tree: Tree, make_row: MakeRow) -> None:
    tree.tab.loop.show(make_row("a"), make_row("b"), make_row("c"))
    tree.click("a")
    for wanted in (["a", "c"], ["b"]):
        tree.tab.button("List options").click()
        tree.tab.page.get_by_role("menu").get_by_text("Select several").click()
        tree.click(wanted[-1])
        assert tree.selected() == wanted
