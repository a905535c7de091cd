"""Decides who may connect, and as what."""

from __future__ import annotations

import logging
import math
import os
from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from webviz.edges.access import token_file
from webviz.edges.access.roles import Role
from webviz.edges.access.token_file import Tokens
from webviz.edges.access.tokens import (
    Token,
    TokenError,
    by_cookie,
    by_secret,
    make,
    role_of,
)

log = logging.getLogger("webviz")

CHECK_S = 1.0
"""Between two looks at the tokens: a revoked one counts so much longer at most."""


@dataclass(frozen=True)
class Grant:
    """What somebody may do.

    Args:
        role: what they may do.
        name: of their token, "" if none is asked for.
        cookie: of their browser, "" if none is asked for.
        expires: when it ends, None for never.
    """

    role: Role
    name: str = ""
    cookie: str = ""
    expires: datetime | None = None


EVERYBODY = Grant(Role.OWNER)
"""What holds if no tokens are asked for."""


def _now() -> datetime:
    return datetime.now(UTC)


class Access:
    """Knows the tokens of a viewer. Without tokens, everybody is an owner.

    It may be asked from any thread.

    Args:
        asks: whether tokens are asked for.
        path: of the file with tokens, None for none.
        others: tokens from elsewhere, such as the environment.
        now: the time.

    Raises:
        TokenError: the file cannot be read.
    """

    def __init__(
        self,
        asks: bool = False,
        path: Path | None = None,
        others: Tokens = (),
        now: Callable[[], datetime] = _now,
    ) -> None:
        self.asks = asks
        self.path = path
        self._now = now
        # For the browser of this program that takes pictures; never written, gone with it.
        self._own = make("webviz", Role.WATCHER, now())
        self._others = (*others, self._own)
        self._stamp = _stamp(path)
        self._tokens: Tokens = ()
        if asks and path is not None:
            self._tokens = token_file.read(path)

    @property
    def tokens(self) -> Tokens:
        """All valid tokens, except that of this program."""
        return tuple(token for token in self._valid() if token is not self._own)

    @property
    def own(self) -> Token:
        """The token of this program's own browser, a watcher."""
        return self._own

    def by_secret(self, secret: str, role: Role) -> Grant | None:
        """What a link gives, None if it is not valid."""
        token = by_secret(self._valid(), secret)
        return None if token is None or role_of(token) is not role else _grant(token)

    def by_cookie(self, cookie: str) -> Grant | None:
        """What a cookie gives, None if it is not valid."""
        if not self.asks:
            return EVERYBODY
        token = by_cookie(self._valid(), cookie)
        return None if token is None else _grant(token)

    def holds(self, grant: Grant) -> bool:
        """Whether a grant is still valid: its token was neither revoked, nor did it expire."""
        return not self.asks or self.by_cookie(grant.cookie) == grant

    def seconds_left(self, grant: Grant) -> float:
        """Until a grant ends; infinite if it does not."""
        return math.inf if grant.expires is None else (grant.expires - self._now()).total_seconds()

    def refresh(self) -> None:
        """Read the file again if it was changed; if it cannot be read, its tokens do not count."""
        if not self.asks or self.path is None or (stamp := _stamp(self.path)) == self._stamp:
            return
        self._stamp = stamp
        try:
            self._tokens = token_file.read(self.path)
        except TokenError as error:
            self._tokens = ()
            log.error("No token of the file is valid: %s", error)

    def _valid(self) -> Tokens:
        now = self._now()
        return tuple(token for token in (*self._tokens, *self._others) if token.is_valid(now))


def _grant(token: Token) -> Grant:
    return Grant(role_of(token), token.name, token.cookie, token.expires)


def _stamp(path: Path | None) -> tuple[int, ...]:
    """What changes whenever a file is written, replaced, or gets another mode."""
    try:
        status = os.stat(path) if path is not None else None
    except OSError:
        status = None
    if status is None:
        return ()
    return status.st_mtime_ns, status.st_ctime_ns, status.st_ino, status.st_size
