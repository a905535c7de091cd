"""Points, texts and files of markers: whether two are equal, and how much memory they take."""

from __future__ import annotations

from typing import Any

from numpy.typing import NDArray

from webviz.api.nodes import same
from webviz.data.messages.markers import NOTHING, Content


def is_same(a: Content, b: Content) -> bool:
    """Return whether two contents are equal."""
    if a is b:
        return True
    if (a is NOTHING) != (b is NOTHING):
        return False
    return (
        (a.text, a.mesh_resource, a.texture_resource, a.mesh_file.filename)
        == (b.text, b.mesh_resource, b.texture_resource, b.mesh_file.filename)
        and _equal(a.points, b.points)
        and _equal(a.colors, b.colors)
        and _equal(a.uv_coordinates, b.uv_coordinates)
        and _equal(a.mesh_file.data, b.mesh_file.data)
        and _equal(a.texture.data, b.texture.data)
    )


def _equal(a: NDArray[Any], b: NDArray[Any]) -> bool:
    return len(a) == len(b) and (not len(a) or same(a, b))


def size_of(content: Content) -> int:
    """Bytes of a content."""
    arrays = (content.points, content.colors, content.uv_coordinates)
    files = len(content.mesh_file.data) + len(content.texture.data)
    return sum(array.nbytes for array in arrays) + files + len(content.text)


def detached(content: Content) -> Content:
    """Return a copy that does not keep the message alive, of which it may be a small part."""
    if not (len(content.points) or len(content.colors) or len(content.uv_coordinates)):
        return content
    values: dict[str, Any] = {name: getattr(content, name) for name in Content.__struct_fields__}
    for name in ("points", "colors", "uv_coordinates"):
        if len(values[name]):
            values[name] = values[name].copy()
    return Content(**values)


class Memory:
    """Memory taken by the contents of all rows.

    Args:
        limit: bytes.
    """

    def __init__(self, limit: int) -> None:
        self._limit = limit
        self._sizes: dict[int, int] = {}
        self._total = 0

    def take(self, row: int, size: int) -> bool:
        """Replace the bytes reserved for a row; False if they do not fit."""
        total = self._total - self._sizes.get(row, 0) + size
        if total > self._limit:
            return False
        self._total = total
        self._sizes[row] = size
        return True

    def free(self, row: int) -> None:
        """Note that a row has no content any more."""
        self._total -= self._sizes.pop(row, 0)
