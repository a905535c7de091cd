"""Parts without a viewer, for tests of what they show."""

from __future__ import annotations

from typing import Any, TypeVar

from webviz.engine.parts.part import Part

P = TypeVar("P", bound=Part)


def stand_in(kind: type[P], **attributes: Any) -> P:
    """Return a part some of whose attributes and methods are these."""
    part = object.__new__(kind)
    vars(part).update(attributes)
    return part
