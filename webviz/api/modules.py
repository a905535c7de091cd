"""Modules that plug-ins bring for the page.

    class Lasso(Tool):
        gesture, module = "lasso", "lasso.js"

The file has one function as its default export. Each page calls it once with an object through
which it adds gestures, widgets, overlays and tabs (`webviz/page/web/extensions.js`). It may import
files beside it: `import { hull } from "./hull.js"`. A style sheet beside it comes with it, such as
`lasso.css`.
"""

from __future__ import annotations

import functools
import re
import sys
from collections.abc import Mapping
from pathlib import Path

from webviz.api.declared import Declared

MAX_BYTES = 1_000_000
"""Size of a module with those that it imports; all pages load them."""
_IMPORT = re.compile(r"""^import\b[^"';(]*["']\./([^"'/]+)["']""", re.MULTILINE)


class ModuleError(ValueError):
    """The module of a plug-in cannot be used; part of a sentence."""


@functools.cache
def module_texts(cls: type[Declared]) -> Mapping[str, str]:
    """Return the module of a plug-in, those that it imports, and their style sheets, by file name.

    Each comes after what it needs, so its own is the last. Empty without one.

    Raises:
        ModuleError: one is missing, not UTF-8 or imports itself, or they are too large.
    """
    if not cls.module:
        return {}
    home = next(base for base in cls.__mro__ if "module" in vars(base))
    python = getattr(sys.modules[home.__module__], "__file__", None) or ""
    path = Path(python).with_name(Path(cls.module).name) if python else Path(cls.module)
    texts: dict[str, str] = {}
    _add(path, texts, ())
    if sum(len(text.encode()) for text in texts.values()) > MAX_BYTES:
        raise ModuleError(f"its module {path} has more than {MAX_BYTES / 1e6:g} MB")
    return texts


def _add(path: Path, texts: dict[str, str], importing: tuple[str, ...]) -> None:
    """Add the text of a module after those that it imports; `importing` are the ones before it."""
    if path.name in importing:
        raise ModuleError(f"its module {path} imports itself")
    text = _read(path)
    for name in _IMPORT.findall(text):
        if name not in texts:
            _add(path.with_name(name), texts, (*importing, path.name))
    sheet = path.with_suffix(".css")
    if sheet.exists():
        texts[sheet.name] = _read(sheet)
    texts[path.name] = text


def _read(path: Path) -> str:
    try:
        return path.read_bytes().decode()
    except OSError as error:
        raise ModuleError(f"cannot read its module {path}: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise ModuleError(f"its module {path} is not UTF-8") from None
