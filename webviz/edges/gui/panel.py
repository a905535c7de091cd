"""The panel of every browser: RViz's panels as tabs."""

from __future__ import annotations

from collections.abc import Callable

import viser

from webviz.edges.gui.answers import Answers
from webviz.edges.gui.dialogs import Dialogs
from webviz.edges.gui.displays_tab import DisplaysTab
from webviz.edges.gui.file_names import NAME, title_of
from webviz.edges.gui.files import Files
from webviz.edges.gui.shortcuts import add_shortcuts
from webviz.edges.gui.style import panel_style
from webviz.edges.gui.text import escape
from webviz.edges.gui.time_tab import TimeTab
from webviz.edges.gui.topics_tab import TopicsTab
from webviz.edges.gui.transforms_tab import TransformsTab
from webviz.edges.gui.views import ViewsTab
from webviz.engine.commands import Command
from webviz.engine.state import File, State

WIDTH_PX = 360


class Panel:
    """Displays, views, time, transforms and topics.

    All browsers share it. What people do becomes commands; what they see comes from `update`.

    Args:
        server: where the panel appears.
        enqueue: takes commands; called from viser's threads, must not block.
    """

    def __init__(self, server: viser.ViserServer, enqueue: Callable[[Command], None]) -> None:
        self._gui = gui = server.gui
        self._title = ""
        gui.main_panel.dock_left()
        gui.main_panel.set_width(WIDTH_PX)
        self._answers = Answers(server)
        self._dialogs = Dialogs(server, enqueue)
        self._files = Files(self._dialogs, enqueue)
        self._style = gui.add_html("")
        self._call(title_of(File()))
        tabs = gui.add_tab_group()
        with tabs.add_tab("Displays"):
            self._displays = DisplaysTab(server, enqueue, self._dialogs, self._files)
        with tabs.add_tab("Views"):
            self._views = ViewsTab(server, enqueue)
        with tabs.add_tab("Time"):
            self._time = TimeTab(gui, enqueue)
        with tabs.add_tab("TF tree"):
            self._transforms = TransformsTab(gui, enqueue)
        with tabs.add_tab("Topics"):
            self._topics = TopicsTab(gui, enqueue)
        add_shortcuts(gui, enqueue, self._displays, self._files, self._time)

    def update(self, state: State) -> None:
        """Show the viewer as it is; sends only what differs from what is shown.

        To be called by the frame loop some times a second, and after commands: edits settle with
        time.
        """
        self._call(title_of(state.file, state.clock.is_paused))
        self._files.update(state)
        self._displays.update(state)
        self._views.update(state)
        self._time.update(state)
        self._transforms.update(state)
        self._topics.update(state)
        self._dialogs.update(state)
        self._answers.update(state.answer)

    def _call(self, title: str) -> None:
        """Give the panel and the page a title."""
        if title != self._title:
            self._title = title
            self._gui.set_panel_label(title)
            self._style.content = panel_style(
                escape(title if title.startswith(NAME) else f"{title} · {NAME}")
            )
