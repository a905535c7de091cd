"""The JavaScript that browsers are sent: modules as they are, and the call that loads them."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from importlib import resources
from typing import Any

PREFIX = "/webviz/"
"""Where modules are, below the page."""
CHANNEL = f"{PREFIX}channel"
"""Where the websocket of the channel is."""
CONTENT_TYPE = "text/javascript; charset=utf-8"

_FILES = {
    file.name: file.read_bytes()
    for file in resources.files("webviz.edges.page").iterdir()
    if file.name.endswith(".js")
}
_BOOTSTRAP = _FILES.pop("bootstrap.js").decode()
_VERSION = hashlib.sha256(repr(sorted(_FILES.items())).encode()).hexdigest()[:16]


def module(path: str) -> bytes | None:
    """The module that a request asks for by its path, or None if there is none."""
    return _FILES.get(path.removeprefix(PREFIX)) if path.startswith(PREFIX) else None


def bootstrap(browser: int, key: str, constants: Mapping[str, Any]) -> str:
    """A script that makes viser's page load the modules, or connect those that it has.

    Args:
        browser: viser's id of the page.
        key: for the channel.
        constants: what Python and the modules share.
    """
    told = {"browser": browser, "key": key, "version": _VERSION, "constants": dict(constants)}
    return f"({_BOOTSTRAP})({json.dumps(told)});"
