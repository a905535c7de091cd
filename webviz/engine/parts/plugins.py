"""Plug-in files that change while the viewer runs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from webviz.engine.commands import Command, ReloadPlugin, Sender
from webviz.engine.parts.displays import DisplaysPart
from webviz.engine.parts.part import Core, Handler, Part
from webviz.engine.parts.plugin_list import PluginList
from webviz.engine.parts.settings import SettingsPart
from webviz.engine.pipeline import plugins


class PluginsPart(Part):
    """Reloads plug-ins.

    Args:
        core: shared by all parts.
        displays, lists: become instances of the reloaded classes.
        settings: keep the parts of entries from RViz that only saving needs.
    """

    name = "Plugins"

    def __init__(
        self,
        core: Core,
        displays: DisplaysPart,
        lists: Sequence[PluginList[Any]],
        settings: SettingsPart,
    ) -> None:
        super().__init__(core)
        self._displays = displays
        self._lists = lists
        self._settings = settings

    @property
    def handles(self) -> Mapping[type[Command], Handler]:
        """The handler of each command."""
        return {ReloadPlugin: self._reload}

    def _reload(self, command: ReloadPlugin, sender: Sender) -> None:
        displays, settings = self._displays.list, self._settings
        plugins.reload(command.path, displays.runners())
        for each in self._lists:
            each.renew()
        settings.settings = displays.read_again(settings.settings)
