"""The state of a viewer, as pages and Python see it."""

from webviz.engine.state.config_file import ConfigFile
from webviz.engine.state.state import (
    Between,
    ClockRate,
    Driving,
    GoalProgress,
    Inspected,
    PanelTab,
    PanelTimes,
    Row,
    State,
    Step,
    ToolButton,
    Traffic,
    UndoHistory,
)

__all__ = [
    "Between",
    "ClockRate",
    "ConfigFile",
    "Driving",
    "GoalProgress",
    "Inspected",
    "PanelTab",
    "PanelTimes",
    "Row",
    "State",
    "Step",
    "ToolButton",
    "Traffic",
    "UndoHistory",
]
