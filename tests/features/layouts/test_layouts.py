"""Layouts of panels: in the config, saved by name, and undone."""

from __future__ import annotations

import json
import time

import msgspec
import pytest
from bench import Bench, Benches
from msgspec.structs import replace

from webviz.commands import (
    AddPanel,
    Load,
    Redo,
    RemoveLayout,
    RemovePanel,
    SaveLayout,
    SetLayout,
    Undo,
    UseTemplate,
)
from webviz.features.layouts import TEMPLATES, layout_store
from webviz.files import rviz
from webviz.files.config import ConfigError, DockedPanel, FloatingPanel, Layout, dump, read
from webviz.files.config.layout import MAX_DOCKED, MAX_LAYOUTS

CONFIG = """\
version: 1
layout:
  beside: [{panel: doctor}]
  over: [{panel: Plot 2, left: 0.1}]
  height: 200.0
layouts:
  lab: {below: [{panel: Log, weight: 2.0}]}
displays: []
"""
CURRENT = Layout(
    beside=(DockedPanel(panel="doctor"),),
    over=(FloatingPanel(panel="Plot 2", left=0.1),),
    height=200.0,
)
LAB = Layout(below=(DockedPanel(panel="Log", weight=2.0),))


@pytest.fixture
def b(bench: Benches) -> Bench:
    b = bench()
    b.do(Load(CONFIG, "x.yaml"))
    return b


def layouts(b: Bench) -> tuple[Layout, dict[str, Layout]]:
    settings = b.states[-1].settings
    return settings.layout, settings.layouts


def test_a_file_keeps_layouts() -> None:
    config = read(CONFIG, "x.yaml")
    assert config.settings.layout == CURRENT
    assert config.settings.layouts == {"lab": LAB}
    assert read(dump(config), "x.yaml").settings == config.settings
    assert "weight" not in dump(read("version: 1\nlayout: {below: [{panel: Log}]}", "x.yaml"))


def test_an_export_to_rviz_reports_the_missing_layouts() -> None:
    text, report = rviz.write(read(CONFIG, "x.yaml"))
    assert "doctor" not in text
    assert [each for each in report.sentences() if "layout" in each]


@pytest.mark.parametrize(
    ("layout", "reason"),
    [
        ("{beside: [{panel: Log}], over: [{panel: Log}]}", "Log is placed twice"),
        ("{besides: []}", "besides"),
        ("{below: [{panel: Log, weight: .nan}]}", "weight"),
        ("{below: [{panel: Log, weight: 1.0e+308}]}", "weight"),
        ("{over: [{panel: Log, left: -1}]}", "left"),
        ("{beside: [{panel: ''}]}", "panel"),
        ("{width: 0}", "width"),
        ("[doctor]", "layout"),
        (f"{{below: [{', '.join(f'{{panel: P{i}}}' for i in range(21))}]}}", "below"),
    ],
)
def test_a_mistake_is_named(layout: str, reason: str) -> None:
    with pytest.raises(ConfigError, match=reason):
        read(f"version: 1\nlayout: {layout}\n", "x.yaml")


def test_layouts_are_changed_saved_and_undone(b: Bench) -> None:
    b.do(SetLayout("lab"))
    assert layouts(b) == (LAB, {"lab": LAB})
    b.do(SaveLayout("second"))
    assert layouts(b) == (LAB, {"lab": LAB, "second": LAB})
    b.do(SetLayout(CURRENT, "second"))
    assert layouts(b) == (LAB, {"lab": LAB, "second": CURRENT})
    b.do(RemoveLayout("lab"))
    assert layouts(b) == (LAB, {"second": CURRENT})
    steps = [step.label for step in b.states[-1].history.undo]
    assert steps[:4] == [
        "Remove layout lab",
        "Save layout second",
        "Save layout second",
        "Change layout",
    ]
    b.do(Undo(steps=4))
    assert layouts(b) == (CURRENT, {"lab": LAB})
    b.do(Redo(steps=2))
    assert layouts(b) == (LAB, {"lab": LAB, "second": LAB})


def test_a_panel_that_is_removed_leaves_its_place_to_none_of_its_type(b: Bench) -> None:
    for _ in range(3):
        b.do(AddPanel("Joints", {}))
    first = b.states[-1].panels[0].id
    docked = [DockedPanel(panel=name) for name in ("Joints", "doctor", "Joints 3")]
    arranged = Layout(beside=tuple(docked), over=(FloatingPanel(panel="Joints 2"),))
    b.do(SetLayout(arranged))
    b.do(SaveLayout("lab"))
    b.do(RemovePanel(first))
    remaining = Layout(
        beside=(DockedPanel(panel="doctor"), DockedPanel(panel="Joints 2")),
        over=(FloatingPanel(panel="Joints"),),
    )
    assert layouts(b) == (remaining, {"lab": remaining})
    b.do(Undo())
    assert layouts(b) == (arranged, {"lab": arranged})
    assert len(b.states[-1].panels) == 3


def test_wide_panels_open_below_the_scene_in_one_place_and_narrow_ones_in_the_tabs(
    b: Bench,
) -> None:
    b.do(SetLayout(Layout()))
    for name in ("Plot", "Joints", "Log", "Plot"):
        b.do(AddPanel(name, {}))
    open_layout = Layout(below=(DockedPanel(panel="Plot", tabs=("Log", "Plot 2")),))
    assert layouts(b)[0] == open_layout
    b.do(Undo())
    assert layouts(b)[0] == Layout(below=(DockedPanel(panel="Plot", tabs=("Log",)),))
    b.do(Redo())
    first, _, *others = [tab.id for tab in b.states[-1].panels]
    b.do(RemovePanel(first))
    assert layouts(b)[0] == Layout(below=(DockedPanel(panel="Log", tabs=("Plot",)),))
    for each in others:
        b.do(RemovePanel(each))
    assert layouts(b)[0] == Layout()


@pytest.mark.parametrize("name", TEMPLATES)
def test_a_template_adds_the_panels_that_are_missing_in_one_step(b: Bench, name: str) -> None:
    b.do(AddPanel("Plot", {"window": 5}))
    before = layouts(b)
    b.do(UseTemplate(name))
    layout = layouts(b)[0]
    assert layout == TEMPLATES[name]
    own = {"doctor"}
    tabs = [tab.tab for tab in b.states[-1].panels]
    assert set(layout.names) - own <= set(tabs)
    assert tabs.count("Plot") == 1
    b.do(UseTemplate(name))
    assert [tab.tab for tab in b.states[-1].panels] == tabs
    b.do(Undo())
    assert layouts(b) == before
    assert [tab.tab for tab in b.states[-1].panels] == ["Plot"]
    assert "did you mean `Tune`" in b.refusal(UseTemplate("Tun"))


def test_a_place_takes_as_many_tabs_as_can_be_saved() -> None:
    layout = Layout()
    for number in range(30):
        layout = layout.with_panel_below(f"Plot {number}")
    assert [len(each.names) for each in layout.below] == [21, 9]
    assert layout.with_panel_below("Plot 3") == layout
    assert msgspec.convert(msgspec.to_builtins(layout), Layout) == layout


def test_the_others_stay_when_a_layout_is_removed(b: Bench) -> None:
    for name in ("a", "m", "z"):
        b.do(SaveLayout(name))
    b.do(RemoveLayout("m"))
    assert list(layouts(b)[1]) == ["lab", "a", "z"]


def test_pages_see_the_layout_and_the_name_of_the_saved_one() -> None:
    settings = read(CONFIG, "x.yaml").settings
    settings = replace(settings, layouts={"lab": LAB, "now": CURRENT, "other": LAB})
    store = layout_store(settings, "")
    assert [(each.name, each.is_shown) for each in store.saved] == [
        ("lab", False),
        ("now", True),
        ("other", False),
    ]
    assert [(each.panel, each.weight) for each in store.beside] == [("doctor", 1.0)]
    assert [(each.panel, each.left) for each in store.over] == [("Plot 2", 0.1)]
    assert (store.below, store.height) == ([], 200.0)
    assert [(each.panel, each.weight) for each in layout_store(settings, "lab").below] == [
        ("Log", 2.0)
    ]
    assert layout_store(settings, "unknown").over == store.over


def test_invalid_commands_are_refused(b: Bench) -> None:
    for command in (SetLayout("nowhere"), SetLayout(LAB, "nowhere"), RemoveLayout("nowhere")):
        assert "Unknown saved layout `nowhere`" in b.refusal(command)
    assert "name" in b.refusal(SaveLayout(""))
    assert layouts(b) == (CURRENT, {"lab": LAB})


def test_a_page_cannot_save_more_layouts_than_a_file_may_have(b: Bench) -> None:
    for number in range(1, MAX_LAYOUTS):
        b.do(SaveLayout(f"{number}"))
    assert f"at most {MAX_LAYOUTS}" in b.refusal(SaveLayout("more"))
    assert len(layouts(b)[1]) == MAX_LAYOUTS
    b.do(SaveLayout("lab"))


def test_the_largest_layouts_are_written_and_read_in_seconds() -> None:
    """A session is written so while somebody drives; ten seconds would be felt."""
    places = [[f"{place} {number}" for number in range(MAX_DOCKED)] for place in "abc"]
    docked = [
        tuple(DockedPanel(panel=name, weight=1 / 3) for name in place) for place in places[:2]
    ]
    numbers = {"left": 1 / 3, "top": 1 / 3, "width": 1 / 7, "height": 1 / 7}
    over = tuple(FloatingPanel(panel=name, **numbers) for name in places[2])
    layout = Layout(beside=docked[0], below=docked[1], over=over)
    config = read(CONFIG, "x.yaml")
    config.settings.layouts = {f"{number}": layout for number in range(MAX_LAYOUTS)}
    start_s = time.process_time()
    assert read(dump(config), "x.yaml").settings == config.settings
    assert time.process_time() - start_s < 6.0


@pytest.mark.parametrize(("key", "value"), [("layouts", {}), ("views", {}), ("bookmarks", 0.0)])
def test_the_number_of_saved_entries_is_bounded(key: str, value: object) -> None:
    entries = {f"{number}": value for number in range(1001)}
    with pytest.raises(ConfigError, match=f"`?{key}`?: expected at most"):
        read(f"version: 1\n{key}: {json.dumps(entries)}\n", "x.yaml")
