"""The panel 3D scene: its camera, and the displays that it leaves out."""

from __future__ import annotations

from typing import Any

import msgspec
import pytest

from tests.support.panel_facts import show
from webviz.api.declared import make
from webviz.api.display import Display
from webviz.commands import SetPanelProperty
from webviz.engine.state import PanelTab, Row, State
from webviz.page.recorded_ui import RecordedUi
from webviz.panels.scene_view import SceneView

ROWS = (
    Row("display1", "Group", None, "Sensors", {}),
    Row("display2", "LaserScan", Display(name="Scan"), "Scan", {}, depth=1),
    Row("display3", "Axes", Display(name="Axes"), "Axes", {}),
)


def values(panel: SceneView) -> Any:
    ui = RecordedUi()
    panel.build(ui, lambda command, browser=None: None)
    show(panel, State(rows=ROWS, panels=(PanelTab("panel7", "SceneView", panel),)))
    (widget,) = ui.widgets.values()
    return widget.values["values"]


def test_it_leaves_out_displays_and_groups_that_are_switched_off() -> None:
    assert values(make(SceneView, {}))["hidden"] == []
    assert values(make(SceneView, {"displays": {"Axes": False}}))["hidden"] == ["display3"]
    panel = make(SceneView, {"displays": {"Sensors": False}})
    assert values(panel)["hidden"] == ["display1", "display2"]


def test_it_follows_its_target_frame() -> None:
    fixed = make(SceneView, {})
    assert (values(fixed)["group"], fixed.target_frames()) == ("", set())
    panel = make(SceneView, {"view": {"target_frame": "base_link"}})
    assert values(panel)["group"] == "target frame/base_link"
    assert panel.target_frames() == {"base_link"}


def test_a_camera_that_a_page_has_moved_becomes_its_own_through_a_command() -> None:
    messages: list[tuple[Any, int | None]] = []
    panel, ui = make(SceneView, {}), RecordedUi()
    panel.build(ui, lambda command, browser=None: messages.append((command, browser)))
    (widget,) = ui.widgets.values()
    widget.use('{"yaw": 1.0}', 4)
    assert messages == [], "it is not known yet"
    show(panel, State(panels=(PanelTab("panel7", "SceneView", panel),)))
    widget.use('{"yaw": 1.0}', 4)
    widget.use("[1]", 4)
    assert messages == [(SetPanelProperty("panel7", "view", {"yaw": 1.0}), 4)]


@pytest.mark.parametrize("view", [{"distance": 0}, {"pitch": 2.0}, {"type": "FPS"}, {"fov": 1}])
def test_an_invalid_camera_is_refused(view: dict[str, Any]) -> None:
    with pytest.raises(msgspec.ValidationError):
        make(SceneView, {"view": view})
