"""What browsers look at: does what people ask of views, and lets views follow their frames."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, Protocol

import msgspec

from webviz.api.bounds import Box, union
from webviz.api.frames import Frames
from webviz.api.nodes import Pose
from webviz.api.status import Level, Status
from webviz.api.views import (
    FIXED_FRAME,
    VIEW_TYPES,
    Rig,
    View,
    focus,
    mimic,
    rig_of,
    target_group,
    type_of,
)
from webviz.engine.commands import (
    ChangeView,
    FocusDisplay,
    RemoveView,
    RenameView,
    ResetView,
    SaveImage,
    SaveView,
    ShowView,
    StartWithView,
    ViewCommand,
)
from webviz.files.config import ConfigError, Settings, explain, nearest, sentences


class Cameras(Protocol):
    """The cameras of browsers; see `webviz.edges.scene.cameras.Cameras`."""

    def start_with(self, view: View) -> None:
        """Choose what browsers that join begin with."""
        ...

    def show(self, view: View, browser: int | None = None) -> None:
        """Put the camera of a browser, or of every one, where a view says."""
        ...

    def views(self) -> Mapping[int, View]:
        """What every browser shows now, by its id."""
        ...

    def target_frames(self) -> set[str]:
        """The frames that views follow, or begin to when a browser joins."""
        ...

    def size(self, browser: int) -> tuple[float, float]:
        """Width and height of the picture in a browser, in pixels."""
        ...

    def save_image(self, name: str, browser: int | None = None) -> None:
        """Let a browser, or every one, download what it shows."""
        ...


class NoCameras:
    """Of a scene that no browser shows."""

    def start_with(self, view: View) -> None:
        """Nobody begins."""

    def show(self, view: View, browser: int | None = None) -> None:
        """Nobody looks."""

    def views(self) -> Mapping[int, View]:
        """None."""
        return {}

    def target_frames(self) -> set[str]:
        """None."""
        return set()

    def size(self, browser: int) -> tuple[float, float]:
        """There is no such browser."""
        raise KeyError(browser)

    def save_image(self, name: str, browser: int | None = None) -> None:
        """Nobody downloads."""


class ViewedScene(Protocol):
    """What a scene has besides drawing, to be looked at; see `webviz.edges.scene.Scene`."""

    @property
    def cameras(self) -> Cameras:
        """Of all browsers."""
        ...

    def set_pose(self, group: str, pose: Pose) -> None:
        """Place a group in the fixed frame."""
        ...

    def remove_group(self, group: str) -> None:
        """Remove a group with all its nodes."""
        ...

    def bounds(self, prefix: str) -> Box | None:
        """The box around all that is visible of the groups of a prefix."""
        ...


class Viewing:
    """The views of all browsers.

    Args:
        scene: what they look at.
    """

    def __init__(self, scene: ViewedScene) -> None:
        self._scene = scene
        self._cameras = scene.cameras
        self._start: View | None = None
        self._placed: set[str] = set()

    def start_with(self, view: View) -> None:
        """Let browsers that join begin with a view."""
        if view != self._start:
            self._start = view
            self._cameras.start_with(view)

    def open(self, view: View) -> None:
        """Let every browser begin anew with a view, now and when it joins."""
        self.start_with(view)
        self._cameras.show(view)

    def followed(self) -> set[str]:
        """The frames whose poses `follow` will ask for."""
        return self._cameras.target_frames()

    def follow(self, frames: Frames) -> None:
        """Bring what views follow to where it is; the scene still has to be flushed."""
        wanted = self._cameras.target_frames()
        for frame in wanted:
            if pose := frames.latest(frame):
                self._scene.set_pose(target_group(frame), pose)
        for frame in self._placed - wanted:
            self._scene.remove_group(target_group(frame))
        self._placed = wanted

    def statuses(self, frames: Frames) -> Mapping[str, Status]:
        """Why views stand still."""
        lost = [
            f"The view cannot follow {frame}. {frames.why_not(frame)}"
            for frame in sorted(self._cameras.target_frames())
            if frames.latest(frame) is None
        ]
        return {"Target Frame": Status(Level.WARN, " ".join(lost))} if lost else {}

    def views(self) -> Mapping[int, View]:
        """What every browser shows now, by its id."""
        return self._cameras.views()

    def do(
        self, command: ViewCommand, frames: Frames, settings: Settings, within: Iterable[str]
    ) -> dict[str, Any]:
        """Do what somebody asked for.

        Args:
            command: what.
            frames: where target frames are.
            settings: of the config, with the saved views.
            within: ids of the display that a command names, and of all that are in it.

        Returns:
            The settings that are new.

        Raises:
            ConfigError: it cannot be done, or a value does not fit; a sentence.
        """
        saved = settings.views
        match command:
            case ShowView(view, browser):
                self._cameras.show(_named(view, saved), browser)
            case ChangeView(key, value, browser):
                for id_, view in self._seen(browser).items():
                    self._cameras.show(self._changed(view, key, value, frames, id_), id_)
            case ResetView(browser):
                for id_, view in self._seen(browser).items():
                    self._cameras.show(type(view)(target_frame=view.target_frame), id_)
            case FocusDisplay(_, browser):
                self._focus(within, browser, frames)
            case SaveView(name, browser, view):
                if not name:
                    raise ConfigError("A saved view needs a name.")
                return {"views": {**saved, name: view or self._one(browser)}}
            case RenameView(name, new_name):
                view = _found(name, saved)
                if new_name != name and new_name in saved:
                    raise ConfigError(f"There is a view named {new_name} already.")
                names = {key: new_name if key == name else key for key in saved}
                return {"views": {names[key]: saved[key] for key in saved} | {new_name: view}}
            case RemoveView(name):
                _found(name, saved)
                return {"views": {key: view for key, view in saved.items() if key != name}}
            case StartWithView(browser, view):
                return {"view": self._one(browser) if view is None else _named(view, saved)}
            case SaveImage(browser, name):
                self._cameras.save_image(name, browser)
        return {}

    def _seen(self, browser: int | None) -> Mapping[int, View]:
        """The views of one browser or of all.

        Raises:
            ConfigError: there is none.
        """
        views = self._cameras.views()
        if browser is not None:
            views = {id_: view for id_, view in views.items() if id_ == browser}
        if not views:
            raise ConfigError("No browser is open, or none that is ready.")
        return views

    def _one(self, browser: int | None) -> View:
        views = self._seen(browser)
        return views[max(views)]

    def _changed(self, view: View, key: str, value: Any, frames: Frames, browser: int) -> View:
        rig, height = _rig(type(view), view.target_frame, frames), self._cameras.size(browser)[1]
        if key == "type":
            if value not in VIEW_TYPES:
                raise ConfigError(f"There is no view `{value}`: {nearest(str(value), VIEW_TYPES)}")
            cls = VIEW_TYPES[value]
            new_rig = _rig(cls, view.target_frame, frames)
            return mimic(view, rig, cls, view.target_frame, new_rig, height)
        if key == "target_frame":
            frame = str(value)
            return mimic(view, rig, type(view), frame, _rig(type(view), frame, frames), height)
        values = msgspec.to_builtins(view)
        if key not in values:
            raise ConfigError(f"{type_of(view)} has no `{key}`: {nearest(key, values)}")
        try:
            return msgspec.convert(values | {key: value}, type(view))
        except msgspec.ValidationError as error:
            found = explain(error, type(view), values | {key: value})
            raise ConfigError(f"Not changed: {sentences([found])}") from error

    def _focus(self, within: Iterable[str], browser: int | None, frames: Frames) -> None:
        boxes = (self._scene.bounds(f"{id_}/") for id_ in within)
        box = union(box for box in boxes if box is not None)
        if box is None:
            raise ConfigError("Nothing of it is drawn, so there is nothing to look at.")
        for id_, view in self._seen(browser).items():
            rig = _rig(type(view), view.target_frame, frames)
            size = self._cameras.size(id_)
            self._cameras.show(focus(view, rig, box.low, box.high, *size), id_)


def _rig(cls: type[View], frame: str, frames: Frames) -> Rig:
    return Rig() if frame == FIXED_FRAME else rig_of(cls, frames.latest(frame))


def _named(view: View | str, saved: Mapping[str, View]) -> View:
    return _found(view, saved) if isinstance(view, str) else view


def _found(name: str, saved: Mapping[str, View]) -> View:
    if name not in saved:
        raise ConfigError(f"There is no saved view `{name}`: {nearest(name, saved)}")
    return saved[name]
