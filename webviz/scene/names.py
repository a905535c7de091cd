"""Names of scene nodes in viser."""

from __future__ import annotations

import functools
from urllib.parse import quote, unquote

ROOT = "/webviz"

TILE_PREFIX = "%tile "
"""Marks the names of images for the page; no escaped key starts with it."""

PART_PREFIX = "%part "
"""Marks the names of the parts of a cloud after the first."""

BLOCK_PREFIX = "%block "
"""Marks those parts of which the page may draw only the first points."""


@functools.lru_cache(maxsize=10_000)
def segment(text: str) -> str:
    """Escapes any text to a unique segment of a node path.

    Characters other than letters, digits and spaces are percent-encoded as in a URL (RFC 3986), so
    that a "/" in a frame id does not start a subtree. Empty text becomes "%", which the encoding
    never produces alone.
    """
    return quote(text, safe=" ", errors="surrogatepass") or "%"


def node_path(group: str, key: str | None = None) -> str:
    """Return the name of a group in viser, or of the node `key` in it."""
    path = f"{ROOT}/{segment(group)}"
    return path if key is None else f"{path}/{segment(key)}"


def display_of(path: str) -> str:
    """Return the id of the display that a node belongs to, by the name of the node in viser."""
    group = unquote(path.removeprefix(f"{ROOT}/").partition("/")[0], errors="surrogatepass")
    return group.partition("/")[0]
