"""The views of all browsers: their commands, and following target frames."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar

import msgspec
import numpy as np

from webviz.api.bounds import Box, union
from webviz.api.frames import Frames
from webviz.api.roles import Role
from webviz.api.status import Level, Status
from webviz.api.views import (
    FIXED_FRAME,
    VIEW_TYPES,
    FrameAligned,
    Rig,
    View,
    focus,
    like,
    mimic,
    rig_of,
    target_group,
    type_of,
    zero,
)
from webviz.data.names import file_problem_of
from webviz.data.words import joined
from webviz.engine.commands import Sender
from webviz.engine.forms import Form, form, values_of
from webviz.engine.parts.declaring import command, store
from webviz.engine.parts.displays import DisplaysPart
from webviz.engine.parts.panels import PanelsPart
from webviz.engine.parts.part import Part, PartContext
from webviz.engine.parts.refusals import not_changed
from webviz.engine.parts.settings import SettingsPart
from webviz.engine.store import PageStore
from webviz.files.config import Config, ConfigError, nearest

DIGITS = 3
"""Decimals that are shown; a view moved by hand has more."""
NOTHING_DRAWN = "This display draws nothing to focus on. Check its statuses."
FRAME_M = 1.5
"""Half of the edge of the cube around a frame that is looked at."""


class ViewStore(PageStore, frozen=True):
    """The view of a browser.

    Args:
        declared, values: of its properties, rounded, and "type".
        types: of views.
    """

    spread: ClassVar = {"values": "value."}

    declared: Form
    types: Sequence[str]
    values: Mapping[str, Any]


class ViewTypeStore(PageStore, frozen=True):
    """The view of a browser: its type and the frame that it follows; unset before it has one."""

    type: str | msgspec.UnsetType = msgspec.UNSET
    target_frame: str | msgspec.UnsetType = msgspec.UNSET


class WatchersStore(PageStore, frozen=True):
    """Number of browsers that watch the scene."""

    count: int


class ViewsPart(Part):
    """The views of all browsers.

    Args:
        context: shared by all parts.
        settings: has the saved views, and the one to start with.
        displays: can be focused on.
    """

    name = "Views"

    def __init__(
        self, context: PartContext, settings: SettingsPart, displays: DisplaysPart
    ) -> None:
        super().__init__(context)
        self._settings = settings
        self._displays = displays
        self._scene = context.scene
        self._cameras = context.scene.cameras
        self._start: View | None = None
        self._placed: set[str] = set()

    def start_with(self, view: View) -> None:
        """Choose the view that browsers start with."""
        if view != self._start:
            self._start = view
            self._cameras.start_with(view)

    def open(self, view: View) -> None:
        """Show a view in every browser, now and when it connects."""
        self.start_with(view)
        self._cameras.show(view)

    def followed(self) -> set[str]:
        """Return the frames whose poses `follow` needs: those of views and of panels."""
        return self._cameras.target_frames() | self.context.get(PanelsPart).target_frames()

    def follow(self, targets: set[str], frames: Frames) -> None:
        """Move views with their target frames; call before the scene is flushed."""
        for frame in targets:
            if pose := frames.latest(frame):
                self._scene.set_pose(target_group(frame), pose)
        for frame in self._placed - targets:
            self._scene.remove_group(target_group(frame))
        self._placed = targets

    def state(self) -> Mapping[str, Any]:
        """Return the current view of every browser."""
        return {"views": self.current()}

    def statuses(self) -> Mapping[str, Status]:
        """Return views whose target frame has no pose."""
        frames = self.context.frames
        problems = [
            f"The view cannot follow {frame}. {frames.why_not(frame)}"
            for frame in sorted(self.followed())
            if frames.latest(frame) is None
        ]
        return {"Target Frame": Status(Level.WARN, joined(*problems))} if problems else {}

    # Stores

    @store(is_private=True)
    def view(self, browser: str) -> ViewStore | None:
        """Return a browser's view; None before it has one."""
        own_view = self._view_of(browser)
        if own_view is None:
            return None
        values = {key: _rounded(value) for key, value in values_of(own_view).items()}
        return ViewStore(
            form(type(own_view)), list(VIEW_TYPES), {"type": type_of(own_view)} | values
        )

    @store(is_private=True)
    def view_type(self, browser: str) -> ViewTypeStore:
        """Return the type of view of a browser."""
        view = self._view_of(browser)
        return ViewTypeStore() if view is None else ViewTypeStore(type_of(view), view.target_frame)

    @store()
    def watchers(self, argument: str) -> WatchersStore:
        """Return the number of browsers that watch the scene."""
        return WatchersStore(len(self.current()))

    def current(self) -> Mapping[int, View]:
        """Return the current view of every browser."""
        return self._cameras.views()

    def as_seen(self, config: Config, sender: Sender) -> Config:
        """Return a config that begins with the view of the browser that sent a command."""
        view = self.current().get(sender.browser) if sender.browser is not None else None
        if view is None:
            return config
        settings = msgspec.structs.replace(config.settings, view=view)
        return msgspec.structs.replace(config, settings=settings)

    def _view_of(self, browser: str) -> View | None:
        return self.current().get(int(browser)) if browser.isdecimal() else None

    # Commands

    @command(Role.WATCHER)
    def show_view(self, sender: Sender, view: View | str, browser: int | None = None) -> None:
        """Show a view.

        Args:
            view: a view, or the name of a saved one.
            browser: on which it acts; by default the one that sends this, or all for a program.
        """
        view = _named(view, self._saved())
        self._cameras.show(view, _browser(browser, sender))

    @command(Role.WATCHER)
    def change_view(self, sender: Sender, key: str, value: Any, browser: int | None = None) -> None:
        """Change a property of the current view, with as little camera movement as possible.

        Args:
            key: name of the property: "type", "target_frame", "distance" and so on.
            value: its new value; a name of `VIEW_TYPES` for "type".
            browser: on which it acts; by default the one that sends this, or all for a program.
        """
        for id, view in self._views_of(_browser(browser, sender)).items():
            self._cameras.show(self._changed(view, key, value, id), id)

    @command(Role.WATCHER)
    def reset_view(self, sender: Sender, browser: int | None = None) -> None:
        """Reset the view to the defaults of its type, as RViz's Zero does."""
        for id, view in self._views_of(_browser(browser, sender)).items():
            self._cameras.show(zero(view), id)

    @command(Role.WATCHER)
    def focus_display(self, sender: Sender, display: str, browser: int | None = None) -> None:
        """Fit the view to everything that a display or group draws.

        Args:
            display: id of the display or group; "" for all.
            browser: on which it acts; by default the one that sends this, or all for a program.
        """
        display_list = self._displays.list
        ids = (
            display_list.within(display) if display else [each.id for each in display_list.active()]
        )
        boxes = (self._scene.bounds(f"{id}/") for id in ids)
        box = union(box for box in boxes if box is not None)
        if box is None:
            raise ConfigError(NOTHING_DRAWN if display else "Nothing is drawn yet.")
        self._look_at(box, _browser(browser, sender))

    @command(Role.WATCHER)
    def focus_frame(self, sender: Sender, frame: str, browser: int | None = None) -> None:
        """Look at the origin of a frame, from the same direction.

        Args:
            frame: its id.
            browser: on which it acts; by default the one that sends this, or all for a program.
        """
        frames = self.context.frames
        pose = frames.latest(frame)
        if pose is None:
            raise ConfigError(frames.why_not(frame))
        origin = np.array(pose.position)
        self._look_at(Box(origin - FRAME_M, origin + FRAME_M), _browser(browser, sender))

    def _look_at(self, box: Box, browser: int | None) -> None:
        for id, view in self._views_of(browser).items():
            rig = self._rig(view)
            size = self._cameras.size(id)
            self._cameras.show(focus(view, rig, box.low, box.high, *size), id)

    @command(Role.OPERATOR)
    def start_with_view(
        self, sender: Sender, browser: int | None = None, view: View | str | None = None
    ) -> None:
        """Make the current view the default of browsers and screenshots.

        Args:
            browser: on which it acts; by default the one that sends this, or for a program the one
                that connected last.
            view: instead of the current view; a view or the name of a saved one.
        """
        view = self.one(browser, sender) if view is None else _named(view, self._saved())
        self._settings.set("view", view)
        self.start_with(view)

    @command(Role.WATCHER)
    def save_image(self, sender: Sender, browser: int | None = None, name: str = "") -> None:
        """Let a browser download its picture as a PNG.

        Args:
            browser: on which it acts; by default the one that sends this, or all for a program.
            name: of the file; "" is one with date and time.
        """
        if name and (problem := file_problem_of(name)):
            raise ConfigError(problem)
        self._cameras.save_image(name, _browser(browser, sender))

    def _views_of(self, browser: int | None) -> Mapping[int, View]:
        """Return the views of one browser, or of all.

        Raises:
            ConfigError: no browser is connected.
        """
        views = self.current()
        if browser is not None:
            views = {id_: view for id_, view in views.items() if id_ == browser}
        if not views:
            raise ConfigError(
                "No browser is connected. Open the viewer in one, or wait until it has loaded."
            )
        return views

    def one(self, browser: int | None, sender: Sender) -> View:
        """Return the view of a browser.

        Args:
            browser: id; by default the one that sends a command, or for a program the one that
                connected last.
            sender: of the command.

        Raises:
            ConfigError: no browser is connected.
        """
        views = self._views_of(_browser(browser, sender))
        return views[max(views)]

    def _changed(self, view: View, key: str, value: Any, browser: int) -> View:
        rig = self._rig(view)
        height = self._cameras.size(browser)[1]
        if key == "type":
            if value not in VIEW_TYPES:
                raise ConfigError(f"Unknown view type `{value}`: {nearest(str(value), VIEW_TYPES)}")
            other = like(VIEW_TYPES[value], view)
            return mimic(view, rig, other, self._rig(other), height)
        if key == "target_frame" and not isinstance(view, FrameAligned):  # as RViz, which jumps
            other = like(type(view), view, target_frame=str(value))
            return mimic(view, rig, other, self._rig(other), height)
        values = msgspec.to_builtins(view)
        if key not in values:
            raise ConfigError(f"{type_of(view)} has no `{key}`: {nearest(key, values)}")
        try:
            changed = msgspec.convert(values | {key: value}, type(view))
        except msgspec.ValidationError as error:
            raise not_changed(error, type(view), key, value) from error
        return zero(changed) if key == "point_towards" else changed

    def _rig(self, view: View) -> Rig:
        frame = view.target_frame
        return rig_of(view, None if frame == FIXED_FRAME else self.context.frames.latest(frame))

    def _saved(self) -> Mapping[str, View]:
        return self._settings.settings.views


def _browser(browser: int | None, sender: Sender) -> int | None:
    """Return the browser that a command acts on, None for all."""
    return sender.browser if browser is None else browser


def _named(view: View | str, saved: Mapping[str, View]) -> View:
    return saved_view(view, saved) if isinstance(view, str) else view


def saved_view(name: str, saved: Mapping[str, View]) -> View:
    """Return a saved view.

    Raises:
        ConfigError: there is none of this name.
    """
    if name not in saved:
        raise ConfigError(f"Unknown saved view `{name}`: {nearest(name, saved)}")
    return saved[name]


def _rounded(value: Any) -> Any:
    """Numbers as they are shown; small ones keep digits that count."""
    if isinstance(value, list):
        return [_rounded(part) for part in value]
    if not isinstance(value, float):
        return value
    least = -math.floor(math.log10(abs(value))) if value else 0
    return round(value, max(DIGITS, min(least + 1, 6)))
