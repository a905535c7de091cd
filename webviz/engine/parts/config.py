"""The config that is shown, its file, and whether it has unsaved changes."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from webviz.api.panel import Panel
from webviz.api.status import Level, Status
from webviz.api.tool import Tool
from webviz.data.words import counted, joined
from webviz.engine.commands import Command
from webviz.engine.parts.declaring import command, commands_of
from webviz.engine.parts.displays import DisplaysPart
from webviz.engine.parts.part import Part, PartContext
from webviz.engine.parts.plugin_list import PluginList
from webviz.engine.parts.settings import SettingsPart
from webviz.engine.parts.snapshots import ConfigOrigin
from webviz.engine.parts.views import ViewsPart
from webviz.files import config as config_file
from webviz.files.config import Config, Template

RESTORE = "Restore "
"""Text before the amount in the label of a step."""


class ConfigPart(Part):
    """Shows configs, and tells the current one.

    Args:
        context: shared by all parts.
        displays: empty; filled with those of the config.
        settings: replaced by those of the config.
        views: reset when another config is opened.
        tools, panels: replaced by those of the config.
        config: what to show first.
        path: its file, None if it has none.
    """

    name = "Config"

    def __init__(
        self,
        context: PartContext,
        displays: DisplaysPart,
        settings: SettingsPart,
        views: ViewsPart,
        tools: PluginList[Tool],
        panels: PluginList[Panel],
        config: Config,
        path: Path | None = None,
    ) -> None:
        super().__init__(context)
        self.displays = displays
        self.settings = settings
        self.views = views
        self.tools = tools
        self.panels = panels
        self._path: Path | None = None
        self._report: list[str] = []
        self._templates: tuple[Template, ...] = ()
        self._saved: dict[Path | None, dict[str, Any]] = {}
        """The content of the file, by its path."""
        self.is_changed = False
        """True while there are unsaved changes."""
        self._show(config, path)
        views.start_with(config.settings.view)

    @property
    def path(self) -> Path | None:
        """The config file, None if there is none."""
        return self._path

    def saved(self, path: Path | None) -> Mapping[str, Any] | None:
        """Return the content of a config file as far as it is known; see `config.document`."""
        return self._saved.get(path)

    def config(self) -> Config:
        """Return the current config: a snapshot, for any thread."""
        displays, tools, panels = self.displays.list, self.tools, self.panels
        return Config(
            self.settings.settings,
            displays.items(),
            tools.items(),
            panels.items(),
            templates=self._templates,
        )

    def origin(self) -> ConfigOrigin:
        """Return the origin of the config."""
        return ConfigOrigin(self._path, self._report, self._templates)

    def set_origin(self, origin: ConfigOrigin) -> None:
        """Say where the config comes from; of another file than the last it counts as changed."""
        self._path, self._report = origin.path, list(origin.report)
        self._templates = origin.templates

    def keep_up(self, commanded: bool) -> None:
        """Update whether there are unsaved changes."""
        if commanded:
            self.is_changed = config_file.document(self.config()) != self._saved.get(self._path)

    def open(self, config: Config, path: Path | None) -> None:
        """Show another config, which has unsaved changes unless it has a file."""
        self._show(config, path)
        if path is None:
            self.is_changed = True
            self._saved = {}
        self.views.open(config.settings.view)

    def note_saved(self, config: Config, path: Path) -> None:
        """Note that a config was written to a file, which is its own from now on."""
        self._path = path
        self._saved = {path: config_file.document(config)}

    def statuses(self) -> Mapping[str, Status]:
        """Return the unsupported parts of the open .rviz file."""
        if not self._report:
            return {}
        text = joined("Parts of this .rviz file are unsupported.", *self._report)
        return {"Import": Status(Level.WARN, text)}

    @command(None, label=lambda each: f"{RESTORE}{_amount(each.config)}")
    def restore(self, config: Config, path: Path | None) -> str:
        """Show the unsaved changes of the last session; undo brings back the config as it is saved.

        Args:
            config: as it was shown.
            path: of the config file that was open, None for none.
        """
        saved, origin = self._saved, self.origin()
        self._show(config, path)
        if path == origin.path:
            self.set_origin(origin)
        self._saved, self.is_changed = saved, True
        self.views.open(config.settings.view)
        return f"Restored {_amount(config)} of the last session."

    def _show(self, config: Config, path: Path | None) -> None:
        self.displays.list.clear()
        self.displays.list.add(config.displays)
        self.settings.settings = config.settings
        self.tools.show(config.tools)
        self.panels.show(config.panels)
        self._path = path
        self._report = config.report
        self._templates = config.templates
        self._saved = {path: config_file.document(self.config())}
        self.is_changed = False


Restore: type[Command] = commands_of(ConfigPart)["Restore"].type
"""The command that brings back the last session."""


def _amount(config: Config) -> str:
    """Return the number of displays, in words."""
    return counted(len(config.displays), "display")
