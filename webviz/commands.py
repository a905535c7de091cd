"""Commands for `webviz.Viewer.do`; those of features follow from their methods.

Their types are in `commands.pyi`, which `make docs` writes.
"""

from typing import Any

from webviz.engine.commands import *  # noqa: F403
from webviz.engine.commands import __all__ as _of_the_engine
from webviz.engine.feature import commands as _of_features

__all__ = sorted([*_of_the_engine, *_of_features()])  # pyright: ignore[reportUnsupportedDunderAll]


def __getattr__(name: str) -> Any:
    found = _of_features().get(name)
    if found is None:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return found.type
