"""The settings of the scene as a whole: fixed frame, background, frame rate."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import msgspec

from webviz.engine.commands import Command, Sender, SetBackground, SetFixedFrame, SetFrameRate
from webviz.engine.parts.part import Core, Handler, Part
from webviz.engine.parts.refusals import not_changed
from webviz.files.config import ConfigError, Settings


class SettingsPart(Part):
    """The current settings."""

    name = "Settings"

    def __init__(self, core: Core) -> None:
        super().__init__(core)
        self.settings = Settings()
        """Everything in the config except displays and tools."""

    @property
    def handles(self) -> Mapping[type[Command], Handler]:
        """The handler of each command."""
        return {
            SetFixedFrame: self._set_fixed_frame,
            SetBackground: self._set_background,
            SetFrameRate: self._set_frame_rate,
        }

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

    def _set_fixed_frame(self, command: SetFixedFrame, sender: Sender) -> None:
        if not (name := command.frame.removeprefix("/")):
            raise ConfigError("The fixed frame needs a name.")
        self.set("fixed_frame", name)

    def _set_background(self, command: SetBackground, sender: Sender) -> None:
        self.set("background", command.color)

    def _set_frame_rate(self, command: SetFrameRate, sender: Sender) -> None:
        self.set("frame_rate", command.hz)
