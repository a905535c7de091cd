"""The remedy of what is invisible."""

from __future__ import annotations

from webviz import Remedy


def opaque(path: str = "alpha") -> Remedy:
    """Make it visible again.

    Args:
        path: of the property with the opacity.
    """
    return Remedy(path, 1.0, "Set alpha to 1")
