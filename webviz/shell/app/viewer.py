"""A viewer in a Python program: `webviz.Viewer`."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import msgspec

from webviz.api.declared import Color
from webviz.api.errors import Error
from webviz.api.status import Status
from webviz.api.views import View
from webviz.engine.commands import (
    AddDisplay,
    Export,
    Load,
    Open,
    Pause,
    RemoveView,
    Reset,
    Save,
    SaveView,
    SetBackground,
    SetFixedFrame,
    SetFrameRate,
    ShowView,
    StartWithView,
)
from webviz.files import config as config_file
from webviz.files import opening
from webviz.shell.app.adding import by_topic, check_properties
from webviz.shell.app.handles import DisplayHandle, NoSuchDisplay
from webviz.shell.app.running import Running, checked_view
from webviz.shell.app.tool_handle import ToolHandle


class Viewer(Running):
    """A viewer at work, with its page at `url`; it ends with `close` or its `with` block.

    Every method returns when what it asks for is done, drawn and shown on the page. All of them may
    be called from any thread but those of displays.

    Args:
        config: a file, YAML, or RViz's if the name ends with .rviz; None: the one that the ROS
            parameter `config_file` names, or else the usual displays.
        port: of the page; 0 picks a free one.
        host: address to listen on; 0.0.0.0 lets everybody watch and change it.
        allow_hosts: names under which browsers may reach this machine, with `host`.
        fixed_frame: instead of the config's.
        source: where messages come from, closed with the viewer; None: the ROS graph.
        ros_args: for the ROS node: `["--ros-args", "-r", "/scan:=/front/scan"]`.
        plugins: Python files with displays, loaded again whenever they are saved.
        autosave: a file that follows every change.
        config_folders: where ROS may open configs, besides the folder of `config`.
        read: reads the config from its file; None is no file.

    Raises:
        Error: the config or a plug-in cannot be read, there is no ROS, or nobody can listen on the
            port; one sentence.
    """

    def __enter__(self) -> Viewer:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<webviz.Viewer at {self.url}>"

    # What it shows

    @property
    def displays(self) -> list[DisplayHandle]:
        """Every display and group in the order of the list."""
        return [DisplayHandle(self, row.id) for row in self.state.rows]

    @property
    def groups(self) -> list[DisplayHandle]:
        """The displays that hold others."""
        return [display for display in self.displays if display.type == "Group"]

    def __getitem__(self, key: str | int) -> DisplayHandle:
        """A display by name, or by its number in the list.

        Raises:
            NoSuchDisplay: there is none, or several have the name.
        """
        rows = self.state.rows
        names = [row.name for row in rows]
        if isinstance(key, int):
            if not -len(rows) <= key < len(rows):
                raise NoSuchDisplay(f"There is no display {key}, only {len(rows)}.")
            number = key
        elif names.count(key) > 1:
            numbers = " or ".join(str(number) for number, name in enumerate(names) if name == key)
            raise NoSuchDisplay(
                f"{names.count(key)} displays are named {key!r}: take one by its number in the "
                f"list, {numbers}."
            )
        elif key in names:
            number = names.index(key)
        else:
            hint = config_file.nearest(key, names)
            raise NoSuchDisplay(f"No display is named {key!r}: {hint}")
        return DisplayHandle(self, rows[number].id)

    def __contains__(self, name: object) -> bool:
        return any(row.name == name for row in self.state.rows)

    def __iter__(self) -> Iterator[DisplayHandle]:
        return iter(self.displays)

    def __len__(self) -> int:
        return len(self.state.rows)

    def __bool__(self) -> bool:
        return True

    def _ipython_key_completions_(self) -> list[str]:
        return [row.name for row in self.state.rows]

    @property
    def frames(self) -> tuple[str, ...]:
        """Every frame id known, sorted."""
        return self.state.frames

    @property
    def topics(self) -> dict[str, tuple[str, ...]]:
        """The message types of every topic of the graph."""
        return dict(self.state.topics)

    @property
    def statuses(self) -> dict[str, Status]:
        """What holds for the viewer as a whole, such as "Fixed Frame"."""
        return dict(self.state.statuses)

    # Changes

    def tool(self, name: str) -> ToolHandle:
        """A tool by its name in the toolbar: `viewer.tool("2D Goal Pose").send(1.0, 2.0)`."""
        return ToolHandle(self, name)

    def add(
        self,
        type: str | None = None,
        *,
        group: DisplayHandle | str | None = None,
        **properties: Any,
    ) -> DisplayHandle:
        """Add a display at the end of the list, or of a group.

        Args:
            type: of the display, such as "LaserScan" or "Group"; None: the one that shows the
                messages of `topic`, which somebody has to publish.
            group: where to.
            properties: as in a config file.

        Raises:
            Error: there is no such type or property, or a value does not fit; one sentence.
        """
        if type is None:
            type, properties = by_topic(properties, self.topics)
        check_properties(type, properties)
        made: list[str] = []
        self.do(AddDisplay(type, properties, self._group_id(group), made.append))
        return DisplayHandle(self, made[0])

    @property
    def fixed_frame(self) -> str:
        """The frame that everything is drawn in."""
        return self.state.fixed_frame

    @fixed_frame.setter
    def fixed_frame(self, frame: str) -> None:
        self.do(SetFixedFrame(frame))

    @property
    def background(self) -> Color:
        """The colour behind the scene."""
        return self.state.settings.background

    @background.setter
    def background(self, color: Color) -> None:
        self.do(SetBackground(color))

    @property
    def frame_rate(self) -> float:
        """How often in a second the scene may change."""
        return self.state.settings.frame_rate

    @frame_rate.setter
    def frame_rate(self, hz: float) -> None:
        self.do(SetFrameRate(hz))

    @property
    def view(self) -> View:
        """What browsers and pictures begin with.

        Assign a view, its values as in a config file, or the name of a saved one: then every
        browser looks so, now and when it joins.
        """
        return self.state.settings.view

    @view.setter
    def view(self, view: View | str | Mapping[str, Any]) -> None:
        wanted = view if isinstance(view, str) else checked_view(view)
        self.do(StartWithView(view=wanted))
        self.do(ShowView(wanted))

    @property
    def views(self) -> dict[str, View]:
        """The saved views by name."""
        return dict(self.state.settings.views)

    def save_view(self, name: str, view: View | Mapping[str, Any] | None = None) -> None:
        """Keep a view under a name, by default what the newest browser shows.

        Raises:
            Error: no browser is open, or a value of the view does not fit.
        """
        self.do(SaveView(name, view=None if view is None else checked_view(view)))

    def remove_view(self, name: str) -> None:
        """Forget a saved view."""
        self.do(RemoveView(name))

    def reset(self) -> None:
        """Forget transforms and messages, as RViz's Reset does."""
        self.do(Reset())

    def pause(self) -> None:
        """Let time stand still on the page; messages wait meanwhile."""
        self.do(Pause(True))

    def resume(self) -> None:
        """Let time go on."""
        self.do(Pause(False))

    # Files

    @property
    def path(self) -> str:
        """The file that the config is saved in, "" if there is none yet."""
        return self.state.file.path

    @property
    def is_changed(self) -> bool:
        """Whether it shows something else than its file says."""
        return self.state.file.is_changed

    def open(self, path: str | os.PathLike[str]) -> None:
        """Show what a config file says instead of what is shown.

        Raises:
            Error: it cannot be read; nothing was changed.
        """
        self.do(Open(str(Path(path).absolute())))

    def save(self, path: str | os.PathLike[str] = "") -> Path:
        """Write what is shown to a file, by default the one it came from.

        Returns:
            The file.

        Raises:
            Error: there is no file yet, or it cannot be written.
        """
        self.do(Save(str(Path(path).absolute()) if path else ""))
        return Path(self.path)

    @property
    def config_text(self) -> str:
        """What would be saved, as YAML."""
        texts: list[str] = []
        self.do(Export(texts.append))
        return texts[0]

    @property
    def config(self) -> dict[str, Any]:
        """What would be saved, as values; assign values or YAML to show something else."""
        return config_file.document(opening.parse(self.config_text, "the config"))

    @config.setter
    def config(self, config: str | Mapping[str, Any]) -> None:
        text = config if isinstance(config, str) else msgspec.json.encode(config).decode()
        self.do(Load(text, "the config"))

    def _group_id(self, group: DisplayHandle | str | None) -> str:
        if group is None:
            return ""
        handle = self[group] if isinstance(group, str) else group
        if handle.type != "Group":
            raise Error(f"{handle.name} is not a group.")
        return handle.id
