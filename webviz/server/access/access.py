"""The decision on who may connect, and in which role."""

from __future__ import annotations

import copy
import logging
import math
import os
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path

import msgspec

from webviz.api.roles import Role
from webviz.data.disk import DiskThreads
from webviz.server.access import token_file
from webviz.server.access.token_file import Tokens
from webviz.server.access.tokens import Token, TokenIndex, make, role_of

log = logging.getLogger("webviz")

CHECK_S = 1.0
"""Pause in seconds between two looks at the tokens: a revoked one counts so much longer at most."""
MAX_MISSED = 5
"""Looks in a row that the file does not respond to, upon which the log says so."""


class Grant(msgspec.Struct, frozen=True):
    """Rights of a connection.

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
"""Grant in effect if no tokens are required."""


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
        self._everybody = EVERYBODY
        # For the browser of this program that takes pictures; never written, gone with it.
        self._own = make("webviz", Role.WATCHER, now())
        self._others = (*others, self._own)
        self._disk = DiskThreads(1)
        self._missed = 0
        # One object, as threads replace it.
        self._file = _stamp(path), self._index(token_file.read(path) if asks and path else ())

    def limited(self, role: Role) -> Access:
        """Return the same for a server with a highest role."""
        limited = copy.copy(self)
        limited._everybody, limited._disk = Grant(role), DiskThreads(1)
        return limited

    @property
    def tokens(self) -> Tokens:
        """All valid tokens, except that of this program."""
        now, tokens = self._now(), self._file[1].tokens
        return tuple(token for token in tokens if token is not self._own and token.is_valid(now))

    @property
    def own(self) -> Token:
        """The token of this program's own browser, a watcher."""
        return self._own

    def by_secret(self, secret: str, role: Role) -> Grant | None:
        """Return the grant of a link, None if it is not valid."""
        token = self._file[1].by_secret(secret)
        return None if token is None or role_of(token) is not role else self._grant(token)

    def by_cookie(self, cookie: str) -> Grant | None:
        """Return the grant of a cookie, None if it is not valid."""
        if not self.asks:
            return self._everybody
        token = self._file[1].by_cookie(cookie)
        return None if token is None else self._grant(token)

    def holds(self, grant: Grant) -> bool:
        """Return whether a grant is still valid: its token is neither revoked nor expired."""
        return not self.asks or self.by_cookie(grant.cookie) == grant

    def seconds_left(self, grant: Grant) -> float:
        """Return the seconds until a grant ends; infinite if it does not."""
        return math.inf if grant.expires is None else (grant.expires - self._now()).total_seconds()

    def refresh(self) -> None:
        """Read the file again if it was changed; if it cannot be read, its tokens do not count."""
        if not self.asks or self.path is None or (stamp := _stamp(self.path)) == self._file[0]:
            return
        try:
            tokens = token_file.read(self.path)
        except Exception as error:  # whatever the cause, all rights end
            tokens = ()
            log.error("No token of the file is valid: %s", error)
        self._file = stamp, self._index(tokens)

    def begin_refresh(self, then: Callable[[], object]) -> None:
        """Read the file again in a thread, unless one still waits for the disk.

        Args:
            then: called from that thread once the file was read.
        """
        try:
            reading = self._disk.start(self.refresh)
        except OSError:
            self._missed += 1
            if self._missed == MAX_MISSED:
                log.warning(
                    "Revoked tokens stay valid: the disk of %s does not respond.", self.path
                )
        else:
            self._missed = 0
            reading.add_done_callback(lambda _: then())

    def _index(self, tokens: Tokens) -> TokenIndex:
        return TokenIndex((*tokens, *self._others))

    def _grant(self, token: Token) -> Grant | None:
        if not token.is_valid(self._now()):
            return None
        role = min(role_of(token), self._everybody.role)
        return Grant(role, token.name, token.cookie, token.expires)


def _stamp(path: Path | None) -> tuple[int, ...]:
    """Return a value that changes whenever a file is written, replaced, or gets another mode."""
    try:
        status = os.stat(path) if path is not None else None
    except OSError:
        status = None
    if status is None:
        return ()
    return status.st_mtime_ns, status.st_ctime_ns, status.st_ino, status.st_size
