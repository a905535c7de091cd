"""Reloading of a display while its file is edited."""

from __future__ import annotations

from typing import Any

import pytest
import rviz_trees
from bench import Bench, Benches

from tests.features.plugins.conftest import Plugin
from webviz import Topic
from webviz.api.declared import make
from webviz.api.nodes import Lines
from webviz.commands import AddDisplay, ReloadPlugin, Reset, SetProperty
from webviz.files import rviz
from webviz.files.config import dump
from webviz.files.opening import parse

TYPE = "geometry_msgs/msg/PolygonStamped"
CORNERS = [(0.0, 0.0), (2.0, 0.0), (0.0, 2.0)]
GREEN, BLUE = (25, 255, 0), (0, 0, 255)
COLOR = "    color: Annotated"
WIDTH = "    width: Annotated[float, Prop(gt=0)] = 4.0\n"


def publish(
    b: Bench, corners: list[tuple[float, float]] = CORNERS, topic: str = "/polygon"
) -> None:
    polygon = {"points": [{"x": x, "y": y} for x, y in corners]}
    b.publish(topic, TYPE, {"header": {"frame_id": "map"}, "polygon": polygon})
    b.turn()


def outlines(b: Bench) -> list[tuple[Any, float]]:
    """Colour and width of every outline that can be seen."""
    return [(node.colors, node.width) for node in b.nodes(Lines)]


def reloaded(b: Bench, plugin: Any) -> Any:
    """A copy of the display at work after a reload of its file; its class tells which code."""
    b.viewer.enqueue(ReloadPlugin(plugin.path))
    b.turn()
    return b.viewer.config().displays[0]


@pytest.fixture
def b(plugin: Plugin, bench: Benches) -> Any:
    """A viewer that has heard one polygon, never to be published again."""
    b = bench(make(plugin.load(), {}), strict=False)
    publish(b)
    assert outlines(b) == [(GREEN, 1.0)]
    return b


def test_the_example_draws_the_outline_with_a_status(b: Bench) -> None:
    assert b.statuses()["Area"] == ("OK", "3 corners.")
    publish(b, CORNERS[:2])
    assert b.statuses()["Area"][0] == "WARN"
    assert outlines(b) == []


def test_reloaded_code_redraws_earlier_messages(b: Bench, plugin: Plugin) -> None:
    plugin.edit(("self.color)", "self.color, 5.0)"))
    reloaded(b, plugin)
    assert outlines(b) == [(GREEN, 5.0)]


def test_values_are_kept_and_defaults_follow_the_file(b: Bench, plugin: Plugin) -> None:
    plugin.edit(("= (25, 255, 0)", "= (0, 0, 255)"))
    assert reloaded(b, plugin).color == BLUE
    assert outlines(b) == [(BLUE, 1.0)]
    for path, value in (("color", (9, 9, 9)), ("name", "Fence"), ("topic.depth", 7)):
        b.viewer.enqueue(SetProperty("display1", path, value))
    plugin.edit(("= (0, 0, 255)", "= (255, 0, 0)"))
    display = reloaded(b, plugin)
    assert (display.color, display.name) == ((9, 9, 9), "Fence")
    assert display.topic == Topic("/polygon", depth=7)


def test_a_changed_display_stays_where_it_is_in_the_list(plugin: Plugin, bench: Benches) -> None:
    cls = plugin.load()
    displays = [make(cls, {"name": name}) for name in ("A", "B", "C")]
    b = bench(*displays)
    plugin.edit(("outline of", "shape of"))
    reloaded(b, plugin)
    b.statuses()
    rows = b.states[-1].rows
    assert [(row.id, row.name) for row in rows] == [
        ("display1", "A"),
        ("display2", "B"),
        ("display3", "C"),
    ]
    assert all(type(row.display).__doc__ == "The shape of a polygon." for row in rows)


def test_a_new_property_appears_and_works(b: Bench, plugin: Plugin) -> None:
    plugin.edit((COLOR, WIDTH + COLOR), ("self.color)", "self.color, self.width)"))
    reloaded(b, plugin)
    assert outlines(b) == [(GREEN, 4.0)]
    b.viewer.enqueue(SetProperty("display1", "width", 8.0))
    b.turn()
    assert outlines(b) == [(GREEN, 8.0)]
    b.viewer.enqueue(SetProperty("display1", "width", -1.0))
    b.turn()
    assert outlines(b) == [(GREEN, 8.0)]


def test_a_removed_property_is_dropped_with_a_warning(
    b: Bench, plugin: Plugin, caplog: pytest.LogCaptureFixture
) -> None:
    b.viewer.enqueue(SetProperty("display1", "color", BLUE))
    plugin.edit((COLOR, "    paint: Annotated"), ("self.color", "self.paint"))
    display = reloaded(b, plugin)
    assert not hasattr(display, "color")
    assert outlines(b) == [(GREEN, 1.0)]
    level, text = b.statuses()["Plugin"]
    assert level == "WARN"
    assert "color = (0, 0, 255) (no such property)" in text
    assert text in caplog.text
    reloaded(b, plugin)
    assert "Plugin" not in b.statuses()


def test_a_value_that_no_longer_fits_is_dropped_and_the_others_stay(
    b: Bench, plugin: Plugin
) -> None:
    plugin.edit((COLOR, WIDTH + COLOR))
    reloaded(b, plugin)
    b.viewer.enqueue(SetProperty("display1", "width", 9.0))
    b.viewer.enqueue(SetProperty("display1", "color", BLUE))
    plugin.edit(("gt=0", "gt=0, lt=5"))
    display = reloaded(b, plugin)
    assert (display.width, display.color) == (4.0, BLUE)
    assert "width = 9.0 (Expected `float` < 5.0" in b.statuses()["Plugin"][1]


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        ("def draw(self", "def draw(self(", "is not valid Python"),
        ("from typing import", "import nowhere_at_all\nfrom typing import", "ModuleNotFoundError"),
        ("class Area(Display)", "class Grid(Display)", "display named Grid. Rename the class"),
    ],
)
def test_a_broken_save_keeps_the_previous_version_with_the_reason(
    b: Bench, plugin: Plugin, old: str, new: str, reason: str, caplog: pytest.LogCaptureFixture
) -> None:
    plugin.edit((old, new))
    before = type(b.viewer.config().displays[0])
    assert type(reloaded(b, plugin)) is before
    assert outlines(b) == [(GREEN, 1.0)]
    level, text = b.statuses()["Plugin"]
    assert (level, reason in text) == ("ERROR", True)
    assert text in caplog.text
    publish(b, [*CORNERS, (1.0, 1.0)])
    assert b.statuses()["Area"] == ("OK", "4 corners.")
    plugin.edit((new, old))
    assert type(reloaded(b, plugin)) is not before
    assert "Plugin" not in b.statuses()
    assert outlines(b) == [(GREEN, 1.0)]


def test_a_deleted_file_keeps_the_picture_until_it_is_back(b: Bench, plugin: Plugin) -> None:
    text = plugin.path.read_text()
    plugin.path.unlink()
    reloaded(b, plugin)
    assert b.statuses()["Plugin"] == (
        "ERROR",
        f"Cannot read {plugin.path}: No such file or directory.",
    )
    assert outlines(b) == [(GREEN, 1.0)]
    plugin.path.write_text(text)
    reloaded(b, plugin)
    assert "Plugin" not in b.statuses()


def test_a_renamed_class_is_another_type_and_the_old_display_goes_on(
    b: Bench, plugin: Plugin
) -> None:
    plugin.edit(("class Area", "class Fence"))
    old = type(reloaded(b, plugin))
    level, text = b.statuses()["Plugin"]
    assert (level, "no longer has a display Area" in text) == ("ERROR", True)
    assert outlines(b) == [(GREEN, 1.0)]
    assert "type: Area" in dump(b.viewer.config())
    b.viewer.enqueue(AddDisplay("Fence"))
    b.viewer.enqueue(AddDisplay("Area"))  # there is no such type any more
    b.turn()
    assert [type(d).__name__ for d in b.viewer.config().displays] == ["Area", "Fence"]
    plugin.edit(("class Fence", "class Area"))
    assert type(reloaded(b, plugin)) is not old
    assert "Plugin" not in b.statuses(0)
    assert "no longer has a display Fence" in b.statuses(1)["Plugin"][1]


def test_code_that_raises_is_a_status_and_the_old_picture_stays(
    b: Bench, plugin: Plugin, caplog: pytest.LogCaptureFixture
) -> None:
    plugin.edit(
        ("        ctx.strip", "        raise RuntimeError('out of ink')\n        ctx.strip")
    )
    reloaded(b, plugin)
    assert b.statuses()["Display"] == ("ERROR", "Area failed: RuntimeError: out of ink")
    assert outlines(b) == [(GREEN, 1.0)]
    assert "out of ink" in caplog.text
    plugin.edit(("        raise RuntimeError('out of ink')\n", ""))
    reloaded(b, plugin)
    assert "Display" not in b.statuses()


@pytest.mark.parametrize("hook", ["history(self)", "waits(self, name)", "accept(self, new, kept)"])
def test_any_hook_may_raise_or_return_nonsense_and_the_viewer_goes_on(
    b: Bench, plugin: Plugin, hook: str
) -> None:
    for body in ("raise RuntimeError('out of ink')", "return object()"):
        text = plugin.path.read_text()
        changed = text.replace("Sample, Topic", "Sample, Selective, Topic").replace(
            "(Display)", "(Display, Selective)"
        )
        plugin.path.write_text(f"{changed}\n    def {hook}:\n        {body}\n")
        reloaded(b, plugin)
        publish(b)
        if "raise" in body:
            assert b.statuses()["Display"] == ("ERROR", "Area failed: RuntimeError: out of ink")
        plugin.path.write_text(text)
        reloaded(b, plugin)
        publish(b, [*CORNERS, (1.0, 1.0)])
        assert b.statuses()["Area"] == ("OK", "4 corners.")
        assert "Display" not in b.statuses()


def test_an_entry_of_the_config_comes_to_life_with_its_property(
    plugin: Plugin, bench: Benches
) -> None:
    plugin.load()
    text = "displays: [{type: Area, width: 7.0}, {type: Nowhere}]"
    b = bench(*parse(text, "x.yaml").displays)
    assert "displays[0].width: unknown key" in b.statuses()["Config"][1]
    plugin.edit((COLOR, WIDTH + COLOR), ("self.color)", "self.color, self.width)"))
    reloaded(b, plugin)
    publish(b)
    assert outlines(b) == [(GREEN, 7.0)]
    assert b.states[-1].rows[0].id == "display1"
    assert "unknown display type `Nowhere`" in b.statuses(1)["Config"][1]


def test_a_node_that_cannot_be_drawn_is_a_status(b: Bench, plugin: Plugin) -> None:
    plugin.edit(("        ctx.ok", "        ctx.add('nothing', None)\n        ctx.ok"))
    reloaded(b, plugin)
    assert b.statuses()["Display"][1] == "Area failed: TypeError: 'nothing' is not a node: None"
    assert outlines(b) == [(GREEN, 1.0)]


def test_the_drawing_of_a_removed_hook_is_removed(b: Bench, plugin: Plugin) -> None:
    plugin.edit(
        ("sample: Sample, ctx: Context", "samples, ctx: Context"),
        ("def draw", "def draw_all"),
        ("        corners =", "        if not samples:\n            return\n        corners ="),
        ("sample.message", "samples[-1].message"),
    )
    reloaded(b, plugin)
    assert outlines(b) == [(GREEN, 1.0)]
    plugin.edit(("def draw_all", "def sketch"))
    reloaded(b, plugin)
    assert outlines(b) == []


def test_another_topic_in_the_file_is_listened_to(b: Bench, plugin: Plugin) -> None:
    plugin.edit(('Topic("/polygon")', 'Topic("/fence")'))
    reloaded(b, plugin)
    assert "/fence" in b.source.subscriptions
    assert "/polygon" not in b.source.subscriptions
    assert outlines(b) == []
    publish(b, topic="/fence")
    assert outlines(b) == [(GREEN, 1.0)]


def test_work_of_the_old_code_is_not_drawn_by_the_new(b: Bench, plugin: Plugin) -> None:
    plugin.edit(
        ("    def draw(", "    def new_state(self):\n        return WIDTH\n\n    def draw("),
        ("self.color)", "self.color, ctx.state)"),
        ("\n\nclass", "\nWIDTH = 3.0\n\n\nclass"),
    )
    reloaded(b, plugin)
    assert outlines(b) == [(GREEN, 3.0)]
    plugin.edit(("WIDTH = 3.0", "WIDTH = 6.0"))
    reloaded(b, plugin)
    assert outlines(b) == [(GREEN, 6.0)]


def test_a_reset_after_a_reload_forgets_as_ever(b: Bench, plugin: Plugin) -> None:
    reloaded(b, plugin)
    b.viewer.enqueue(Reset())
    b.turn()
    assert outlines(b) == []
    publish(b)
    assert outlines(b) == [(GREEN, 1.0)]


def test_a_preserved_rviz_display_becomes_supported_and_keeps_foreign_properties(
    plugin: Plugin, bench: Benches
) -> None:
    plugin.load()
    remaining = (
        "{Class: x/Outline, Name: Fence, Value: true, Topic: /polygon, Color: blue, Glow: 1}"
    )
    b = bench(*parse(f"displays: [{{type: x/Outline, rviz: {remaining}}}]", "x.yaml").displays)
    assert "Unsupported display class" in b.statuses()["Config"][1]
    plugin.edit((COLOR, "    rviz = 'x/Outline'\n" + COLOR))
    reloaded(b, plugin)
    publish(b)
    assert outlines(b) == [((0, 0, 255), 1.0)]
    rviz_texts = rviz_trees.texts(rviz.write(b.viewer.config())[0])
    (tree,) = rviz_texts["Visualization Manager"]["Displays"]
    assert (tree["Class"], tree["Name"], tree["Glow"]) == ("x/Outline", "Fence", "1")
