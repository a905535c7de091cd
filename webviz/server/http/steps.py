"""The steps of a request, in a row: each notes something of it, answers it, or lets it pass."""

from __future__ import annotations

import functools
import gzip
import http
from collections.abc import Callable, Iterable, Sequence
from typing import Protocol

import msgspec
from websockets.http11 import Request, Response

from webviz.server.access import login
from webviz.server.access.access import EVERYBODY, Access, Grant
from webviz.server.access.proxies import Proxies
from webviz.server.channel.modules import CHANNEL, Modules
from webviz.server.channel.packed import MAP
from webviz.server.http.hosts import HostList, origin_refusal
from webviz.server.http.requests import NOT_FOUND, PAGES, is_upgrade
from webviz.server.http.viser_page import with_head

HTML = "text/html; charset=utf-8"
JSON = "application/json"
PACKING = 5
"""Level of gzip: the default takes twice as long for a page that is 1 % smaller."""


class RequestContext(msgspec.Struct):
    """The request that the steps handle, and their findings so far.

    Args:
        request: of the browser.
        fetch: makes viser's response to it, None if viser opens a websocket.
        address: IP address of the other end of the connection, then of the browser.
        is_secure: whether the connection uses TLS, then whether the browser does.
        hosts: by what names the server was addressed.
        host: the one name, if it is allowed, in lower case.
        grant: what the browser may do.
        socket, below: of the server behind this one that answers, and the path there.
    """

    request: Request
    fetch: Callable[[Request], Response | None]
    address: str
    is_secure: bool = False
    hosts: Sequence[str] = ()
    host: str = ""
    grant: Grant = EVERYBODY
    socket: str = ""
    below: str = ""

    @property
    def path(self) -> str:
        """Its path, without parameters."""
        return self.request.path.partition("?")[0]

    @property
    def is_channel(self) -> bool:
        """True if it opens the channel of a page."""
        return is_upgrade(self.request) and self.path == CHANNEL


class Reply(msgspec.Struct, frozen=True):
    """An answer.

    Args:
        status: of HTTP.
        body: a page, or a sentence with its end of line.
        headers: besides those of every response.
    """

    status: http.HTTPStatus
    body: bytes = b""
    headers: dict[str, str] = msgspec.field(default_factory=dict[str, str])


Step = Callable[[RequestContext], Reply | None]


class Room(Protocol):
    """Room for browsers."""

    def absence(self, client: RequestContext, /) -> str:
        """Return why a browser has to stay away for a while: a sentence, or ""."""
        ...

    def refusal(self, client: RequestContext, /) -> str:
        """Return why one more may not connect: a sentence, or ""."""
        ...


def answer_of(steps: Iterable[Step], context: RequestContext) -> Reply | None:
    """Return the answer of the first step that has one.

    None lets viser open a websocket, or the server behind this one answer, if there is one.
    """
    for step in steps:
        if (reply := step(context)) is not None or context.socket:
            return reply
    return None


def behind(proxies: Proxies) -> Step:
    """Note who asks: the browser, if a trusted proxy says which."""

    def step(context: RequestContext) -> None:
        headers = context.request.headers
        caller = proxies.caller(context.address, headers, is_secure=context.is_secure)
        context.address, context.hosts = caller.address, caller.hosts
        context.is_secure = caller.is_secure

    return step


def at(hosts: HostList) -> Step:
    """Refuse other names than those of the server, and pages of other sites."""

    def step(context: RequestContext) -> Reply | None:
        origins = context.request.headers.get_all("Origin")
        reason = hosts.refusal(context.hosts) or origin_refusal(context.hosts[0].lower(), origins)
        if reason is not None:
            return _sentence(http.HTTPStatus.FORBIDDEN, reason)
        context.host = context.hosts[0].lower()
        return None

    return step


def with_link(access: Access, port: int) -> Step:
    """Let those in who have a link, or its cookie; a link is exchanged for the cookie.

    Args:
        access: knows the tokens.
        port: of the server, after which the cookie is named.
    """

    def step(context: RequestContext) -> Reply | None:
        path, headers = context.request.path, context.request.headers
        if context.path in PAGES and login.token_in(path) and access.asks:
            try:
                welcome = login.welcome(access, path, headers, port, context.is_secure)
            except login.NoCookies:
                return _turned_away(login.NO_COOKIES)
            if welcome is None:
                return _turned_away(login.INVALID_LINK)
            return Reply(welcome.status, headers=welcome.headers)
        grant = login.grant_of(access, headers, port)
        if grant is None:
            return _turned_away(login.NO_LINK)
        context.grant = grant
        return None

    return step


def within(limits: Room) -> Step:
    """Refuse those that have to stay away, and one browser more than there may be.

    Each browser has a channel besides.
    """

    def step(context: RequestContext) -> Reply | None:
        if reason := limits.absence(context):
            return _sentence(http.HTTPStatus.TOO_MANY_REQUESTS, reason)
        reason = "" if context.is_channel else limits.refusal(context)
        return _sentence(http.HTTPStatus.SERVICE_UNAVAILABLE, reason) if reason else None

    return step


@functools.lru_cache(maxsize=2)
def whole(body: bytes, head: bytes, is_packed: bool) -> bytes:
    """Return viser's page with a head, once for all servers of a process."""
    text = with_head(body, head)
    return gzip.compress(text, PACKING) if is_packed else text


def page(modules: Modules) -> Step:
    """Serve the one file of the page with its modules, packed for browsers that take it so."""

    def step(context: RequestContext) -> Reply | None:
        request = context.request
        if is_upgrade(request):
            return None
        if context.path == MAP and (source_map := modules.source_map):
            return Reply(http.HTTPStatus.OK, source_map, {"Content-Type": JSON})
        if context.path not in PAGES:
            return _sentence(*NOT_FOUND)
        encodings = ", ".join(request.headers.get_all("Accept-Encoding"))
        if encodings:
            del request.headers["Accept-Encoding"]
        if (response := context.fetch(request)) is None:
            return None
        is_packed = "gzip" in encodings
        headers = dict(response.headers.raw_items())
        headers.pop("Content-Encoding", None)
        if is_packed:
            headers["Content-Encoding"] = "gzip"
        body = whole(bytes(response.body), modules.head, is_packed)
        return Reply(http.HTTPStatus(response.status_code), body, {**headers, "Content-Type": HTML})

    return step


def _sentence(status: http.HTTPStatus, text: str) -> Reply:
    return Reply(status, f"{text}\n".encode())


def _turned_away(reason: str) -> Reply:
    headers = {"Content-Type": HTML, "Cache-Control": "no-store"}
    return Reply(http.HTTPStatus.FORBIDDEN, login.page(reason), headers)
