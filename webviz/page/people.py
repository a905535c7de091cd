"""Who is connected and what they did; and how the owner invites others."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future
from datetime import UTC, datetime
from typing import ClassVar, TypeVar

import msgspec

from webviz.api.errors import Error
from webviz.api.roles import Role
from webviz.data.disk import DiskThreads
from webviz.engine.parts.declaring import store
from webviz.engine.state import State
from webviz.engine.store import PageStore
from webviz.page.asked import Asked
from webviz.server.access import token_file
from webviz.server.access.access import Access
from webviz.server.access.journal import Journal
from webviz.server.access.requests import Dismiss, Invite, Revoke
from webviz.server.access.starting import link
from webviz.server.access.tokens import Token, TokenError, make
from webviz.server.channel.channel import Channel
from webviz.server.channel.messages import Dismissed

NOT_ASKED = (
    "Not made: this viewer requires no tokens. Start webviz with --token, or with --host for "
    "other machines."
)
OWN_LINK = "Not done: this is your own link. Make another with `webviz token rotate`."

MAX_THREADS = 4
"""That change the file of tokens, or wait for it."""

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


class JournalLine(msgspec.Struct, frozen=True):
    """Something that was done, see `webviz.server.access.journal.JournalEntry`."""

    time_s: float
    name: str
    role: str
    address: str
    text: str


class JournalStore(PageStore, frozen=True):
    """People's actions, newest first."""

    entries: Sequence[JournalLine]


class People:
    """Stores about people, and invitations.

    Args:
        channel: to the pages.
        journal: what people did.
        access: knows the tokens.
    """

    def __init__(self, channel: Channel, journal: Journal, access: Access) -> None:
        self._channel = channel
        self._journal = journal
        self._access = access
        self._dismissing: set[asyncio.Task[None]] = set()
        self._disk = DiskThreads(MAX_THREADS)
        self._state = State()

    def update(self, state: State) -> None:
        """Note who drives what."""
        self._state = state

    @store()
    def people(self, argument: str) -> PeopleStore:
        """Return the connected browsers."""
        state = self._state
        names = {button.id: button.name for button in state.more.get("tools", ())}
        driving = {tool: driving.driver for tool, driving in state.more.get("driving", {}).items()}
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

    @store()
    def addresses(self, argument: str) -> AddressesStore:
        """Return the network addresses of browsers."""
        visitors = self._channel.visitors()
        return AddressesStore({str(id_): visitor.address for id_, visitor in visitors.items()})

    @store()
    def links(self, argument: str) -> LinksStore:
        """Return the valid links."""
        return LinksStore({token.name: _link(token) for token in self._access.tokens})

    @store()
    def journal(self, argument: str) -> JournalStore:
        """Return people's actions."""
        return JournalStore(
            [
                JournalLine(each.time_s, each.name, each.role, each.address, each.text)
                for each in self._journal.entries
            ]
        )

    # Called on the event loop

    def invite(self, asked: Asked, invite: Invite) -> None:
        """Make a link for somebody else."""

        def answer(done: Future[Token]) -> None:
            try:
                address = link(invite.url, done.result())
            except Error as error:
                asked.refuse(str(error))
                return
            import segno  # here, as it would slow down the start

            code = segno.make(address, micro=False).svg_data_uri(scale=5, border=4, light="#fff")
            text = f"Invited {invite.name} as {Role[invite.role.upper()].phrase}."
            asked.answer(text, link=address, code=code)

        self._begin(lambda: self._make(invite)).add_done_callback(answer)

    def dismiss(self, asked: Asked, dismiss: Dismiss) -> None:
        """End the visit of somebody else."""
        visitor = self._channel.visitors().get(dismiss.visitor)
        grant = self._channel.grant_of(dismiss.visitor)
        if visitor is None or grant is None:
            asked.refuse("This visitor has already left.")
        elif dismiss.visitor == asked.browser:
            asked.refuse("Not done: this is your own page. Close it.")
        elif dismiss.revokes:
            self.revoke(asked, Revoke(grant.name))
        else:
            text = (
                "The owner has ended your visit. Open the address of the viewer again to come back."
            )
            self._channel.send(Dismissed(text), dismiss.visitor)
            task = asyncio.get_running_loop().create_task(self._channel.dismiss(dismiss.visitor))
            self._dismissing.add(task)
            task.add_done_callback(self._dismissing.discard)
            asked.answer(f"Ended a visit of {visitor.name or visitor.address}.")

    def revoke(self, asked: Asked, revoke: Revoke) -> None:
        """End a link, and all visits by it."""
        name, own = revoke.name, self._channel.grant_of(asked.browser)
        if name and own is not None and own.name == name:
            asked.refuse(OWN_LINK)
            return

        def answer(done: Future[None]) -> None:
            try:
                done.result()
            except Error as error:
                asked.refuse(str(error))
            else:
                asked.answer(f"Revoked the link of {name}.")

        self._begin(lambda: self._remove(name)).add_done_callback(answer)

    def _begin(self, work: Callable[[], T]) -> Future[T]:
        """Work on the file of tokens in a thread; it fails if too much does already."""
        try:
            return self._disk.start(work)
        except OSError:
            refused: Future[T] = Future()
            refused.set_exception(TokenError("Not done: too many at once. Try again later."))
            return refused

    def _remove(self, name: str) -> None:
        """Remove a token from the file; its pages are closed soon."""
        if not self._access.asks or self._access.path is None:
            raise TokenError("Not revoked: this viewer requires no tokens.")

        def remove(tokens: tuple[Token, ...]) -> tuple[Token, ...]:
            kept = tuple(token for token in tokens if token.name != name)
            if len(kept) == len(tokens):
                raise TokenError(
                    f"Not revoked: {name} is not in the file of tokens. Restart webviz "
                    "without it in the environment."
                )
            return kept

        token_file.modify(self._access.path, remove)
        self._access.refresh()

    def _make(self, invite: Invite) -> Token:
        if not self._access.asks or self._access.path is None:
            raise TokenError(NOT_ASKED)
        role = Role[invite.role.upper()]
        made = make(invite.name, role, datetime.now(UTC), invite.days)

        def add(tokens: tuple[Token, ...]) -> tuple[Token, ...]:
            if any(token.name == made.name for token in tokens):
                raise TokenError(f"There is a link for {made.name} already. Choose another name.")
            return (*tokens, made)

        token_file.modify(self._access.path, add)
        self._access.refresh()  # the link works at once
        return made


def _link(token: Token) -> ValidLink:
    expires_s = None if token.expires is None else token.expires.timestamp()
    return ValidLink(token.role, expires_s)
