"""Commands for `webviz.Viewer.do`; those of features follow from their methods.

Their types are in `commands.pyi`, which `make docs` writes.
"""

from typing import Any

from webviz.api.errors import Error
from webviz.engine.commands import *  # noqa: F403
from webviz.engine.commands import __all__ as _of_the_engine
from webviz.engine.feature import broken_features
from webviz.engine.feature import commands as _all

_of_features = {n: each.type for n, each in _all().items() if issubclass(each.type, Command)}  # noqa: F405
__all__ = sorted([*_of_the_engine, *_of_features])  # pyright: ignore[reportUnsupportedDunderAll]


class MissingCommand(Error, AttributeError):
    """No part of this installation has a command."""


def __getattr__(name: str) -> Any:
    if (value := _of_features.get(name)) is not None:
        return value
    if missing := ", ".join(broken_features()):
        raise MissingCommand(f"There is no {name} without {missing}. Reinstall webviz.")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
