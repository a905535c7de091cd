"""All pages: what they show of a viewer, and what they ask of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Future
from dataclasses import replace

from webviz.api.registry import registered_types
from webviz.api.roles import Role
from webviz.commands import Refresh
from webviz.engine.commands import PROGRAM, Command, Sender
from webviz.engine.error_boundary import ErrorBoundary
from webviz.engine.feature import stores
from webviz.engine.parts.declaring import stores_of
from webviz.engine.parts.part import Part
from webviz.engine.store import PageStore
from webviz.page.dispatcher import Dispatcher, PageFeature
from webviz.server.access.access import Access
from webviz.server.access.journal import Journal
from webviz.server.channel.channel import Channel
from webviz.server.channel.messages import Shell, ShowPictures


class Pages:
    """Shows a viewer on every page, and passes on what people do there.

    Args:
        channel: to the pages.
        enqueue: takes commands and their senders, from any thread.
        access: knows the tokens; None if none are asked for.
        keep: called with each line of the journal, from any thread.
        parts: of the viewer, which make the stores.
    """

    def __init__(
        self,
        channel: Channel,
        enqueue: Callable[[Command, Sender], Future[str]],
        access: Access | None = None,
        keep: Callable[[str], object] | None = None,
        parts: Sequence[Part] = (),
    ) -> None:
        self._channel = channel
        self._enqueue = enqueue
        self._boundary = ErrorBoundary("The page", strict=False)
        self.journal = Journal(keep)
        """Journal of who did what."""

        def request(command: Command, sender: Sender) -> Future[str]:
            return enqueue(command, _ranked(channel, sender))

        dispatcher = Dispatcher(channel, request, parts, access or Access(), self.journal)
        self._makers = {name: part for part in parts for name in stores_of(type(part))}
        """Parts with stores, by the name of each store."""
        self._with_stores = [part for part in parts if stores_of(type(part))]
        self._watched: dict[Part, set[str]] = {}
        """The stores of each part that are watched."""
        self._cache: dict[str, tuple[object, PageStore | None]] = {}
        """The last of each store that is watched, and what it was made of."""
        self._types = registered_types()
        for part in parts:
            if isinstance(part, PageFeature):
                self._boundary(part.name, part.attach, dispatcher)
        # A store that a page begins to watch is filled on the next turn of the frame loop.
        channel.on_watch = lambda browser: request(Refresh(), Sender(browser))
        channel.may_watch = _may_watch
        # What a pane shows that was not seen before is received from the next turn on.
        channel.on(ShowPictures, lambda browser, _: request(Refresh(), Sender(browser)))
        channel.send(Shell())

    def debug(self) -> None:
        """Show viser's own panel, too."""
        self._channel.send(Shell(debug=True))

    def update(self) -> None:
        """Show the viewer as it is; sends only what is new. To be called by the frame loop."""
        watched = self._channel.watched()
        self._forget(watched)
        self._note_watched(watched)
        for store in watched:
            self._boundary(store, self._fill, store)

    def _note_watched(self, watched: set[str]) -> None:
        """Tell parts which of their stores are watched, if these are others than before."""
        now: dict[Part, set[str]] = {part: set() for part in self._with_stores}
        for store in watched:
            if isinstance(part := self._makers.get(store.partition(":")[0]), Part):
                now[part].add(store)
        before, self._watched = self._watched, now
        changed = [part for part, own in now.items() if own != before.get(part, set())]
        for part in changed:
            self._boundary(part.name, part.watched, now[part])
        if changed:
            self._enqueue(Refresh(), PROGRAM)  # what they read for it is received from then on

    def _fill(self, store: str) -> None:
        name, _, argument = store.partition(":")
        maker = self._makers.get(name)
        if maker is None:
            return
        declared = stores_of(type(maker))[name]
        of = declared.of(maker) if declared.of else None
        last = self._cache.get(store)
        if last is not None and declared.of and last[0] == of:
            return
        store_value = declared.make(maker, argument)
        if last is None or store_value is None or store_value is not last[1]:
            self._channel.show(store, {} if store_value is None else store_value.by_key())
        self._cache[store] = of, store_value

    def _forget(self, watched: set[str]) -> None:
        """Have stores made anew that are not watched any more, and all if there are other types."""
        if (types := registered_types()) != self._types:
            self._types = types
            self._cache.clear()
        for store in self._cache.keys() - watched:
            del self._cache[store]


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
    return own is None or not own.is_private or argument == str(browser)
