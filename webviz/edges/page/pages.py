"""All pages: what they show of a viewer, and what they ask of it."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future

from webviz.edges.page.acts import Acts
from webviz.edges.page.channel import Channel
from webviz.edges.page.content import MAKERS
from webviz.edges.page.messages import Ping, Pong, Shell
from webviz.edges.page.plugin_panels import PluginPanels
from webviz.edges.page.toolbar import Toolbar
from webviz.edges.page.wishes import Wishes
from webviz.engine.commands import Command, Refresh, Sender
from webviz.engine.pipeline.guard import Guard
from webviz.engine.state import State


class Pages:
    """Shows a viewer on every page, and passes on what people do there.

    Args:
        channel: to the pages.
        enqueue: takes commands and their senders, from any thread.
    """

    def __init__(self, channel: Channel, enqueue: Callable[[Command, Sender], Future[str]]) -> None:
        self._channel = channel
        self._guard = Guard("The page", strict=False)
        self._toolbar = Toolbar(channel, enqueue)
        self._acts = Acts(channel, enqueue)
        self._wishes = Wishes(enqueue)
        self._panels = panels = PluginPanels(channel, enqueue)
        self._makers = {
            **MAKERS,
            "commands": panels.commands,
            "panel": panels.panel,
            "panels": panels.panels,
        }
        # A store that a page begins to watch is filled on the next turn of the frame loop.
        channel.on_watch = lambda browser: enqueue(Refresh(), Sender(browser))
        channel.on(Ping, lambda browser, _: channel.send(Pong(), browser))
        channel.send(Shell())

    def debug(self) -> None:
        """Show viser's own panel, too."""
        self._channel.send(Shell(debug=True))

    def update(self, state: State) -> None:
        """Show the viewer as it is; sends only what is new. To be called by the frame loop."""
        self._toolbar.update(state)
        self._panels.update(state)
        watched = self._channel.watched()
        self._wishes.update(watched)
        for store in watched:
            self._guard(store, self._fill, store, state)

    def _fill(self, store: str, state: State) -> None:
        name, _, argument = store.partition(":")
        if (make := self._makers.get(name)) is not None:
            self._channel.show(store, make(state, argument))
