"""What browsers are sent: JavaScript modules and style sheets as they are, and what loads them."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from importlib import resources
from pathlib import Path, PurePath
from typing import Any

PREFIX = "/webviz/"
"""Where modules are, below the page."""
CHANNEL = f"{PREFIX}channel"
"""Where the websocket of the channel is."""
CONTENT_TYPES = {".js": "text/javascript; charset=utf-8", ".css": "text/css; charset=utf-8"}

_FOLDER = Path(str(resources.files("webviz.edges.page"))) / "web"
_HEAD = (_FOLDER / "head.html").read_bytes()
_OWN = b"(async()=>{  const d=document.currentScript.dataset;"
"""How the script of viser begins, which unpacks the rest of it."""


class Modules:
    """The modules of a page.

    Args:
        constants: what Python and the modules share; `constants.js` for the latter.
    """

    def __init__(self, constants: Mapping[str, Any]) -> None:
        self._files = {
            str(file.relative_to(_FOLDER)): file.read_bytes()
            for file in _FOLDER.rglob("*")
            if file.suffix in CONTENT_TYPES
        }
        content = repr((constants, sorted(self._files.items()))).encode()
        self._version = hashlib.sha256(content).hexdigest()[:16]
        shared = json.dumps({**constants, "VERSION": self._version})
        self._files["constants.js"] = f"export default {shared};\n".encode()

    def get(self, path: str) -> tuple[bytes, str] | None:
        """The file that a request asks for by its path, with its content type, if there is one."""
        name = path.removeprefix(PREFIX) if path.startswith(PREFIX) else ""
        content = self._files.get(name)
        return None if content is None else (content, CONTENT_TYPES[PurePath(name).suffix])

    def added_to(self, page: bytes) -> bytes:
        """viser's page with the modules, which run before its own script.

        Raises:
            ValueError: it is not an HTML page with a head and the script of viser.
        """
        start, head, rest = page.partition(b"<head>")
        before, own, after = rest.partition(_OWN)
        if not (head and own):
            raise ValueError("The page of viser has no <head>, or another script than expected.")
        return start + head + _HEAD + before + own + b"await window.webvizModules;" + after

    def connect(self, browser: int, key: str) -> str:
        """A script that makes a page open the channel.

        Args:
            browser: viser's id of the page.
            key: for the channel.
        """
        told = json.dumps({"browser": browser, "key": key, "version": self._version})
        return f"window.webviz?.connect({told});"

    def answer(self, token: str) -> str:
        """A script that makes a page send an `Answer` with this token."""
        return f"window.webviz?.answer({json.dumps(token)});"
