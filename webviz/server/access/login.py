"""Sender of an HTTP request: by the cookie of the browser, or by a link with a token."""

from __future__ import annotations

import http
from collections.abc import Iterator
from urllib.parse import parse_qsl, urlencode

import msgspec
from websockets.datastructures import Headers

from webviz.server.access.access import Access, Grant
from webviz.server.access.roles import LINKS

MAX_FIELDS = 20
"""Parameters of an address; viser's page has two."""
MAX_COOKIES = 50
MAX_AGE_S = 30 * 24 * 3600
"""Time in seconds for which a browser remembers a token that does not expire earlier."""

NO_LINK = (
    "This viewer requires a link. Ask its owner for one, or run `webviz token make` on the machine "
    "that runs webviz."
)
INVALID_LINK = (
    "This link is not valid: it was revoked, has expired, or is incomplete. Ask the owner of this "
    "viewer for another one."
)

NO_COOKIES = (
    "This browser blocks the cookies of this viewer. Allow them, or open the link in another "
    "browser."
)
AGAIN = "again"
"""Parameter of a link, and part of a cookie, when this site sends its browser to it again."""
AGAIN_S = 60


class NoCookies(Exception):
    """A browser keeps no cookies, without which no link lets in."""


class Welcome(msgspec.Struct, frozen=True):
    """The response to a valid link.

    Args:
        status: of the response.
        headers: of the response.
    """

    status: http.HTTPStatus
    headers: dict[str, str]


def cookie_name(port: int) -> str:
    """Return the name of the cookie, which all ports of a host share."""
    return f"webviz_{port}"


def grant_of(access: Access, headers: Headers, port: int) -> Grant | None:
    """Return the grant of a request by its cookie, None for nothing."""
    if not access.asks:
        return access.by_cookie("")
    grants = (access.by_cookie(value) for value in _cookies(headers, cookie_name(port)))
    return max(filter(None, grants), key=lambda grant: grant.role, default=None)


def token_in(path: str) -> bool:
    """Return whether the address of a request carries a token, valid or not."""
    return any(name in LINKS for name, _ in _fields(path) or ())


def welcome(
    access: Access, path: str, headers: Headers, port: int, is_secure: bool
) -> Welcome | None:
    """Return the response to a link with a token: a cookie, and the address without it.

    A link of a lower role replaces the cookie of a higher one only if its user has entered it, or
    any page could take an owner's rights away. Browsers keep cookies back from requests that
    another site began; therefore such a request is first sent again by this site.

    Args:
        access: knows the tokens.
        path: of the request, with its parameters.
        headers: of the request.
        port: of the server.
        is_secure: whether browsers reach the server by TLS.

    Returns:
        None if the link is not valid.

    Raises:
        NoCookies: the browser keeps none.
    """
    fields = _fields(path) or []
    secrets = [(LINKS[name], value) for name, value in fields if name in LINKS]
    if len(secrets) != 1 or (grant := access.by_secret(secrets[0][1], secrets[0][0])) is None:
        return None
    site = headers.get("Sec-Fetch-Site")  # by https and on loopback only
    before = grant_of(access, headers, port)
    again = f"{cookie_name(port)}_{AGAIN}"
    is_again = any(_cookies(headers, again))
    if before is None and not is_again and site in (None, "cross-site"):
        if any(name == AGAIN for name, _ in fields):
            raise NoCookies
        cookie = _cookie(again, "1", AGAIN_S, is_secure)
        address = f"./?{urlencode([*fields, (AGAIN, '')])}"
        return Welcome(
            http.HTTPStatus.OK,
            {"Set-Cookie": cookie, "Refresh": f"0; url={address}", "Cache-Control": "no-store"},
        )
    rest = urlencode([(name, value) for name, value in fields if name not in (*LINKS, AGAIN)])
    # Relative, so that it is right behind a proxy; without a path the cookie is that of the folder.
    answer = {"Location": f"./?{rest}" if rest else "./", "Cache-Control": "no-store"}
    if before is None or before.role <= grant.role or site == "none":
        age = min(MAX_AGE_S, access.seconds_left(grant))
        answer["Set-Cookie"] = _cookie(cookie_name(port), grant.cookie, age, is_secure)
    return Welcome(http.HTTPStatus.SEE_OTHER, answer)


def _cookie(name: str, value: str, seconds: float, is_secure: bool) -> str:
    cookie = f"{name}={value}; Max-Age={seconds:.0f}; HttpOnly; SameSite=Strict"
    return f"{cookie}; Secure" if is_secure else cookie


def page(sentence: str) -> bytes:
    """Return a page for people who may not see the viewer."""
    from html import escape  # here, as its entities take 0.5 MB

    text = "".join(
        f"<code>{part}</code>" if number % 2 else part
        for number, part in enumerate(escape(sentence).split("`"))
    )
    return (
        "<!doctype html><html lang=en><meta charset=utf-8><title>webviz</title>"
        "<meta name=viewport content='width=device-width'>"
        "<style>body{font:16px/1.5 system-ui,sans-serif;max-width:32em;margin:20vh auto;"
        "padding:0 1em;background:#1e1e1e;color:#ddd}</style>"
        f"<h1>webviz</h1><p>{text}</p></html>\n"
    ).encode()


def _fields(path: str) -> list[tuple[str, str]] | None:
    """Return the parameters of an address, None if there are too many."""
    try:
        return parse_qsl(path.partition("?")[2], keep_blank_values=True, max_num_fields=MAX_FIELDS)
    except ValueError:
        return None


def _cookies(headers: Headers, name: str) -> Iterator[str]:
    """Yield the values of a cookie, of which other sites of the same host may have set more."""
    pairs = "; ".join(headers.get_all("Cookie")).split(";", MAX_COOKIES)[:MAX_COOKIES]
    for pair in pairs:
        key, _, value = pair.partition("=")
        if key.strip() == name:
            yield value.strip()
