"""The settings of the scene as a whole: fixed frame, background, frame rate."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar

import msgspec

from webviz.api.declared import Color
from webviz.api.nodes import Rgb
from webviz.api.roles import Role
from webviz.engine.forms import Form, form, values_of
from webviz.engine.parts.declaring import command, store
from webviz.engine.parts.part import Part, PartContext
from webviz.engine.parts.refusals import not_changed
from webviz.engine.parts.status_lines import StatusLine, lines
from webviz.engine.store import PageStore
from webviz.files.config import ConfigError, Settings

NO_CONTROL = (
    *("version", "view", "views", "memory", "watch", "watch_limits", "bookmarks", "rviz"),
    *("layout", "layouts", "publish"),
)
"""Settings that have another place on the page, or none."""


class SettingsStore(PageStore, frozen=True):
    """Settings of the viewer, and its statuses.

    Args:
        declared, values: of the properties of the settings.
        fixed_frame, background, frame_rate: among the values, too.
        views: names of the saved ones.
        statuses, more: see `webviz.engine.parts.status_lines.StatusesStore`.
    """

    spread: ClassVar = {"values": "value."}

    declared: Form
    values: Mapping[str, Any]
    fixed_frame: str
    background: Rgb | None
    frame_rate: float
    views: Sequence[str]
    statuses: Sequence[StatusLine]
    more: int


class SettingsPart(Part):
    """The current settings."""

    name = "Settings"

    def __init__(self, context: PartContext) -> None:
        super().__init__(context)
        self.settings = Settings()
        """Everything in the config except displays and tools."""

    def state(self) -> Mapping[str, Any]:
        """Return the settings."""
        return {"settings": self.settings, "fixed_frame": self.settings.fixed_frame}

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

    @store(name="settings", of=lambda part: (part.settings, part.context.statuses))
    def settings_store(self, argument: str) -> SettingsStore:
        """Return the settings, and the statuses of the viewer as a whole."""
        settings = self.settings
        status_lines = lines(self.context.statuses)
        return SettingsStore(
            declared=form(Settings, NO_CONTROL),
            values=values_of(settings, NO_CONTROL),
            fixed_frame=settings.fixed_frame,
            background=settings.background,
            frame_rate=settings.frame_rate,
            views=list(settings.views),
            statuses=status_lines.statuses,
            more=status_lines.more,
        )

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
