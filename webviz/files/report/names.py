"""Names of people and machines, which bug reports leave out unless they are asked for."""

from __future__ import annotations

import getpass
import re
import socket
from collections.abc import Iterable
from pathlib import Path

FILLER = "x"
"""Takes the place of each character, so that serialised texts keep their length."""
COMMON = frozenset({"admin", "localhost", "pi", "robot", "root", "ros", "ubuntu", "user"})
"""Names that say nothing about anyone, and are ordinary words elsewhere."""
MIN_BYTES = 5
"""Shortest name that is replaced in messages, since a shorter one may be a number by chance."""
HOMES = re.compile(rb"/(?:home|Users)/[A-Za-z0-9._-]+")
"""Home folders of anyone."""


class PrivateNames:
    """Replaces names of hosts, users and home folders.

    Names of topics and frames stay, since the report would not show the same without them, and a
    repaired recording would not fit its test. A name that is a part of a topic between slashes,
    such as a namespace, stays everywhere; `turtle7` in a frame `turtle7_camera` only there.

    Args:
        public: names of topics and frames.
        words: names of hosts and users; None for those of this machine.
        home: the home folder; None for that of this user.
    """

    def __init__(
        self,
        public: Iterable[str],
        words: Iterable[str] | None = None,
        home: str | None = None,
    ) -> None:
        self._public = tuple(public)
        names = dict.fromkeys(_own_words() if words is None else words)
        hidable = [word for word in names if len(word) > 1 and word.lower() not in COMMON]
        parts = {part for name in self._public for part in name.split("/")}
        hidden = [word for word in hidable if word not in parts]
        found_in = [part for part in parts if any(_has(part, word) for word in hidden)]
        self.remaining_names = (*(word for word in hidable if word in parts), *sorted(found_in))
        """Names, and names of frames and parts of topics with names in them, that stay."""
        self._whole = frozenset(part.encode() for part in found_in)
        home = str(Path.home()) if home is None else home
        is_special = len(home) > 1 and not HOMES.fullmatch(home.encode())
        self._home = _pattern([home], ()) if is_special else None
        self._in_texts = _pattern(hidden, found_in)
        long = [word for word in hidden if len(word) >= MIN_BYTES]
        self._in_messages = _pattern(long, found_in)

    def text(self, text: str) -> str:
        """Return a text without the names."""
        data = text.encode("utf-8", "surrogateescape")
        return self._without(data, self._in_texts).decode("utf-8", "surrogateescape")

    def message(self, data: bytes) -> bytes:
        """Return a serialised message without the names, of the same length."""
        return self._without(data, self._in_messages)

    def _without(self, data: bytes, words: re.Pattern[bytes] | None) -> bytes:
        if b"/home/" in data or b"/Users/" in data:
            data = HOMES.sub(self._filled_home, data)
        for pattern in (self._home, words):
            data = pattern.sub(self._filled, data) if pattern is not None else data
        return data

    def _filled(self, match: re.Match[bytes]) -> bytes:
        return match[0] if match[0] in self._whole else re.sub(rb"[^/]", FILLER.encode(), match[0])

    def _filled_home(self, match: re.Match[bytes]) -> bytes:
        path = match[0].decode("ascii")
        if any(name == path or name.startswith(f"{path}/") for name in self._public):
            return match[0]  # a topic
        folder, _, name = path.rpartition("/")
        return f"{folder}/{FILLER * len(name)}".encode()


def _own_words() -> list[str]:
    """Names of this host and this user."""
    host = socket.gethostname()
    try:
        user = getpass.getuser()
    except (OSError, KeyError):  # a container without an entry for the user
        user = ""
    return [host, host.partition(".")[0], user]


def _pattern(words: Iterable[str], whole: Iterable[str]) -> re.Pattern[bytes] | None:
    """Return the words where they stand alone, in any case, the longest first; None without any.

    Args:
        words: to find.
        whole: longer words, which are found as they are instead of the words in them.
    """
    parts = _alternatives(words)
    if not parts:
        return None
    exempt = b"".join(b"%s|" % part for part in _alternatives(whole))
    alone = rb"(?<![A-Za-z0-9])(?:%s(?i:%s))(?![A-Za-z0-9])"
    return re.compile(alone % (exempt, b"|".join(parts)))


def _alternatives(words: Iterable[str]) -> list[bytes]:
    return [re.escape(word.encode()) for word in sorted(words, key=len, reverse=True)]


def _has(text: str, word: str) -> bool:
    """Return whether a word stands alone in a text."""
    pattern = _pattern([word], ())
    return pattern is not None and pattern.search(text.encode()) is not None
