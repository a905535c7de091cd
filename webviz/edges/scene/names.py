"""Names of scene nodes: any text becomes one segment of a viser path."""

from __future__ import annotations

import functools
from urllib.parse import quote

ROOT = "/webviz"

TILE_PREFIX = "%tile "
"""The page recognises pictures by this in their names; no key has it when escaped."""


@functools.lru_cache(maxsize=10_000)
def segment(text: str) -> str:
    """Escapes `text` so that it is one segment of a node path, another one for every other text.

    Letters, digits and spaces stay readable; what remains is percent-encoded as in a URL (RFC
    3986), so that a "/" in a frame id does not open a subtree. Empty text becomes "%", which the
    encoding itself never produces alone.
    """
    return quote(text, safe=" ", errors="surrogatepass") or "%"


def node_path(group: str, key: str | None = None) -> str:
    """The viser name of a group, or of the node `key` in it."""
    path = f"{ROOT}/{segment(group)}"
    return path if key is None else f"{path}/{segment(key)}"
