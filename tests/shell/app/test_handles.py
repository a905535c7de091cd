"""Displays from Python: their properties, their place in the list, and mistakes."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import pytest
from refusals import refusal_of

import webviz
from webviz.api.registry import display_types
from webviz.commands import Refresh
from webviz.shell.app.handles import DisplayHandle
from webviz.shell.testing.source import HandFedSource


def names(displays: list[DisplayHandle]) -> list[str]:
    return [display.name for display in displays]


def test_a_display_is_added_with_its_properties(viewer: webviz.Viewer) -> None:
    scan = viewer.add("LaserScan", topic="/front", size=0.05, name="Scan")
    assert (scan.type, scan.name, scan.size, scan.topic.name) == (
        "LaserScan",
        "Scan",
        0.05,
        "/front",
    )
    assert viewer["Scan"] == viewer[0] == scan
    assert viewer.config["displays"] == [
        {"type": "LaserScan", "topic": "/front", "size": 0.05, "name": "Scan"}
    ]


def test_properties_are_attributes(viewer: webviz.Viewer) -> None:
    scan = viewer.add("LaserScan")
    scan.size, scan.enabled = 0.1, False
    assert (scan.size, scan.enabled) == (0.1, False)


def test_nested_properties_are_set_by_a_path_or_in_part(viewer: webviz.Viewer) -> None:
    scan = viewer.add("LaserScan", topic="/rear")
    scan.set("topic.depth", 3)
    scan.set("topic", {"reliability": "reliable"})
    assert scan.topic == webviz.Topic("/rear", depth=3, reliability="reliable")


def test_a_wrong_value_is_refused_and_changes_nothing(viewer: webviz.Viewer) -> None:
    scan = viewer.add("LaserScan")

    def shrink() -> None:
        scan.size = -1

    assert "size: expected > 0" in refusal_of(shrink)
    assert scan.size == 0.01
    assert "size: expected > 0" in refusal_of(lambda: viewer.add("LaserScan", size=-1))
    assert len(viewer) == 1


def test_a_typing_error_names_the_nearest_property(viewer: webviz.Viewer) -> None:
    scan = viewer.add("LaserScan")
    hint = "LaserScan has no property `siez`, did you mean `size`?"

    def misspell() -> None:
        scan.siez = 0.1

    assert refusal_of(misspell) == hint
    assert refusal_of(lambda: scan.siez) == hint
    assert refusal_of(lambda: viewer.add("LaserScan", siez=0.1)) == hint
    several = refusal_of(lambda: viewer.add("LaserScan", siez=0.1, alpha=2, topc="/scan", size=1))
    assert several == (
        f"{hint} alpha: expected <= 1, got 2. "
        "LaserScan has no property `topc`, did you mean `topic`?"
    )
    assert refusal_of(lambda: viewer.add("LaserScn")).endswith("did you mean `LaserScan`?")
    assert not hasattr(scan, "siez")


def test_attributes_that_are_not_properties_cannot_be_set(viewer: webviz.Viewer) -> None:
    grid = viewer.add("Grid")

    def pretend() -> None:
        grid.status = webviz.Status(webviz.Level.OK, "fine")  # pyright: ignore

    assert refusal_of(pretend) == "`status` of a display cannot be set."


@pytest.mark.parametrize("name", sorted(display_types()))
def test_no_property_is_hidden_by_an_attribute_of_the_handle(name: str) -> None:
    own = {word for word in vars(DisplayHandle) if not word.startswith("_")}
    assert not own & set(display_types()[name].__struct_fields__)


def test_completion_offers_properties_and_names(viewer: webviz.Viewer) -> None:
    scan = viewer.add("LaserScan", name="Front scan")
    assert {"size", "topic", "remove", "statuses"} <= set(dir(scan))
    assert viewer._ipython_key_completions_() == ["Front scan"]
    assert repr(scan).startswith("<LaserScan 'Front scan': WARN No publisher on /scan")


def test_statuses_equal_those_of_the_panel(viewer: webviz.Viewer) -> None:
    scan = viewer.add("LaserScan", topic="/front")
    assert scan.status.level is webviz.Level.WARN
    assert scan.status in scan.statuses.values()
    assert "No publisher on /front" in scan.status.text


def test_a_list_that_is_changed_in_place_changes_nothing(viewer: webviz.Viewer) -> None:
    tf = viewer.add("TF")
    tf.frames["base"] = {"enabled": False}
    assert tf.frames == {}


def test_displays_are_copied_moved_and_removed(viewer: webviz.Viewer) -> None:
    first, last = viewer.add("Grid", name="First"), viewer.add("Axes", name="Last")
    copy = first.duplicate()
    assert names(viewer.displays) == ["First", "First 2", "Last"]
    last.move(before=copy)
    assert names(viewer.displays) == ["First", "Last", "First 2"]
    copy.remove()
    assert names(viewer.displays) == ["First", "Last"]
    gone = "This display was removed."
    assert refusal_of(copy.remove) == gone
    assert refusal_of(lambda: copy.name) == gone
    assert repr(copy) == "<removed display>"


def test_groups_hold_displays(viewer: webviz.Viewer) -> None:
    front = viewer.add("Group", name="Front")
    scan = viewer.add("LaserScan", group=front, name="Scan")
    grid = viewer.add("Grid", group="Front")
    inner = viewer.add("Group", group="Front", name="Inner")
    axes = viewer.add("Axes", group=inner)
    assert viewer.groups == [front, inner]
    assert front.displays == [scan, grid, inner]
    axes.move(group=front, before=grid)
    assert front.displays == [scan, axes, grid, inner]
    scan.move()
    assert viewer.displays[-1] == scan
    assert refusal_of(lambda: front.move(group=inner)) == "Front cannot be moved into itself."
    assert refusal_of(lambda: scan.move(group=grid)).startswith("Grid is not a group")
    assert refusal_of(lambda: scan.move(group=inner, before=grid)) == "Grid is in another group."
    assert refusal_of(lambda: viewer.add("Grid", group="Grid")).startswith("Grid is not a group")
    front.remove()
    assert viewer.displays == [scan]


def test_a_name_that_several_have_is_refused(viewer: webviz.Viewer) -> None:
    viewer.add("Grid")
    viewer.add("Axes")
    viewer.add("Grid")
    assert "Use the number in the list: 0 or 2" in refusal_of(lambda: viewer["Grid"])
    assert "did you mean `Axes`" in refusal_of(lambda: viewer["Axs"])
    assert refusal_of(lambda: viewer[3]) == "There is no display 3; the list has 3."
    assert viewer[-1].type == "Grid"


def test_a_topic_is_shown_by_the_display_that_fits(
    viewer: webviz.Viewer, source: HandFedSource
) -> None:
    assert refusal_of(viewer.add).startswith("Give the type of the display")
    assert refusal_of(lambda: viewer.add(topic="/x")).startswith("No publisher on /x")
    source.put("/rear", "sensor_msgs/msg/LaserScan", b"")
    source.put("/odd", "acme_msgs/msg/Odd", b"")
    viewer.do(Refresh())
    scan = viewer.add(topic="/rear", size=0.2)
    assert (scan.type, scan.topic.name, scan.size) == ("LaserScan", "/rear", 0.2)
    assert viewer.add(topic="/odd").type == "Text"


def test_an_invalid_entry_is_refused_with_the_reason(viewer: webviz.Viewer) -> None:
    viewer.config = {"displays": [{"type": "Gird", "name": "Floor"}]}
    floor = viewer["Floor"]
    assert floor.type == ""
    assert "did you mean `Grid`" in refusal_of(lambda: floor.cell_size)


def test_threads_may_add_displays_at_the_same_time(viewer: webviz.Viewer) -> None:
    with ThreadPoolExecutor(8) as pool:
        displays = list(pool.map(lambda i: viewer.add("Grid", name=f"Grid {i}"), range(40)))
    assert [grid.name for grid in displays] == [f"Grid {i}" for i in range(40)]
