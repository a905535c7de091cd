"""The state of a viewer, as pages and Python see it."""

from webviz.engine.state.config_file import ConfigFile
from webviz.engine.state.state import (
    ClockRate,
    HistoryStep,
    Inspected,
    PanelTab,
    PanelTimes,
    Row,
    State,
    Traffic,
    UndoHistory,
)

__all__ = [
    "ClockRate",
    "ConfigFile",
    "HistoryStep",
    "Inspected",
    "PanelTab",
    "PanelTimes",
    "Row",
    "State",
    "Traffic",
    "UndoHistory",
]
