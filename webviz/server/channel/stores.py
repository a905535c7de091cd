"""Keyed values that are kept the same in every page that watches them."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import Any

import msgspec

from webviz.server.channel.messages import Values

MAX_WATCHED = 64
"""Stores that one page may watch."""
MAX_NAME = 400
"""Characters of the name of a store."""

Content = dict[str, msgspec.Raw]


class Stores:
    """Contents of the stores, by name."""

    def __init__(self) -> None:
        self._content: dict[str, Content] = {}
        self._made_of: dict[str, Mapping[str, Any]] = {}

    def replace(self, store: str, values: Mapping[str, Any]) -> list[str]:
        """Make these the values of a store, and return the keys that are new, changed or gone.

        Values are not changed once they are here: the same object is the same value.
        """
        old, made_of = self._content.get(store, {}), self._made_of.get(store, {})
        new: Content = {}
        changed: list[str] = []
        for name, value in values.items():
            key = _sendable(name)
            encoded_before = old.get(key)
            if encoded_before is None or made_of.get(name) is not value:
                encoded = _encoded(value)
                if encoded != encoded_before:
                    changed.append(key)
                encoded_before = encoded
            new[key] = encoded_before
        self._content[store], self._made_of[store] = new, dict(values)
        return changed + [key for key in old if key not in new]

    def get(self, store: str) -> Content | None:
        """Return the content of a store, None if nothing was put there since it is watched."""
        return self._content.get(store)

    def forget(self, watched: set[str]) -> None:
        """Drop the stores that no page watches any more."""
        for store in self._content.keys() - watched:
            del self._content[store], self._made_of[store]


class Watched:
    """The stores that one page watches, and which of their keys it has yet to be sent.

    What waits is keys, not values, so a page that reads slowly skips what came in between.
    """

    def __init__(self) -> None:
        self._dirty: dict[str, dict[str, None]] = {}
        self._fresh: set[str] = set()

    def __iter__(self) -> Iterator[str]:
        return iter(tuple(self._dirty))

    def add(self, store: str) -> bool:
        """Begins to watch; whether that is allowed."""
        if len(store) > MAX_NAME or len(self._dirty) >= MAX_WATCHED:
            return False
        self._dirty[store] = {}
        self._fresh.add(store)
        return True

    def discard(self, store: str) -> None:
        """End it."""
        self._dirty.pop(store, None)
        self._fresh.discard(store)

    def mark(self, store: str, keys: list[str]) -> bool:
        """Note new, changed or gone keys; return whether the page has yet to be sent any."""
        if (dirty := self._dirty.get(store)) is None:
            return False
        dirty.update(dict.fromkeys(keys))
        return bool(dirty) or store in self._fresh

    def next(self, stores: Stores) -> Values | None:
        """Return the next changes to send, if any."""
        for store, dirty in self._dirty.items():
            content = stores.get(store)
            if content is None:
                continue
            if store in self._fresh:
                self._fresh.discard(store)
                dirty.clear()
                return Values(store, True, dict(content), ())
            if dirty:
                present = {key: content[key] for key in dirty if key in content}
                removed = tuple(key for key in dirty if key not in content)
                dirty.clear()
                return Values(store, False, present, removed)
        return None


def _encoded(value: Any) -> msgspec.Raw:
    try:
        return msgspec.Raw(msgspec.json.encode(value))
    except (UnicodeEncodeError, OverflowError):  # half of a surrogate pair, more than 64 bits
        return msgspec.Raw(json.dumps(msgspec.to_builtins(value)).encode())


def _sendable(key: str) -> str:
    return key if key.isascii() else key.encode(errors="replace").decode()
