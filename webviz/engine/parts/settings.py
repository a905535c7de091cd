"""The settings of the scene as a whole: fixed frame, background, frame rate."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import msgspec

from webviz.api.declared import Color
from webviz.api.roles import Role
from webviz.engine.parts.declaring import command
from webviz.engine.parts.part import Core, Part
from webviz.engine.parts.refusals import not_changed
from webviz.files.config import ConfigError, Settings


class SettingsPart(Part):
    """The current settings."""

    name = "Settings"

    def __init__(self, core: Core) -> None:
        super().__init__(core)
        self.settings = Settings()
        """Everything in the config except displays and tools."""

    def set(self, key: str, value: Any) -> None:
        """Change a setting.

        Raises:
            ConfigError: the value is invalid; nothing was changed.
        """
        values = msgspec.to_builtins(self.settings) | {key: value}
        try:
            self.settings = msgspec.convert(values, Settings)
        except msgspec.ValidationError as error:
            raise not_changed(error, Settings, key, value) from error

    def state(self) -> Mapping[str, Any]:
        """All settings."""
        return {"settings": self.settings, "fixed_frame": self.settings.fixed_frame}

    @command(Role.OPERATOR)
    def set_fixed_frame(self, frame: str) -> None:
        """Set the frame that everything is drawn in."""
        if not (name := frame.removeprefix("/")):
            raise ConfigError("The fixed frame needs a name.")
        self.set("fixed_frame", name)

    @command(Role.OPERATOR)
    def set_background(self, color: Color | None) -> None:
        """Set the background colour; None follows the theme of each page."""
        self.set("background", color)

    @command(Role.OPERATOR)
    def set_frame_rate(self, hz: float) -> None:
        """Set the maximum number of scene updates per second."""
        self.set("frame_rate", hz)
