"""Former names of the API, which work for one more version."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping


def former_names(module: str, names: Mapping[str, type]) -> Callable[[str], type]:
    """Return the `__getattr__` of a module for classes that have another name now.

    Args:
        module: its name.
        names: the classes by former name.
    """

    def find(name: str) -> type:
        if name not in names:
            raise AttributeError(f"module {module!r} has no attribute {name!r}")
        now = names[name]
        warnings.warn(
            f"{module}.{name} is {now.__module__}.{now.__name__} now.",
            DeprecationWarning,
            stacklevel=2,
        )
        return now

    return find
