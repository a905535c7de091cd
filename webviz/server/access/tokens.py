"""Tokens: secrets that make their bearer a watcher, an operator or an owner."""

from __future__ import annotations

import hashlib
import hmac
import re
import secrets
from datetime import datetime, timedelta
from typing import Annotated, Literal, cast

import msgspec

from webviz.api.errors import Error
from webviz.api.roles import Role

SECRET_BYTES = 24
"""192 bits, which make 32 characters of a link."""
MIN_CHARACTERS, MAX_CHARACTERS = 22, 200
"""Length of a secret that was not made here; 22 of 64 different characters hold 128 bits."""
MAX_TOKENS = 100
MAX_NAME = 40
SECRET = re.compile(rf"[A-Za-z0-9_-]{{{MIN_CHARACTERS},{MAX_CHARACTERS}}}")
NAME = rf"^[\w.@+-](?:[\w .@+-]{{0,{MAX_NAME - 2}}}[\w.@+-])?\Z"
"""Letters, digits and some signs; no control characters, since logs show it."""

RoleName = Literal["watcher", "operator", "owner"]

_PURPOSE = b"webviz cookie"


class TokenError(Error):
    """Tokens cannot be read, written or made; the message says why."""


class Token(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A secret and what it is for.

    Args:
        name: of the person or group that has it.
        role: that it gives.
        secret: part of the link.
        made: when it was made.
        expires: from when on it is not valid any more, None for never.
    """

    name: Annotated[str, msgspec.Meta(pattern=NAME)]
    role: RoleName
    secret: Annotated[str, msgspec.Meta(pattern=rf"^{SECRET.pattern}\Z")]
    made: Annotated[datetime, msgspec.Meta(tz=True)]
    expires: Annotated[datetime, msgspec.Meta(tz=True)] | None = None

    def __repr__(self) -> str:
        return f"<token {self.name} of {Role[self.role.upper()].phrase}>"

    @property
    def cookie(self) -> str:
        """The value of the cookie of browsers with this token, from which it cannot be derived."""
        return hmac.new(self.secret.encode(), _PURPOSE, hashlib.sha256).hexdigest()

    def is_valid(self, now: datetime) -> bool:
        """Return whether it has not expired."""
        return self.expires is None or now < self.expires


def make(name: str, role: Role, now: datetime, days: float | None = None) -> Token:
    """Return a new token with a random secret.

    Args:
        name: of the person or group that gets it.
        role: that it gives.
        now: the time.
        days: until it expires, None for never.

    Raises:
        TokenError: the name or the time is not allowed.
    """
    if not re.match(NAME, name) or name.startswith("-"):  # for commands, an option
        raise TokenError(
            f"{name!r} is not a valid name. Use 1 to {MAX_NAME} letters, digits, spaces and "
            ". @ + - _, beginning with neither - nor a space."
        )
    try:
        expires = None if days is None else now + timedelta(days=days)
    except (OverflowError, ValueError):
        expires = now
    if expires is not None and expires <= now:
        raise TokenError(f"{days:g} is not a valid number of days. Use one above 0, such as 7.")
    return Token(name, role_name(role), secrets.token_urlsafe(SECRET_BYTES), now, expires)


def role_name(role: Role) -> RoleName:
    """Return the role as tokens have it."""
    return cast(RoleName, role.label)


def role_of(token: Token) -> Role:
    """Return the role that a token gives."""
    return Role[token.role.upper()]


class TokenIndex:
    """Finds tokens by what browsers send; the time it takes says nothing about the tokens.

    Args:
        tokens: to find.
    """

    def __init__(self, tokens: tuple[Token, ...]) -> None:
        self.tokens = tokens
        self._by_secret = {_digest(token.secret): token for token in tokens}
        self._by_cookie = {_digest(token.cookie): token for token in tokens}

    def by_secret(self, secret: str) -> Token | None:
        """Return the token with a secret."""
        return self._by_secret.get(_digest(secret))

    def by_cookie(self, cookie: str) -> Token | None:
        """Return the token with a cookie."""
        return self._by_cookie.get(_digest(cookie))


def _digest(text: str) -> bytes:
    return hashlib.sha256(text.encode(errors="replace")).digest()
