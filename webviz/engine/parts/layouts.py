"""The layout of the panels, and the saved ones."""

from __future__ import annotations

from collections.abc import Mapping

from webviz.data.names import problem_of
from webviz.engine.commands import Command, RemoveLayout, SaveLayout, Sender, SetLayout
from webviz.engine.parts.part import Core, Handler, Part
from webviz.engine.parts.settings import SettingsPart
from webviz.files.config import ConfigError, Layout, nearest


class LayoutsPart(Part):
    """The layouts, which all browsers share.

    Args:
        core: shared by all parts.
        settings: has the layouts.
    """

    name = "Layouts"

    def __init__(self, core: Core, settings: SettingsPart) -> None:
        super().__init__(core)
        self._settings = settings

    @property
    def handles(self) -> Mapping[type[Command], Handler]:
        """The handler of each command."""
        return {
            SetLayout: self._set,
            SaveLayout: self._save,
            RemoveLayout: self._remove,
        }

    def _set(self, command: SetLayout, sender: Sender) -> None:
        layout = command.layout
        if isinstance(layout, str):
            layout = self._found(layout)
        if command.name:
            self._found(command.name)
            self._settings.set("layouts", {**self._saved(), command.name: layout})
        else:
            self._settings.set("layout", layout)

    def _save(self, command: SaveLayout, sender: Sender) -> None:
        if problem := problem_of(command.name):
            raise ConfigError(problem)
        layout = self._settings.settings.layout
        self._settings.set("layouts", {**self._saved(), command.name: layout})

    def _remove(self, command: RemoveLayout, sender: Sender) -> None:
        self._found(command.name)
        kept = {name: one for name, one in self._saved().items() if name != command.name}
        self._settings.set("layouts", kept)

    def _saved(self) -> Mapping[str, Layout]:
        return self._settings.settings.layouts

    def _found(self, name: str) -> Layout:
        saved = self._saved()
        if name not in saved:
            raise ConfigError(f"Unknown saved layout `{name}`: {nearest(name, saved)}")
        return saved[name]
