"""The types of properties of viser's nodes, evaluated once for each class."""

from __future__ import annotations

import functools
from typing import Any, get_type_hints

from viser._assignable_props_api import AssignablePropsBase

_hints = functools.cache(get_type_hints)


def evaluate_hints_once() -> None:
    """Make a new node cheaper: viser evaluates the annotations of its class anew for each."""

    def hints(handle: AssignablePropsBase[Any]) -> dict[str, Any]:
        return _hints(type(handle._impl.props))

    AssignablePropsBase._prop_hints = property(hints)  # pyright: ignore
