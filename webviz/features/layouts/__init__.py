"""The layout of the panels, and the saved ones."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import msgspec

from webviz.api.panel import Panel
from webviz.api.registry import plugin_types
from webviz.api.roles import Role
from webviz.data.names import problem_of
from webviz.engine.feature import Feature, command, store
from webviz.engine.forms import sendable
from webviz.engine.parts.panels import PanelsPart
from webviz.engine.parts.settings import SettingsPart
from webviz.engine.store import PageStore
from webviz.files.config import ConfigError, DockedPanel, Layout, Settings, nearest

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
"""Layouts by name. Panels are those of webviz, or types of panels, of which the first is meant."""


class SavedLayout(msgspec.Struct, frozen=True):
    """A saved layout: its name, and whether browsers show it."""

    name: str
    is_shown: bool


class DockedOnPage(msgspec.Struct, frozen=True):
    """A panel beside or below the scene, and those behind it."""

    panel: str
    weight: float
    tabs: Sequence[str]


class FloatingOnPage(msgspec.Struct, frozen=True):
    """A panel over the scene."""

    panel: str
    left: float
    top: float
    width: float
    height: float


class LayoutStore(PageStore, frozen=True):
    """A layout, complete; see `webviz.files.config.layout`.

    Args:
        saved: the saved layouts.
        templates: names of the layouts for tasks.
        beside, below, over: the panels of each place.
        width, height: of the first two, in pixels.
    """

    saved: Sequence[SavedLayout]
    templates: Sequence[str]
    beside: Sequence[DockedOnPage]
    below: Sequence[DockedOnPage]
    over: Sequence[FloatingOnPage]
    width: float
    height: float


class LayoutsFeature(Feature):
    """The layouts, which all browsers share."""

    name = "Layouts"
    module = "layouts.js"

    @command(Role.OPERATOR)
    def set_layout(self, layout: Layout | str, name: str = "") -> None:
        """Arrange the panels in all browsers.

        Args:
            layout: a layout, or the name of a saved one.
            name: of the saved layout to change instead, "" for the one that browsers show.
        """
        if isinstance(layout, str):
            layout = self._named(layout)
        if name:
            self._named(name)
            self._part.set("layouts", {**self._part.settings.layouts, name: layout})
        else:
            self._part.set("layout", layout)

    @command(Role.OPERATOR)
    def use_template(self, template: str) -> str:
        """Arrange the panels for a task, and add those that it needs and that are not there.

        Args:
            template: its name, such as "Tune".
        """
        if (layout := TEMPLATES.get(template)) is None:
            raise ConfigError(f"Unknown template `{template}`: {nearest(template, TEMPLATES)}")
        panels = self.context.get(PanelsPart)
        there = {tab.tab for tab in panels.tabs()}
        added = [name for name in layout.names if name in plugin_types(Panel) and name not in there]
        for name in added:
            panels.add_panel(name)
        self._part.set("layout", layout)
        return f"Arranged for: {template}."

    @command(Role.OPERATOR)
    def save_layout(self, name: str) -> None:
        """Save the layout under a name; replaces a saved layout of that name."""
        if problem := problem_of(name):
            raise ConfigError(problem)
        settings = self._part.settings
        self._part.set("layouts", {**settings.layouts, name: settings.layout})

    @command(Role.OPERATOR)
    def remove_layout(self, name: str) -> None:
        """Remove a saved layout."""
        self._named(name)
        saved = self._part.settings.layouts
        self._part.set("layouts", {key: each for key, each in saved.items() if key != name})

    @store()
    def layout(self, argument: str) -> LayoutStore:
        """Return the layout that browsers show, or the saved one of this name if there is one."""
        return layout_store(self._part.settings, argument)

    @property
    def _part(self) -> SettingsPart:
        return self.context.get(SettingsPart)

    def _named(self, name: str) -> Layout:
        saved = self._part.settings.layouts
        if name not in saved:
            raise ConfigError(f"Unknown saved layout `{name}`: {nearest(name, saved)}")
        return saved[name]


def layout_store(settings: Settings, name: str) -> LayoutStore:
    """Return the layout that browsers show, or the saved one of this name if there is one."""
    chosen = settings.layouts.get(name, settings.layout)
    saved = [
        SavedLayout(str(sendable(each)), layout == settings.layout)
        for each, layout in settings.layouts.items()
    ]
    return LayoutStore(
        saved=saved,
        templates=list(TEMPLATES),
        beside=[
            msgspec.convert(each, DockedOnPage, from_attributes=True) for each in chosen.beside
        ],
        below=[msgspec.convert(each, DockedOnPage, from_attributes=True) for each in chosen.below],
        over=[msgspec.convert(each, FloatingOnPage, from_attributes=True) for each in chosen.over],
        width=chosen.width,
        height=chosen.height,
    )
