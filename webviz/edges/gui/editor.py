"""Statuses and properties of the selected display."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import viser

from webviz.api.display import Display
from webviz.api.panel import Edit, Send
from webviz.api.ports import Input, Output
from webviz.api.properties import Property, properties_of
from webviz.edges.gui.control import Choice, Control
from webviz.edges.gui.controls import add_control
from webviz.edges.gui.text import StatusLines, plain
from webviz.edges.gui.toolbar import Actions, Toolbar
from webviz.engine.commands import SetProperty
from webviz.engine.state import Row, State

FIXED_FRAME = "<Fixed Frame>"

IN_THE_LIST = ("enabled",)
"""Properties that the list of displays shows."""


class Editor:
    """One display in the panel, from its selection until another one is selected.

    Args:
        gui: viser's GUI.
        row: the display.
        send: takes commands, from any thread.
        actions: what can be done with the display as a whole.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        row: Row,
        send: Send,
        actions: Actions,
    ) -> None:
        self._gui = gui
        self._send = send
        self._id = row.id
        self._class = type(row.display)
        self._controls: list[tuple[Property, Control]] = []
        self._folders: list[tuple[Property, viser.GuiFolderHandle]] = []
        self._topics = Topics()
        self._folder = gui.add_folder(_title(row))
        with self._folder:
            self._toolbar = Toolbar(gui, send, actions)
            self._statuses = StatusLines(gui)
            if row.display is not None:
                for declared in properties_of(type(row.display)):
                    if declared.path not in IN_THE_LIST:
                        self._add(declared, row.display)

    def fits(self, row: Row) -> bool:
        """Whether this editor has the controls for that display."""
        return row.id == self._id and type(row.display) is self._class

    def update(self, row: Row, state: State) -> None:
        """Show the display as it is now."""
        self._folder.label = _title(row)
        self._toolbar.update()
        self._statuses.show(row.statuses)
        if row.display is None:
            return
        for declared, control in self._controls:
            value = declared.of(row.display)
            if isinstance(control, Choice):
                control.offer(self._offered(declared, state), value)
            control.show(value)
            if declared.when:
                control.show_when(declared.applies(row.display))
        for declared, folder in self._folders:
            if declared.when:
                folder.visible = declared.applies(row.display)

    def remove(self) -> None:
        """Take it out of the panel."""
        self._folder.remove()

    def _add(self, declared: Property, display: Display) -> None:
        if declared.port is not None:
            self._add_topic(declared, declared.port, display)
        elif declared.children:
            self._add_folder(declared, display, declared.label)
        else:
            control = add_control(
                self._gui, declared, declared.of(display), self._edit(declared.path)
            )
            self._controls.append((declared, control))

    def _add_topic(self, declared: Property, wanted: Input | Output, display: Display) -> None:
        """The topics there are, to choose from; any other name and the QoS in a folder."""
        name = next(child for child in declared.children if child.path == f"{declared.path}.name")
        choice = Choice(
            self._gui,
            declared.label,
            name.of(display),
            self._edit(name.path),
            f"{declared.help} ({wanted.type})".lstrip(),
        )
        self._controls.append((replace(name, port=wanted, when=declared.when), choice))
        self._add_folder(declared, display, f"{declared.label}: name and QoS", expand=False)

    def _add_folder(
        self, declared: Property, display: Display, label: str, expand: bool = True
    ) -> None:
        folder = self._gui.add_folder(label, expand_by_default=expand)
        self._folders.append((declared, folder))
        with folder:
            for child in declared.children:
                self._add(child, display)

    def _edit(self, path: str) -> Edit:
        return lambda value, browser: self._send(SetProperty(self._id, path, value), browser)

    def _offered(self, declared: Property, state: State) -> tuple[str, ...]:
        if declared.port is not None:
            return self._topics.of_type(declared.port.type, state.topics)
        return (FIXED_FRAME, *state.frames)


class Topics:
    """The live topics of a type, looked up again only when the topics change."""

    def __init__(self) -> None:
        self._types: Mapping[str, tuple[str, ...]] | None = None
        self._known: dict[str, tuple[str, ...]] = {}

    def of_type(self, type_: str, topics: Mapping[str, tuple[str, ...]]) -> tuple[str, ...]:
        """Names of the topics of this type, sorted."""
        if topics is not self._types and topics != self._types:
            self._types, self._known = topics, {}
        if type_ not in self._known:
            self._known[type_] = tuple(sorted(n for n, types in topics.items() if type_ in types))
        return self._known[type_]


def _title(row: Row) -> str:
    return f"{plain(row.name)} · {plain(row.type)}" if row.name != row.type else plain(row.name)
