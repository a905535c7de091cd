"""Keys, and commands of the palette that Ctrl+K opens.

RViz's own keys where a browser leaves them to a page. Not those of RViz that open a window, reload
or close a tab in a browser (Ctrl+N, R, X), nor W, A, S, D, Q, E and arrows, which move the camera.
F, which looks at what is under the mouse, is a script of the page. viser does not call commands
while somebody types.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import viser

from webviz.edges.gui.displays_tab import DisplaysTab
from webviz.edges.gui.files import Files
from webviz.edges.gui.time_tab import TimeTab
from webviz.engine.commands import Command, Reset, ResetView


def add_shortcuts(
    gui: viser.GuiApi,
    enqueue: Callable[[Command], None],
    displays: DisplaysTab,
    files: Files,
    time: TimeTab,
) -> None:
    """Register the commands of the panel in every browser.

    Args:
        gui: viser's GUI.
        enqueue: takes commands, from any thread.
        displays, files, time: what they act on.
    """

    def add(label: str, act: Callable[[Any], None], **options: Any) -> None:
        command = gui.add_command(label, **options)

        @command.on_trigger
        def _(event: viser.CommandEvent) -> None:
            act(event.client)

    ctrl, ctrl_shift = "cmd/ctrl", "cmd/ctrl+shift"
    add("Save", files.save, hotkey="S", modifier=ctrl, icon=viser.Icon.DEVICE_FLOPPY)
    add("Save as", files.save_as, hotkey="S", modifier=ctrl_shift)
    add("Open", files.open, hotkey="O", modifier=ctrl, icon=viser.Icon.FOLDER_OPEN)
    add("Save image", files.save_image, icon=viser.Icon.CAMERA)
    add("Reset", lambda _: enqueue(Reset()), hotkey="R", icon=viser.Icon.REFRESH)
    add("Zero view", lambda client: enqueue(ResetView(client.client_id)), hotkey="Z")
    add("Pause or resume", lambda _: time.toggle(), icon=viser.Icon.PLAYER_PAUSE)
    add("Add displays by topic", displays.add_by_topic, hotkey="insert", icon=viser.Icon.PLUS)
    add("Focus on display", displays.focus, icon=viser.Icon.FOCUS_2)
    add("Duplicate display", lambda _: displays.duplicate(), icon=viser.Icon.COPY)
    add("Remove display", lambda _: displays.remove(), hotkey="delete", icon=viser.Icon.TRASH)
