"""Layouts for tasks, which every page offers: panels that are added if they are missing."""

from __future__ import annotations

from collections.abc import Mapping

from webviz.files.config import DockedPanel, Layout

TEMPLATES: Mapping[str, Layout] = {
    "Navigate": Layout(
        beside=(DockedPanel(panel="Nav2"),),
        below=(DockedPanel(panel="Log", tabs=("Diagnostics",)),),
        height=200,
    ),
    "Tune": Layout(
        beside=(DockedPanel(panel="Parameters"),),
        below=(DockedPanel(panel="Plot", tabs=("StateTimeline",)),),
        height=260,
    ),
    "Debug a bag": Layout(
        beside=(DockedPanel(panel="doctor"), DockedPanel(panel="RawMessage")),
        below=(
            DockedPanel(panel="Plot", tabs=("StateTimeline",)),
            DockedPanel(panel="Log", tabs=("MessageTable",)),
        ),
        height=220,
    ),
}
"""By name. Panels are those of webviz, or types of panels, of which the first is meant."""
