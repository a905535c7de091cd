"""People who are connected, what they did, and invitations of the owner."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future
from datetime import UTC, datetime
from typing import Annotated, ClassVar, Literal, TypeVar

import msgspec

from webviz.api.errors import Error
from webviz.api.roles import Role
from webviz.data.disk import DiskThreads
from webviz.engine.commands import PageCommand
from webviz.engine.feature import command, store
from webviz.engine.parts.part import PartContext
from webviz.engine.store import PageStore
from webviz.page.dispatcher import Dispatcher, PageFeature
from webviz.page.page_request import PageRequest
from webviz.server.access import token_file
from webviz.server.access.journal import JournalEntry
from webviz.server.access.starting import link
from webviz.server.access.tokens import Token, TokenError, make
from webviz.server.channel.messages import Dismissed

NOT_ASKED = (
    "Not made: this viewer requires no tokens. Start webviz with --token, or with --host for "
    "other machines."
)
OWN_LINK = "Failed: this is your own link. Make another with `webviz token rotate`."

MAX_THREADS = 4
"""Largest number of threads that change the file of tokens, or wait for it."""

Name = Annotated[str, msgspec.Meta(max_length=100)]
Address = Annotated[str, msgspec.Meta(max_length=300, pattern="^https?://")]
T = TypeVar("T")


class Person(msgspec.Struct, frozen=True):
    """A connected browser.

    Args:
        name, role: of its visitor.
        since_s: seconds since 1970.
        latency_ms: None while it is unknown.
        drives: names of the tools with which it drives.
    """

    name: str
    role: str
    since_s: int
    latency_ms: int | None
    drives: Sequence[str]


class PeopleStore(PageStore, frozen=True):
    """The connected browsers by id."""

    spread: ClassVar = {"people": ""}

    people: Mapping[str, Person]


class AddressesStore(PageStore, frozen=True):
    """The network addresses of browsers by their id."""

    spread: ClassVar = {"addresses": ""}

    addresses: Mapping[str, str]


class ValidLink(msgspec.Struct, frozen=True):
    """A link: its role, and when it ends in seconds since 1970, None for never."""

    role: str
    expires_s: float | None


class LinksStore(PageStore, frozen=True):
    """The valid links by name."""

    spread: ClassVar = {"links": ""}

    links: Mapping[str, ValidLink]


class JournalStore(PageStore, frozen=True):
    """People's actions, newest first."""

    entries: Sequence[JournalEntry]


class People(PageFeature):
    """Shows who is connected and what they did, and invites others."""

    name = "People"
    module = "people.js"

    def __init__(self, context: PartContext) -> None:
        super().__init__(context)
        self._disconnecting: set[asyncio.Task[None]] = set()
        self._disk = DiskThreads(MAX_THREADS)

    def attach(self, dispatcher: Dispatcher) -> None:
        """Begin to show the people of these pages."""
        self._channel, self._access = dispatcher.channel, dispatcher.access
        self._journal = dispatcher.journal

    @store()
    def people(self, argument: str) -> PeopleStore:
        """Return the connected browsers."""
        fact = self.context.fact
        names = {button.id: button.name for button in fact("tools", ())}
        driving = {tool: vehicle.driver for tool, vehicle in fact("driving", {}).items()}
        return PeopleStore(
            {
                str(browser): Person(
                    name=visitor.name,
                    role=visitor.role.label,
                    since_s=round(visitor.since_s),
                    latency_ms=round(1000.0 * visitor.latency_s) if visitor.latency_s else None,
                    drives=[names.get(t, t) for t, driver in driving.items() if driver == browser],
                )
                for browser, visitor in self._channel.visitors().items()
            }
        )

    @store(Role.OWNER)
    def addresses(self, argument: str) -> AddressesStore:
        """Return the network addresses of browsers."""
        visitors = self._channel.visitors()
        return AddressesStore({str(id_): visitor.address for id_, visitor in visitors.items()})

    @store(Role.OWNER)
    def links(self, argument: str) -> LinksStore:
        """Return the valid links."""
        return LinksStore({token.name: _link(token) for token in self._access.tokens})

    @store(Role.OWNER)
    def journal(self, argument: str) -> JournalStore:
        """Return people's actions."""
        return JournalStore(self._journal.entries)

    # Called on the event loop

    @command(Role.OWNER, PageCommand, is_noted=True)
    def invite(
        self,
        name: Name,
        role: Literal["watcher", "operator", "owner"],
        days: float | None,
        url: Address,
        page_request: PageRequest,
    ) -> None:
        """Make a link for another person; the answer has the `link` and its QR `code`.

        Args:
            name: of who gets the link.
            role: that it gives.
            days: until it ends, None for never.
            url: of the page, to which the token is added.
        """
        granted = Role[role.upper()]

        def answer(future: Future[Token]) -> None:
            try:
                address = link(url, future.result())
            except Error as error:
                page_request.refuse(str(error))
                return
            import segno  # here, as it would slow down the start

            code = segno.make(address, micro=False).svg_data_uri(scale=5, border=4, light="#fff")
            page_request.answer(f"Invited {name} as {granted.phrase}.", link=address, code=code)

        self._begin(lambda: self._make(name, granted, days)).add_done_callback(answer)

    @command(Role.OWNER, PageCommand, is_noted=True)
    def dismiss(self, visitor: int, revokes: bool, page_request: PageRequest) -> None:
        """End the visit of another person.

        Args:
            visitor: id of the browser whose visit ends.
            revokes: whether its link is not valid any more, either.
        """
        visitor_entry = self._channel.visitors().get(visitor)
        grant = self._channel.grant_of(visitor)
        if visitor_entry is None or grant is None:
            page_request.refuse("This visitor has already left.")
        elif visitor == page_request.browser:
            page_request.refuse("Failed: this is your own page. Close it.")
        elif revokes:
            self.revoke(grant.name, page_request)
        else:
            text = (
                "The owner has disconnected this page. Open the address of the viewer again to "
                "come back."
            )
            self._channel.send(Dismissed(text), visitor)
            task = asyncio.get_running_loop().create_task(self._channel.disconnect(visitor))
            self._disconnecting.add(task)
            task.add_done_callback(self._disconnecting.discard)
            page_request.answer(f"Ended a visit of {visitor_entry.name or visitor_entry.address}.")

    @command(Role.OWNER, PageCommand, is_noted=True)
    def revoke(self, name: Name, page_request: PageRequest) -> None:
        """End a link, and all visits by it.

        Args:
            name: of the link.
        """
        own = self._channel.grant_of(page_request.browser)
        if name and own is not None and own.name == name:
            page_request.refuse(OWN_LINK)
            return

        def answer(future: Future[None]) -> None:
            try:
                future.result()
            except Error as error:
                page_request.refuse(str(error))
            else:
                page_request.answer(f"Revoked the link of {name}.")

        self._begin(lambda: self._remove(name)).add_done_callback(answer)

    def _begin(self, work: Callable[[], T]) -> Future[T]:
        """Work on the file of tokens in a thread; it fails if too much does already."""
        try:
            return self._disk.start(work)
        except OSError:
            refused: Future[T] = Future()
            refused.set_exception(TokenError("Failed: too many at once. Try again later."))
            return refused

    def _remove(self, name: str) -> None:
        """Remove a token from the file; its pages are closed soon."""
        if not self._access.asks or self._access.path is None:
            raise TokenError("Not revoked: this viewer requires no tokens.")

        def remove(tokens: tuple[Token, ...]) -> tuple[Token, ...]:
            remaining = tuple(token for token in tokens if token.name != name)
            if len(remaining) == len(tokens):
                raise TokenError(
                    f"Not revoked: {name} is not in the file of tokens. Restart webviz "
                    "without it in the environment."
                )
            return remaining

        token_file.modify(self._access.path, remove)
        self._access.refresh()

    def _make(self, name: str, role: Role, days: float | None) -> Token:
        if not self._access.asks or self._access.path is None:
            raise TokenError(NOT_ASKED)
        created = make(name, role, datetime.now(UTC), days)

        def add(tokens: tuple[Token, ...]) -> tuple[Token, ...]:
            if any(token.name == created.name for token in tokens):
                raise TokenError(
                    f"There is a link for {created.name} already. Choose another name."
                )
            return (*tokens, created)

        token_file.modify(self._access.path, add)
        self._access.refresh()  # the link works at once
        return created


def _link(token: Token) -> ValidLink:
    expires_s = None if token.expires is None else token.expires.timestamp()
    return ValidLink(token.role, expires_s)
