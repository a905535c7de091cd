"""The panels of plug-ins and their properties."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from webviz.api.panel import Panel
from webviz.api.status import Status
from webviz.engine.commands import Command, Sender, SetPanelProperty
from webviz.engine.parts.part import Core, Handler, Part
from webviz.engine.parts.plugin_list import PluginList
from webviz.engine.state import PanelTab


class PanelsPart(Part):
    """All panels of plug-ins. What is drawn of them is known to the pages alone."""

    name = "Panels"

    def __init__(self, core: Core) -> None:
        super().__init__(core)
        self.list = PluginList(Panel)

    @property
    def handles(self) -> Mapping[type[Command], Handler]:
        """The handler of each command."""
        return {SetPanelProperty: self._set}

    def state(self) -> Mapping[str, Any]:
        """The tabs."""
        return {"panels": tuple(PanelTab(id, each) for id, each in self.list.usable().items())}

    def statuses(self) -> Mapping[str, Status]:
        """Which panels cannot be used."""
        return self.list.statuses()

    def _set(self, command: SetPanelProperty, sender: Sender) -> None:
        self.list.set(command.panel, command.path, command.value)
