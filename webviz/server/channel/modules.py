"""Page for browsers: viser's, with our JavaScript modules and style sheets added.

They are in the one file of the page: to load more than a hundred small files takes longer than all
the rest of the page, above all over a slow network. A release has them packed, see `packed.py`.
"""

from __future__ import annotations

import functools
import hashlib
import json
from collections.abc import Iterable, Mapping
from importlib import resources
from pathlib import Path
from typing import Any

from webviz.engine.feature import features, texts_of
from webviz.server.channel.packed import pack_of

CHANNEL = "/webviz/channel"
"""Path of the channel's websocket, below the page."""

_FOLDER = Path(str(resources.files("webviz.page"))) / "web"
PACK = _FOLDER.parent / "packed.json"
"""The pack of a release; a checkout has none."""
_MODULES = "$MODULES"
"""Stands in `head.html` for all modules, as JSON."""


class Modules:
    """The modules of a page, read for the first one that asks for them.

    Args:
        constants: what Python and the modules share; `constants.js` for the latter.
        pack: file with the modules packed, if there is one.
    """

    def __init__(self, constants: Mapping[str, Any], pack: Path | None = None) -> None:
        self._content = json.dumps(constants), pack or PACK

    @property
    def head(self) -> bytes:
        """Head of the page with the modules, besides viser's."""
        return _built(*self._content)[1]

    @property
    def source_map(self) -> bytes:
        """Source map of packed modules, which developer tools read; empty for others."""
        return _built(*self._content)[2]

    def connect(self, browser: int, key: str) -> str:
        """Return a script that makes a page open the channel.

        Args:
            browser: viser's id of the page.
            key: for the channel.
        """
        version = _built(*self._content)[0]
        facts = json.dumps({"browser": browser, "key": key, "version": version})
        return f"window.webviz?.connect({facts});"

    def answer(self, token: str) -> str:
        """Return a script that makes a page send a `SyncReply` with this token."""
        return f"window.webviz?.answer({json.dumps(token)});"

    def probe(self, number: int) -> str:
        """Return a script that makes a page send a `HasPainted` with this number."""
        return f"window.webviz?.probe({json.dumps(number)});"


@functools.cache
def _built(constants: str, file: Path) -> tuple[str, bytes, bytes]:
    """Return version and head of a page with these constants, as JSON, and its source map."""
    files = page_files()
    content = repr((constants, sorted(files.items()))).encode()
    version = hashlib.sha256(content).hexdigest()[:16]
    shared = json.dumps({**json.loads(constants), "VERSION": version})
    sources = {name: text for name, text in files.items() if name.endswith(".js")}
    pack = pack_of(sources, file)
    modules = pack.modules(sources) if pack else sources
    modules["constants.js"] = f"export default {shared};\n"
    head = files["head.html"] + "".join(_style(files[name]) for name in styles(files))
    # Nothing in a module may end the element that it is in.
    head = head.replace(_MODULES, json.dumps(modules).replace("<", r"\u003c"))
    return version, head.encode(), pack.source_map(sources) if pack else b""


def page_files() -> dict[str, str]:
    """Return the modules, style sheets and head of the page and of features, by their names."""
    files = {
        file.relative_to(_FOLDER).as_posix(): file.read_text("utf-8")
        for file in _FOLDER.rglob("*")
        if file.suffix in (".js", ".css", ".html")
    }
    for name, feature in features().items():
        files |= {f"features/{name}/{file}": text for file, text in texts_of(feature).items()}
    return files


def styles(names: Iterable[str]) -> list[str]:
    """Return the style sheets among the files of a page, in the order in which they hold.

    What concerns several folders comes first, and features come last.
    """
    sheets = [name for name in names if name.endswith(".css")]
    return sorted(sheets, key=lambda name: (name.startswith("features/"), "/" in name, name))


def _style(rules: str) -> str:
    return f"<style>\n{rules}</style>"
