"""The views of all browsers: their commands, and following target frames."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import msgspec
import numpy as np

from webviz.api.bounds import Box, union
from webviz.api.frames import Frames
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
from webviz.data.names import file_problem_of, problem_of
from webviz.data.words import joined
from webviz.engine.commands import (
    ChangeView,
    Command,
    FocusDisplay,
    FocusFrame,
    RemoveView,
    RenameView,
    ResetView,
    SaveImage,
    SaveView,
    Sender,
    ShowView,
    StartWithView,
)
from webviz.engine.parts.displays import DisplaysPart
from webviz.engine.parts.part import Core, Handler, Part
from webviz.engine.parts.refusals import not_changed
from webviz.engine.parts.settings import SettingsPart
from webviz.files.config import ConfigError, nearest

FRAME_M = 0.5
"""Half of the edge of the cube around a frame that is looked at."""


class ViewsPart(Part):
    """The views of all browsers.

    Args:
        core: shared by all parts.
        settings: has the saved views, and the one to start with.
        displays: can be focused on.
    """

    name = "Views"

    def __init__(self, core: Core, settings: SettingsPart, displays: DisplaysPart) -> None:
        super().__init__(core)
        self._settings = settings
        self._displays = displays
        self._scene = core.scene
        self._cameras = core.scene.cameras
        self._start: View | None = None
        self._placed: set[str] = set()

    @property
    def handles(self) -> Mapping[type[Command], Handler]:
        """The handler of each command."""
        return {
            ShowView: self._show,
            ChangeView: self._change,
            ResetView: self._zero,
            FocusDisplay: self._focus,
            FocusFrame: self._focus_frame,
            SaveView: self._save,
            RenameView: self._rename,
            RemoveView: self._remove,
            StartWithView: self._begin_with,
            SaveImage: self._save_image,
        }

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
        """Return the frames whose poses `follow` needs."""
        return self._cameras.target_frames()

    def follow(self, targets: set[str], frames: Frames) -> None:
        """Move views with their target frames; call before the scene is flushed."""
        for frame in targets:
            if pose := frames.latest(frame):
                self._scene.set_pose(target_group(frame), pose)
        for frame in self._placed - targets:
            self._scene.remove_group(target_group(frame))
        self._placed = targets

    def statuses(self) -> Mapping[str, Status]:
        """Return views whose target frame has no pose."""
        frames = self.core.frames
        lost = [
            f"The view cannot follow {frame}. {frames.why_not(frame)}"
            for frame in sorted(self._cameras.target_frames())
            if frames.latest(frame) is None
        ]
        return {"Target Frame": Status(Level.WARN, joined(*lost))} if lost else {}

    def state(self) -> Mapping[str, Any]:
        """Return the current view of every browser."""
        return {"views": self._cameras.views()}

    # Commands

    def _show(self, command: ShowView, sender: Sender) -> None:
        view = _named(command.view, self._saved())
        self._cameras.show(view, _browser(command, sender))

    def _change(self, command: ChangeView, sender: Sender) -> None:
        for id, view in self._seen(_browser(command, sender)).items():
            self._cameras.show(self._changed(view, command.key, command.value, id), id)

    def _zero(self, command: ResetView, sender: Sender) -> None:
        for id, view in self._seen(_browser(command, sender)).items():
            self._cameras.show(zero(view), id)

    def _focus(self, command: FocusDisplay, sender: Sender) -> None:
        ids = self._displays.list.within(command.display)
        boxes = (self._scene.bounds(f"{id}/") for id in ids)
        box = union(box for box in boxes if box is not None)
        if box is None:
            raise ConfigError("This display draws nothing to focus on. Check its statuses.")
        self._look_at(box, _browser(command, sender))

    def _focus_frame(self, command: FocusFrame, sender: Sender) -> None:
        frames = self.core.frames
        pose = frames.latest(command.frame)
        if pose is None:
            raise ConfigError(frames.why_not(command.frame))
        origin = np.array(pose.position)
        self._look_at(Box(origin - FRAME_M, origin + FRAME_M), _browser(command, sender))

    def _look_at(self, box: Box, browser: int | None) -> None:
        for id, view in self._seen(browser).items():
            rig = self._rig(view)
            size = self._cameras.size(id)
            self._cameras.show(focus(view, rig, box.low, box.high, *size), id)

    def _save(self, command: SaveView, sender: Sender) -> None:
        _check_name(command.name)
        view = command.view or self._one(_browser(command, sender))
        self._keep({**self._saved(), command.name: view})

    def _rename(self, command: RenameView, sender: Sender) -> None:
        saved, name, new_name = self._saved(), command.name, command.new_name
        view = _found(name, saved)
        _check_name(new_name)
        if new_name != name and new_name in saved:
            raise ConfigError(f"A view named {new_name} exists already. Choose another name.")
        names = {key: new_name if key == name else key for key in saved}
        self._keep({names[key]: saved[key] for key in saved} | {new_name: view})

    def _remove(self, command: RemoveView, sender: Sender) -> None:
        saved = self._saved()
        _found(command.name, saved)
        self._keep({key: view for key, view in saved.items() if key != command.name})

    def _begin_with(self, command: StartWithView, sender: Sender) -> None:
        if command.view is None:
            view = self._one(_browser(command, sender))
        else:
            view = _named(command.view, self._saved())
        self._settings.set("view", view)
        self.start_with(view)

    def _save_image(self, command: SaveImage, sender: Sender) -> None:
        if command.name and (problem := file_problem_of(command.name)):
            raise ConfigError(problem)
        self._cameras.save_image(command.name, _browser(command, sender))

    def _seen(self, browser: int | None) -> Mapping[int, View]:
        """Return the views of one browser, or of all.

        Raises:
            ConfigError: no browser is connected.
        """
        views = self._cameras.views()
        if browser is not None:
            views = {id_: view for id_, view in views.items() if id_ == browser}
        if not views:
            raise ConfigError(
                "No browser is connected. Open the viewer in one, or wait until it has loaded."
            )
        return views

    def _one(self, browser: int | None) -> View:
        views = self._seen(browser)
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
        return rig_of(view, None if frame == FIXED_FRAME else self.core.frames.latest(frame))

    def _saved(self) -> Mapping[str, View]:
        return self._settings.settings.views

    def _keep(self, views: Mapping[str, View]) -> None:
        self._settings.set("views", views)


def _check_name(name: str) -> None:
    if problem := problem_of(name):
        raise ConfigError(problem)


def _browser(command: Any, sender: Sender) -> int | None:
    """Return the browser that a command acts on, None for all."""
    return sender.browser if command.browser is None else command.browser


def _named(view: View | str, saved: Mapping[str, View]) -> View:
    return _found(view, saved) if isinstance(view, str) else view


def _found(name: str, saved: Mapping[str, View]) -> View:
    if name not in saved:
        raise ConfigError(f"Unknown saved view `{name}`: {nearest(name, saved)}")
    return saved[name]
