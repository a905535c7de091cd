"""Plug-in files that change while the viewer runs."""

from __future__ import annotations

from pathlib import Path

from webviz.engine.feature import Feature, command
from webviz.engine.parts.displays import DisplaysPart
from webviz.engine.parts.panels import PanelsPart
from webviz.engine.parts.settings import SettingsPart
from webviz.engine.pipeline import plugins


class PluginsFeature(Feature):
    """Reloads plug-ins: what is there becomes instances of the new classes."""

    name = "Plugins"

    @command(None)
    def reload_plugin(self, path: Path) -> None:
        """Reload a plug-in file after it was saved."""
        displays, settings = self.context.get(DisplaysPart).list, self.context.get(SettingsPart)
        plugins.reload(path, displays.runners())
        self.context.tools.renew()
        self.context.get(PanelsPart).list.renew()
        settings.settings = displays.read_again(settings.settings)
