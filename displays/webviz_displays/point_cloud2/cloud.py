"""Reading the fields of a PointCloud2 of any types, order and padding."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from webviz.data import messages
from webviz.data.words import listed
from webviz_displays.shared.geometry import FARTHEST, origin_near

Position = tuple[float, float, float]

_DTYPES = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 8: "f8"}
"""Types of numpy by `PointField.datatype`."""

_XYZ = np.dtype("V12")
"""Three floats as one item: numpy copies strided items five times as fast as strided rows."""

_NAMED = 20
"""Fields that a status lists by name."""


class CloudError(ValueError):
    """A cloud, or one of its fields, cannot be read; the text is a sentence that says why."""


class Cloud:
    """The points of a message as arrays; views of its bytes if no conversion is needed.

    Args:
        message: its fields may have any type, order and place, big-endian and padded rows included.

    Attributes:
        count: of points.
        width: points per row.
        names: of the fields, in the order of the message.
        remark: a sentence about inconsistent sizes, "" if they agree.

    Raises:
        CloudError: there are fewer bytes than width, height and steps require.
    """

    def __init__(self, message: messages.PointCloud2) -> None:
        self.width = message.width
        self.count = message.width * message.height
        self.names = [field.name for field in message.fields]
        self._message = message
        self.remark = ""
        row, size = message.width * message.point_step, len(message.data)
        self._row_step = message.row_step if message.height > 1 else row
        if self._row_step < row or (self._row_step != row and size == row * message.height):
            # Drivers have written the size of all rows, or nothing, and RViz ignores the field.
            less = "less than" if self._row_step < row else "although the data fits"
            self.remark = (
                f"row_step is {message.row_step}, {less} width x point_step, {row}; "
                "reading the rows as contiguous. Fix the publisher."
            )
            self._row_step = row
        if not self.count:
            return
        if not message.point_step:
            raise CloudError(
                f"point_step is 0, but the cloud has {self.count} points. Fix the publisher."
            )
        needed = (message.height - 1) * self._row_step + row
        if size < needed:
            raise CloudError(
                f"The data has {size} bytes, but {message.width} x {message.height} points of "
                f"{message.point_step} bytes need {needed}."
            )
        if size > message.height * max(message.row_step, row):
            self.remark = (
                f"The data has {size} bytes, {needed} were enough for {message.width} x "
                f"{message.height} points of {message.point_step} bytes; the rest is ignored."
            )

    @property
    def fields(self) -> str:
        """The names of the first fields, for a sentence."""
        return listed([f"{name:.40}" for name in self.names], _NAMED) or "none"

    def values(self, name: str) -> NDArray[Any]:
        """Return a field of all points (N,) in the type of the message.

        The first of several elements.

        Raises:
            CloudError: the field is missing or cannot be read.
        """
        offset, dtype = self._place(name)
        return self._view(dtype, offset)

    def quads(self, name: str) -> NDArray[np.uint32]:
        """Return the four bytes of a field of all points as one number (N,), whatever its type.

        Raises:
            CloudError: the field is missing or does not have four bytes.
        """
        offset, dtype = self._place(name)
        if dtype.itemsize != 4:
            raise CloudError(f"Field {name!r} is {dtype.name}; a packed colour has 4 bytes.")
        return self._view(np.dtype(dtype.byteorder + "u4"), offset)

    def positions(self) -> tuple[NDArray[np.float32], Position]:
        """Return where the points are, relative to a round point near them.

        Returns:
            float32 (N, 3) in metres, and that point, zero if they are near zero already: float32
            resolves 0.5 m at UTM coordinates. Rows that cannot be drawn are undefined.

        Raises:
            CloudError: x, y or z is missing or cannot be read.
        """
        places = [self._place(name) for name in "xyz"]
        columns = [self._view(dtype, offset) for offset, dtype in places]
        if self._message.is_bigendian and _make_sense_swapped(columns):
            raise CloudError(
                "is_bigendian is set, but x, y and z make sense in little-endian order only. "
                "Publish the cloud with is_bigendian: false."
            )
        origin = _middle(columns)
        offset = places[0][0]
        packed = [(offset + 4 * i, np.dtype("<f4")) for i in range(3)]
        if places == packed and not any(origin):
            xyz = np.ascontiguousarray(self._view(_XYZ, offset))
            return xyz.view(np.float32).reshape(-1, 3), origin
        xyz = np.empty((self.count, 3), np.float32)
        with np.errstate(over="ignore", invalid="ignore"):  # such points are dropped later
            for i, column in enumerate(columns):
                if origin[i]:
                    np.subtract(
                        column, origin[i], out=xyz[:, i], dtype=np.float64, casting="unsafe"
                    )
                else:
                    xyz[:, i] = column
        return xyz, origin

    def point(self, index: int) -> dict[str, object]:
        """All fields of one point by name, each in the type of the message.

        A field of several elements is an array, a packed colour its channels, and a field that
        cannot be read a sentence.
        """
        row, column = divmod(index, self._message.width)
        start = row * self._row_step + column * self._message.point_step
        values_by_field: dict[str, Any] = {}
        for field, offset, dtype in self._places(values_by_field):
            values = np.ndarray(max(field.count, 1), dtype, self._message.data, start + offset)
            if field.name in ("rgb", "rgba") and dtype.itemsize == 4:
                alpha, *channels = int(values.view(dtype.byteorder + "u4")[0]).to_bytes(4, "big")
                channels += [alpha] * (field.name == "rgba")
                named = zip("rgba", channels, strict=False)
                values_by_field[field.name] = ", ".join(f"{name} {value}" for name, value in named)
            else:
                values_by_field[field.name] = values[0] if len(values) == 1 else values
        return values_by_field

    def _places(self, problems: dict[str, Any]) -> Iterator[tuple[Any, int, np.dtype[Any]]]:
        """Yield the fields that can be read, with offset and type; note why others cannot."""
        for field in self._message.fields:
            try:
                yield field, *self._place(field.name)
            except CloudError as error:
                problems[field.name] = str(error)

    def _place(self, name: str) -> tuple[int, np.dtype[Any]]:
        """Offset and type of a field."""
        field = next((field for field in self._message.fields if field.name == name), None)
        if field is None:
            raise CloudError(f"The cloud has no field {name!r}; its fields are: {self.fields}.")
        if field.datatype not in _DTYPES:
            raise CloudError(f"Field {name!r} has the unknown datatype {field.datatype}.")
        order = ">" if self._message.is_bigendian else "<"
        dtype = np.dtype(order + _DTYPES[field.datatype])
        end = field.offset + dtype.itemsize * max(field.count, 1)
        if end > self._message.point_step:
            raise CloudError(
                f"Field {name!r} takes bytes {field.offset} to {end} of each point, but point_step "
                f"is {self._message.point_step}."
            )
        return field.offset, dtype

    def _view(self, dtype: np.dtype[Any], offset: int) -> NDArray[Any]:
        """Return the values at an offset in all points (N,); a copy only if rows are padded."""
        if not self.count:
            return np.empty(0, dtype)
        height, width, step = self._message.height, self._message.width, self._message.point_step
        data = self._message.data
        if self._row_step == width * step:
            return np.ndarray((self.count,), dtype, data, offset, (step,))
        rows = np.ndarray((height, width), dtype, data, offset, (self._row_step, step))
        return rows.reshape(-1)


def drawable(xyz: NDArray[np.float32]) -> NDArray[np.intp] | None:
    """Return the rows of (N, 3) that are finite and near enough to draw; None if all are."""
    with np.errstate(invalid="ignore"):
        if not len(xyz) or (xyz.min() > -FARTHEST and xyz.max() < FARTHEST):
            return None
        return np.flatnonzero((np.abs(xyz) < FARTHEST).all(axis=1))


def _make_sense_swapped(columns: list[NDArray[Any]]) -> bool:
    """Return whether coordinates are plausible only in the other byte order.

    Floats in the wrong order are noise, of which one fifth happens to be plausible.
    """
    some = [column[:: max(len(column) // 100, 1)] for column in columns]
    if any(column.dtype.kind != "f" for column in some):
        return False
    read = np.concatenate([_are_sensible(column[column != 0]) for column in some])
    swapped = np.concatenate([_are_sensible(column[column != 0].byteswap()) for column in some])
    return len(read) > 0 and read.mean() < 0.5 and swapped.mean() > 0.9


def _are_sensible(values: NDArray[Any]) -> NDArray[np.bool_]:
    """Return the mask of (N,) values that are NaN, or between a micrometre and `FARTHEST`."""
    with np.errstate(invalid="ignore"):
        return np.isnan(values) | ((np.abs(values) > 1e-6) & (np.abs(values) < FARTHEST))


def _middle(columns: list[NDArray[Any]]) -> Position:
    """Return a round point near most points, estimated from a hundred of them."""
    step = max(len(columns[0]) // 100, 1)
    with np.errstate(invalid="ignore"):
        some = np.stack([column[::step].astype(np.float64) for column in columns], axis=1)
    some = some[(np.abs(some) < FARTHEST).all(axis=1)]
    # `np.median` takes longer, and imports numpy.ma, 8 ms of the frame loop.
    return origin_near([np.sort(some, axis=0)[len(some) // 2]]) if len(some) else (0.0, 0.0, 0.0)
