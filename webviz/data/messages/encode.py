"""Encoding messages."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from struct import Struct, error
from typing import Any

import numpy as np

from webviz.data.messages.cdr import ENCAPSULATION_SIZE, LITTLE_ENDIAN
from webviz.data.messages.classes import CODES, DTYPES, VECTORS, attribute, message_class
from webviz.data.messages.errors import EncodeError
from webviz.data.messages.geometry import (
    NANOSECONDS,
    FrameTransform,
    PoseSequence,
    PoseStampedSequence,
)
from webviz.data.messages.trajectories import JointTrajectoryPointSequence
from webviz.data.messages.typestore import (
    KNOWN,
    MessageField,
    MessageTypes,
    fields,
    full_name,
    per_definitions,
)

Write = Callable[[bytearray, Any], None]
"""Appends a value to a message."""

MAX_ALIGNMENT = 8
"""Bytes, of the largest primitives."""
_ABSENT = object()
_SEQUENCES = (Sequence, np.ndarray, PoseSequence, PoseStampedSequence, JointTrajectoryPointSequence)
_COUNT = Struct("<I").pack


class Misfit(Exception):
    """A value that does not fit its field.

    Args:
        reason: What was expected and what came, without a full stop.
    """

    def __init__(self, reason: str) -> None:
        super().__init__(reason)
        self.reason = reason
        self.path: list[str | int] = []
        """Path to the field, innermost first."""

    @property
    def where(self) -> str:
        """The path as text, such as ".poses[3].pose.position.x"."""
        parts = (f"[{part}]" if isinstance(part, int) else f".{part}" for part in self.path)
        return "".join(reversed(list(parts)))


@per_definitions
def encoder(type_name: str, types: MessageTypes) -> Write:
    """Return the function that appends a message of this type.

    Raises:
        UnknownTypeError: No definition of the type, or of one it holds, is known.
    """
    name = full_name(type_name)
    defaults = message_class(name, types)()
    own = fields(name, types)
    names = [field.name for field in own]
    attributes = [attribute(name) for name in names]
    writers = [_writer(field, types) for field in own]
    absent = [_constant(w, getattr(defaults, a)) for w, a in zip(writers, attributes, strict=True)]
    steps = list(zip(names, attributes, writers, absent, strict=True))

    def write(out: bytearray, message: Any) -> None:
        if isinstance(message, FrameTransform):
            message = _stamped(message)
        elif name in VECTORS and isinstance(message, tuple | list | np.ndarray):
            message = _components(name, names, message)
        is_mapping = isinstance(message, Mapping)
        if is_mapping and (unknown := [key for key in message if key not in names]):
            raise Misfit(_no_field(name, unknown[0], names))
        if not is_mapping and not all(hasattr(message, each) for each in attributes):
            raise _expected(f"a mapping or a {name}", message)
        for field, python_name, write_field, bytes_at in steps:
            value = message.get(field, _ABSENT) if is_mapping else getattr(message, python_name)
            if value is _ABSENT:
                out += bytes_at(len(out) % MAX_ALIGNMENT)
                continue
            try:
                write_field(out, value)
            except Misfit as misfit:
                misfit.path.append(field)
                raise

    return write


def _constant(write: Write, value: Any) -> Callable[[int], bytes]:
    """Return the bytes of a value that stays, by the offset whose padding they begin with."""

    @cache
    def bytes_at(offset: int) -> bytes:
        out = bytearray(offset)
        write(out, value)
        return bytes(out[offset:])

    return bytes_at


def _writer(field: MessageField, types: MessageTypes) -> Write:
    one = _writer_of_one(field, types)
    if field.size is None:
        return one
    if field.base in DTYPES:
        return _numbers(field, field.base)
    if field.base in VECTORS:
        return _elements(field, one, _numbers(field, *VECTORS[field.base]))
    return _elements(field, one)


def _writer_of_one(field: MessageField, types: MessageTypes) -> Write:
    if field.is_message:
        return encoder(field.base, types)
    if field.base == "string":
        return _string(field.longest)
    if field.base == "wstring":
        return _wstring(field.longest)
    return _number(field.base)


def _number(base: str) -> Write:
    code = Struct("<" + CODES[base])
    is_bool = base == "bool"

    def write(out: bytearray, value: Any) -> None:
        try:
            data = code.pack(value)
        except (error, OverflowError, TypeError, ValueError):
            raise _expected(_range(base), value) from None
        if is_bool and value not in (0, 1):
            raise _expected(_range(base), value)
        _align(out, code.size)
        out += data

    return write


def _string(longest: int) -> Write:
    def write(out: bytearray, value: Any) -> None:
        if not isinstance(value, str) or "\0" in value:
            raise _expected("text without NUL", value)
        try:
            data = value.encode()
        except UnicodeEncodeError:
            raise _expected("text that UTF-8 can encode", value) from None
        if longest and len(data) > longest:
            raise _expected(f"text of at most {longest} bytes", value)
        _align(out, 4)
        out += _COUNT(len(data) + 1) + data + b"\0"

    return write


def _wstring(longest: int) -> Write:
    """Return a wstring as rmw_fastrtps writes it; see `Reader.wstring`."""

    def write(out: bytearray, value: Any) -> None:
        if not isinstance(value, str):
            raise _expected("text", value)
        try:
            units = np.frombuffer(value.encode("utf-16-le"), "<u2")
        except UnicodeEncodeError:
            raise _expected("text that UTF-16 can encode", value) from None
        if longest and len(units) > longest:
            raise _expected(f"text of at most {longest} characters", value)
        _align(out, 4)
        out += _COUNT(len(units)) + units.astype("<u4").tobytes()

    return write


def _numbers(field: MessageField, base: str, width: int = 1) -> Write:
    """Return an array of numbers, (N,) or (N, width)."""
    dtype = DTYPES[base]

    def write(out: bytearray, value: Any) -> None:
        numbers = _array(value, base)
        if numbers.size == 0:
            numbers = numbers.reshape((0, width) if width > 1 else 0)
        if numbers.shape[1:] != ((width,) if width > 1 else ()):
            raise _expected(f"shape {'(N,)' if width == 1 else f'(N, {width})'}", numbers.shape)
        _count(out, field, len(numbers))
        with np.errstate(over="ignore", invalid="ignore"):  # checked below
            exact = numbers.astype(dtype.newbyteorder("<"))
        if numbers.dtype != dtype:
            _check(numbers, exact, base)
        if numbers.size:  # an empty array has no padding
            _align(out, dtype.itemsize)
            out += exact.tobytes()

    return write


def _array(value: Any, base: str) -> np.ndarray:
    if isinstance(value, bytes | bytearray | memoryview):
        return np.frombuffer(value, np.uint8)
    try:
        array = np.asarray(value)
    except ValueError:  # rows of several lengths
        raise _expected(f"an array of {base}", value) from None
    if array.dtype.kind not in "biuf" or not array.ndim:
        raise _expected(f"an array of {_range(base)}", value)
    return array


def _check(values: np.ndarray, exact: np.ndarray, base: str) -> None:
    """Refuse numbers out of the range of the field's type; floats may be rounded."""
    with np.errstate(invalid="ignore"):
        if exact.dtype.kind == "f":
            is_lost = np.isinf(exact) & ~np.isinf(values.astype(np.float64))
        else:
            is_lost = (exact != values) | (
                (exact < 0) != (values < 0)
            )  # int64 as uint64 compares equal
    if is_lost.any():
        index = int(np.flatnonzero(is_lost)[0])
        misfit = _expected(_range(base), values.ravel()[index].item())
        misfit.path.append(index)
        raise misfit


def _elements(field: MessageField, one: Write, many: Write | None = None) -> Write:
    """Return an array of messages or strings; `many` writes those given as a numpy array."""

    def write(out: bytearray, value: Any) -> None:
        if isinstance(value, np.ndarray) and many:
            many(out, value)
            return
        is_several = isinstance(value, _SEQUENCES)
        if not is_several or isinstance(value, str | bytes):
            raise _expected(f"a sequence of {field.base}", value)
        _count(out, field, len(value))
        if isinstance(value, PoseSequence) and len(value):
            _align(out, 8)
            out += np.hstack([value.positions, value.orientations]).astype("<f8").tobytes()
            return
        if isinstance(value, PoseStampedSequence) and len(set(value.frame_ids)) == 1:
            one(out, value[0])
            out += _further(value)
            return
        for index, element in enumerate(value):
            try:
                one(out, element)
            except Misfit as misfit:
                misfit.path.append(index)
                raise

    return write


def _further(poses: PoseStampedSequence) -> bytes:
    """All poses of one frame but the first; as each ends at a multiple of 8, they are alike."""
    name = poses.frame_ids[0].encode() + b"\0"
    names = ["sec", "nanosec", "length", "name", "numbers"]
    numbers = (12 + len(name) + 7) // 8 * 8
    layout: Any = {
        "names": names,
        "formats": ["<i4", "<u4", "<u4", f"V{len(name)}", ("<f8", 7)],
        "offsets": [0, 4, 8, 12, numbers],
        "itemsize": numbers + 56,
    }
    rows = np.zeros(len(poses) - 1, np.dtype(layout))
    rows["sec"], rows["nanosec"] = np.divmod(poses.stamps_ns[1:], NANOSECONDS)
    rows["length"], rows["name"] = len(name), np.void(name)
    rows["numbers"] = np.hstack([poses.positions[1:], poses.orientations[1:]])
    return rows.tobytes()


def _stamped(transform: FrameTransform) -> dict[str, Any]:
    """Return a TransformStamped in the layout of its definition."""
    sec, nanosec = divmod(transform.stamp_ns, NANOSECONDS)
    return {
        "header": {"stamp": {"sec": sec, "nanosec": nanosec}, "frame_id": transform.parent},
        "child_frame_id": transform.child,
        "transform": {"translation": transform.translation, "rotation": transform.rotation},
    }


def _components(name: str, names: list[str], values: Any) -> dict[str, Any]:
    if len(values) != len(names):
        raise _expected(f"the {len(names)} numbers of a {name}", values)
    return dict(zip(names, values, strict=True))


def _count(out: bytearray, field: MessageField, count: int) -> None:
    """Append the number of elements, unless it is fixed."""
    if field.size and count != field.size:
        raise Misfit(f"expected {field.size} elements, got {count}")
    if field.most and count > field.most:
        raise Misfit(f"expected at most {field.most} elements, got {count}")
    if not field.size:
        _align(out, 4)
        out += _COUNT(count)


def _align(out: bytearray, size: int) -> None:
    """Append the padding before a primitive of `size` bytes (1, 2, 4 or 8)."""
    out += bytes((ENCAPSULATION_SIZE - len(out)) & (size - 1))


def _expected(what: str, value: Any) -> Misfit:
    text = repr(value)
    return Misfit(f"expected {what}, got {text if len(text) <= 60 else text[:57] + '...'}")


def _range(base: str) -> str:
    """Return the name of a primitive and its range."""
    dtype = DTYPES.get(base)
    if dtype is None or dtype.kind == "f":
        return base
    if dtype.kind == "b":
        return "bool (true or false)"
    limits = np.iinfo(dtype)
    return f"{base} ({limits.min} to {limits.max})"


def _no_field(name: str, wrong: object, names: list[str]) -> str:
    [near] = difflib.get_close_matches(str(wrong), names, 1) or [""]
    hint = f"did you mean {near}?" if near else f"its fields are {', '.join(names)}"
    return f"{name} has no field {wrong!r:.60}; {hint}"


def encode(type_name: str, values: Any = None, types: MessageTypes = KNOWN) -> bytes:
    """Encode a message as ROS 2 does: plain CDR, little endian, without trailing padding.

    Args:
        type_name: Such as "sensor_msgs/msg/LaserScan" or, as in ROS 1, "sensor_msgs/LaserScan".
        values: A mapping of field names to values, with nested mappings for nested messages; or an
            instance of `message_class(type_name)`, or any other object with such attributes.
            Missing keys have their default; so have all fields for None. Arrays are numpy arrays,
            lists or other sequences of numbers; those of points and quaternions may be (N, 3) and
            (N, 4).
        types: that define the type.

    Returns:
        The bytes as `decode` takes them, encapsulation header included.

    Raises:
        EncodeError: A value is invalid. The text names the field and what it expects.
        UnknownTypeError: No definition of the type is known.
    """
    out = bytearray(LITTLE_ENDIAN)
    try:
        encoder(type_name, types)(out, {} if values is None else values)
    except Misfit as misfit:
        end = "" if misfit.reason.endswith("?") else "."
        raise EncodeError(f"{type_name}{misfit.where}: {misfit.reason}{end}") from misfit
    return bytes(out)
