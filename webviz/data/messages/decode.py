"""Decoding messages."""

from __future__ import annotations

import struct
from collections.abc import Callable
from functools import lru_cache
from typing import Any, TypeVar

from webviz.data.messages import typestore
from webviz.data.messages.cdr import CdrError, Reader, TooLargeError
from webviz.data.messages.classes import WRITTEN
from webviz.data.messages.decoders import decoder
from webviz.data.messages.errors import DecodeError
from webviz.data.messages.typestore import KNOWN, DefinedTypes, MessageTypes

MAX_DEFINITIONS = 256
"""Largest number of definitions; the files of recordings and the channels of bridges may share
them."""

PADDING = 4
"""Number of bytes to a multiple of which writers of bags and DDS fill up messages."""

T = TypeVar("T")
Bytes = bytes | bytearray | memoryview


def decode(type_name: str, cdr: Bytes, types: MessageTypes = KNOWN) -> Any:
    """Decode a message.

    Numeric arrays are read-only views of `cdr`, which they keep alive.

    Args:
        type_name: Such as "sensor_msgs/msg/LaserScan" or, as in ROS 1, "sensor_msgs/LaserScan".
        cdr: The message as received, encapsulation header included. Trailing padding is ignored.
        types: that define the type: those of this process, of a recording or of a bridge.

    Returns:
        An object with the fields of the type, an instance of `message_class(type_name, types)`.

    Raises:
        DecodeError: The bytes are not a message of this type.
        UnknownTypeError: No definition of the type is known.
    """
    return _read(type_name, cdr, lambda reader: decoder(type_name, reader.order, types)(reader))


def is_whole(type_name: str, cdr: Bytes, types: MessageTypes = KNOWN) -> bool:
    """Return whether bytes are a message of a type and nothing else but padding; see `decode`.

    Raises:
        UnknownTypeError: No definition of the type is known.
    """

    def rest(reader: Reader) -> int:
        decoder(type_name, reader.order, types)(reader)
        return reader.size - reader.pos

    try:
        return _read(type_name, cdr, rest) < PADDING
    except DecodeError:
        return False


def peek_header(type_name: str, cdr: Bytes, types: MessageTypes = KNOWN) -> tuple[str, int] | None:
    """Read only the header of a message; see `decode`.

    Returns:
        Frame id and stamp in nanoseconds; None if the type does not begin with a std_msgs/Header.

    Raises:
        DecodeError: The bytes are too short or not CDR.
        UnknownTypeError: No definition of the type is known.
    """
    return _read(type_name, cdr, _peek) if _has_header(type_name, types) else None


def register(type_name: str, text: str) -> None:
    """Register a message type at run time, for example from its publisher.

    A definition that differs from the known one replaces it, because publishers know best.

    Args:
        type_name: The type that `text` defines.
        text: Its .msg text. Nested types follow, each after a line of "=" and "MSG: pkg/Type", as
            `definition` returns them and bags store them. Or IDL files, each after a line of "="
            and "IDL: pkg/msg/Type".

    Raises:
        DefinitionError: The text is invalid, a nested type is missing or contains itself, or it
            contradicts a type with a class in webviz, such as Header.
    """
    typestore.add(type_name, text, fixed=WRITTEN)


@lru_cache(MAX_DEFINITIONS)
def defined(type_name: str, text: str) -> DefinedTypes:
    """Return the types of a definition, which are read when they are needed; see `register`.

    Raises:
        UnknownTypeError: `type_name` is not the name of a type.
    """
    return DefinedTypes(type_name, text, fixed=WRITTEN)


def prepare(type_name: str, types: MessageTypes = KNOWN) -> None:
    """Build what `decode` needs, which takes a second for a message of many types.

    Raises:
        MessageError: as `decode`, for any message of this type.
    """
    decoder(type_name, "<", types)
    _has_header(type_name, types)


@typestore.per_definitions
def _has_header(type_name: str, types: MessageTypes) -> bool:
    fields = typestore.fields(type_name, types)
    return bool(fields) and fields[0].base == "std_msgs/msg/Header" and fields[0].size is None


def _peek(reader: Reader) -> tuple[str, int]:
    stamp_ns = reader.stamp()
    return reader.string(), stamp_ns


def _read(type_name: str, cdr: Bytes, read: Callable[[Reader], T]) -> T:
    """Call `read`; errors name the position in the bytes."""
    pos = 0
    try:
        reader = Reader(cdr)
    except CdrError as error:
        problem = str(error)
    else:
        try:
            return read(reader)
        except CdrError as error:
            problem, pos = str(error), reader.pos
        except TooLargeError as error:
            raise DecodeError(f"This {type_name} is too large: {error}.") from None
        except (MemoryError, RecursionError) as error:
            reason = "memory" if isinstance(error, MemoryError) else "stack"
            raise DecodeError(f"This {type_name} is too large for the {reason}.") from error
        except struct.error:
            problem, pos = "it ends in the middle of a value", reader.pos
    raise DecodeError(f"Not a {type_name}: {problem} (at byte {pos} of {len(cdr)}).")
