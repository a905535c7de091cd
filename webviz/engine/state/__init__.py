"""The state of a viewer, as pages and Python see it."""

from webviz.engine.state.config_file import ConfigFile
from webviz.engine.state.state import (
    ClockRate,
    Inspected,
    PanelTab,
    PanelTimes,
    Row,
    State,
    Step,
    Traffic,
    UndoHistory,
)

__all__ = [
    "ClockRate",
    "ConfigFile",
    "Inspected",
    "PanelTab",
    "PanelTimes",
    "Row",
    "State",
    "Step",
    "Traffic",
    "UndoHistory",
]
