"""All pages: what they show of a viewer, and what they ask of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future
from dataclasses import replace
from functools import partial
from typing import Any

from webviz.api.registry import display_types
from webviz.api.roles import Role
from webviz.engine.commands import Command, Refresh, Sender
from webviz.engine.commands.guard import Guard
from webviz.engine.feature import Feature, stores
from webviz.engine.parts.declaring import stores_of
from webviz.engine.state import State
from webviz.engine.store import PageStore
from webviz.page.content import MAKERS
from webviz.page.dependency_tracking import DependencyTracker
from webviz.page.derived_subscriptions import DerivedSubscriptions
from webviz.page.dispatcher import Dispatcher, Handler, PageFeature
from webviz.page.people import MAKERS_OF_PEOPLE, People
from webviz.page.plugin_panels import MAKERS_OF_PANELS, PluginPanels
from webviz.server.access.access import Access
from webviz.server.access.journal import Journal
from webviz.server.access.requests import Dismiss, Invite, Revoke, UseWidget
from webviz.server.channel.channel import Channel
from webviz.server.channel.messages import Shell, ShowPictures

OF_ONE_BROWSER = ("selected", "selection", "view", "view_type")
"""Stores with the id of a browser behind the colon."""


class Pages:
    """Shows a viewer on every page, and passes on what people do there.

    Args:
        channel: to the pages.
        enqueue: takes commands and their senders, from any thread.
        access: knows the tokens; None if none are asked for.
        keep: called with each line of the journal, from any thread.
        features: of the viewer, which make their own stores.
    """

    def __init__(
        self,
        channel: Channel,
        enqueue: Callable[[Command, Sender], Future[str]],
        access: Access | None = None,
        keep: Callable[[str], object] | None = None,
        features: Sequence[Feature] = (),
    ) -> None:
        self._channel = channel
        self._guard = Guard("The page", strict=False)
        self.journal = journal = Journal(keep)
        """Who did what."""

        def note(browser: int, text: str) -> None:
            journal.note(channel.visitors().get(browser), text)

        def request(command: Command, sender: Sender) -> Future[str]:
            return enqueue(command, _ranked(channel, sender))

        self._panels = panels = PluginPanels(request)
        people = People(channel, journal, access or Access())
        handlers: dict[type[Any], Handler] = {
            Dismiss: people.dismiss,
            Invite: people.invite,
            Revoke: people.revoke,
            UseWidget: panels.use,
        }
        self._dispatcher = Dispatcher(channel, request, note, handlers)
        self._derived = DerivedSubscriptions(request)
        self._of_parts: Mapping[str, Callable[[State, str], PageStore | None]] = {
            **{name: partial(make, people) for name, make in MAKERS_OF_PEOPLE.items()},
            **{name: partial(make, panels) for name, make in MAKERS_OF_PANELS.items()},
        }
        self._features = {name: each for each in features for name in stores_of(type(each))}
        """Those with stores, by the name of each store."""
        self._watched: dict[Feature, set[str]] = {}
        """The stores of each that are watched."""
        self._read: dict[str, DependencyTracker] = {}
        """Dependencies of the stores that are kept."""
        self._made: dict[str, PageStore | None] = {}
        """The last of each store of features; the same object is not shown again."""
        self._types = display_types()
        for feature in features:
            if isinstance(feature, PageFeature):
                self._guard(feature.name, feature.attach, self._dispatcher)
        # A store that a page begins to watch is filled on the next turn of the frame loop.
        channel.on_watch = lambda browser: request(Refresh(), Sender(browser))
        channel.may_watch = _may_watch
        # What a pane shows that was not seen before is received from the next turn on.
        channel.on(ShowPictures, lambda browser, _: request(Refresh(), Sender(browser)))
        channel.send(Shell())

    def debug(self) -> None:
        """Show viser's own panel, too."""
        self._channel.send(Shell(debug=True))

    def update(self, state: State) -> None:
        """Show the viewer as it is; sends only what is new. To be called by the frame loop."""
        watched = self._channel.watched()
        self._panels.update(state, watched)
        self._derived.update(watched)
        self._forget(watched)
        self._note_watched(watched)
        for store in watched:
            read = self._read.get(store)
            if read is None or not read.is_as_in(state):
                self._guard(store, self._fill, store, state)

    def _note_watched(self, watched: set[str]) -> None:
        """Tell features which of their stores are watched, if these are others than before."""
        now: dict[Feature, set[str]] = {feature: set() for feature in self._features.values()}
        for store in watched:
            if (feature := self._features.get(store.partition(":")[0])) is not None:
                now[feature].add(store)
        before, self._watched = self._watched, now
        for feature, own in now.items():
            if own != before.get(feature, set()):
                self._guard(feature.name, feature.watched, own)

    def _fill(self, store: str, state: State) -> None:
        name, _, argument = store.partition(":")
        if (feature := self._features.get(name)) is not None:
            made = stores_of(type(feature))[name].make(feature, argument)
            if made is None or made is not self._made.get(store):
                self._show(store, made)
                self._made[store] = made
        elif (make := self._of_parts.get(name)) is not None:
            self._show(store, make(state, argument))
        elif (make := MAKERS.get(name)) is not None:
            reading = DependencyTracker(state)
            self._show(store, make(reading.state, argument))
            self._read[store] = reading

    def _show(self, store: str, made: PageStore | None) -> None:
        self._channel.show(store, {} if made is None else made.by_key())

    def _forget(self, watched: set[str]) -> None:
        """Have stores made anew that are not watched any more, and all if there are other types."""
        if (types := display_types()) != self._types:
            self._types = types
            self._read.clear()
        for store in self._read.keys() - watched:
            del self._read[store]
        for store in self._made.keys() - watched:
            del self._made[store]


def _ranked(channel: Channel, sender: Sender) -> Sender:
    """Return a sender with the priority of their role."""
    if sender.browser is None:
        return sender
    grant = channel.grant_of(sender.browser)
    return replace(sender, priority=Role.WATCHER if grant is None else grant.role)


def _may_watch(browser: int, store: str) -> bool:
    """Return whether a store may be sent to a browser: a view is that of its own page only."""
    name, _, argument = store.partition(":")
    own = stores().get(name)
    is_private = name in OF_ONE_BROWSER if own is None else own.is_private
    return not is_private or argument == str(browser)
