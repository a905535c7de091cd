"""Modules that plug-ins bring for the page.

    class Lasso(Tool):
        gesture, module = "lasso", "lasso.js"

The file has one function as its default export. Each page calls it once with an object through
which it adds gestures, widgets, overlays and tabs (`webviz/page/web/extensions.js`).
"""

from __future__ import annotations

import functools
import sys
from pathlib import Path

from webviz.api.declared import Declared

MAX_BYTES = 1_000_000
"""Size of a module; all pages load it."""


class ModuleError(ValueError):
    """The module of a plug-in cannot be used; part of a sentence."""


@functools.cache
def module_text(cls: type[Declared]) -> str:
    """Return the module of a plug-in for the page, "" without one.

    Raises:
        ModuleError: it is missing, not UTF-8 or too large.
    """
    if not cls.module:
        return ""
    home = next(base for base in cls.__mro__ if "module" in vars(base))
    python = getattr(sys.modules[home.__module__], "__file__", None) or ""
    path = Path(python).with_name(Path(cls.module).name) if python else Path(cls.module)
    try:
        data = path.read_bytes()
    except OSError as error:
        raise ModuleError(f"cannot read its module {path}: {error.strerror or error}") from None
    if len(data) > MAX_BYTES:
        raise ModuleError(f"its module {path} has more than {MAX_BYTES / 1e6:g} MB")
    try:
        return data.decode()
    except UnicodeDecodeError:
        raise ModuleError(f"its module {path} is not UTF-8") from None
