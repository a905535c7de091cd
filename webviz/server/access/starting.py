"""Tokens a viewer requires, as decided by how it is started."""

from __future__ import annotations

import ipaddress
import os
import socket
from collections.abc import MutableMapping
from datetime import UTC, datetime
from pathlib import Path

from webviz.api.roles import Role
from webviz.server.access import token_file
from webviz.server.access.access import Access
from webviz.server.access.roles import LINKS
from webviz.server.access.tokens import Token, TokenError, make, role_of

NAMES = {Role.WATCHER: "watcher", Role.OPERATOR: "operator", Role.OWNER: "owner"}
"""Names of the tokens that are made if there are none."""


def is_local(host: str) -> bool:
    """Return whether only programs of this machine reach an address."""
    try:
        addresses = socket.getaddrinfo(host or "0.0.0.0", None, flags=socket.AI_PASSIVE)
        return all(ipaddress.ip_address(entry[4][0]).is_loopback for entry in addresses)
    except (OSError, ValueError):
        return False


def access_to(
    host: str,
    asks: bool = False,
    path: Path | None = None,
    environment: MutableMapping[str, str] = os.environ,
) -> Access:
    """Return the access rules: none on this machine only, unless told to; else tokens.

    Args:
        host: address to listen on.
        asks: whether to ask for tokens in any case.
        path: of the file with tokens, None for that of this user.
        environment: with tokens, which are removed.

    Raises:
        TokenError: tokens cannot be read.
    """
    others = token_file.take_from(environment)
    if not (asks or others or not is_local(host)):
        return Access()
    return Access(True, path or token_file.standard_path(), others)


def make_missing(access: Access) -> None:
    """Make one token of each role if there is none at all.

    Raises:
        TokenError: the file cannot be written, or all of its tokens have expired.
    """
    if not access.asks or access.path is None or access.tokens:
        return
    token_file.modify(access.path, lambda tokens: tokens or _first())
    access.refresh()
    if not access.tokens:
        raise TokenError(f"Every token of {access.path} has expired. Run `webviz token make`.")


def link(url: str, token: Token) -> str:
    """Return the link with a token.

    Args:
        url: of the page, such as http://robot.local:8080.
        token: to put in.
    """
    (parameter,) = (name for name, role in LINKS.items() if role is role_of(token))
    return f"{url.rstrip('/')}/?{parameter}={token.secret}"


def _first() -> tuple[Token, ...]:
    now = datetime.now(UTC)
    return tuple(make(name, role, now) for role, name in NAMES.items())
