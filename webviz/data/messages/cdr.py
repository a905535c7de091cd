"""Reading primitives of CDR, the encoding of ROS 2 messages on the wire and in bags.

Format: OMG DDSI-RTPS 2.5, section 10 (encapsulation header), and CORBA 3.3 part 2, section 9.3
(CDR transfer syntax). Four bytes of encapsulation come first; every primitive is aligned to its
own size, counted from the byte after them.
"""

from __future__ import annotations

import sys
from struct import Struct

import numpy as np

from webviz.data.messages.errors import MessageError

ENCAPSULATION_SIZE = 4
LITTLE_ENDIAN = b"\0\1\0\0"
"""The encapsulation of plain CDR in this byte order."""
MAX_TEXT = 16 << 20
"""Bytes of the long strings of a message; decoded, a string may take four times as many."""
LONG_STRING = 4096
"""Bytes of a string that counts."""
MAX_ELEMENTS = 2_000_000
"""Largest number of elements of the sequences and arrays of a message that do not become arrays of
numbers."""
_BOOL = np.dtype(np.bool_)
_ORDERS = {0: ">", 1: "<"}
_NATIVE = "<" if sys.byteorder == "little" else ">"
_UINT32 = {order: Struct(order + "I").unpack_from for order in "<>"}
_TIME = {order: Struct(order + "iI").unpack_from for order in "<>"}


class CdrError(MessageError):
    """Malformed bytes at `Reader.pos`."""


class TooLargeError(MessageError):
    """A message of which too many objects would be made; the text is a clause that says which."""


class Reader:
    """A cursor over one encapsulated message.

    Attributes:
        data: The whole message, read-only, encapsulation included.
        pos: Index in `data` of the next byte to read; after an error, where reading stopped.
        order: Byte order of the message in `struct` notation, "<" or ">".
    """

    __slots__ = ("_elements", "_text", "_uint32", "data", "order", "pos", "size")

    def __init__(self, data: bytes | bytearray | memoryview) -> None:
        self.data = data if isinstance(data, bytes) else memoryview(data).cast("B").toreadonly()
        self.pos = 0
        self.size = len(self.data)
        if self.size < ENCAPSULATION_SIZE:
            raise CdrError("it is shorter than an encapsulation header")
        representation = self.data[0] << 8 | self.data[1]
        if representation not in _ORDERS:
            raise CdrError(
                f"its encapsulation 0x{representation:04x} is not plain CDR (XCDR2 and "
                "parameter lists are not supported)"
            )
        self.order = _ORDERS[representation]
        self._uint32 = _UINT32[self.order]
        self._elements = self._text = 0
        self.pos = ENCAPSULATION_SIZE

    def align(self, size: int) -> None:
        """Skip the padding before a primitive of `size` bytes (1, 2, 4 or 8)."""
        self.pos += (ENCAPSULATION_SIZE - self.pos) & (size - 1)

    def count(self) -> int:
        """Read the uint32 number of elements of a sequence."""
        pos = (self.pos + 3) & ~3
        (count,) = self._uint32(self.data, pos)
        self.pos = pos + 4
        return count

    def elements(self, length: int | None = None, weight: int = 1) -> int:
        """Return the number of elements of a sequence or array, each of which becomes an object.

        An object takes fifty times the memory of an element of a few bytes.

        Args:
            length: of a fixed array; read without one.
            weight: what an element counts as.
        """
        count = length or self.count()
        if count > self.size - self.pos:  # each has a byte at least
            raise CdrError(f"{count} elements are longer than the rest of the message")
        self._elements += count * weight
        if self._elements > MAX_ELEMENTS:
            raise TooLargeError(f"its sequences have more than {MAX_ELEMENTS} elements")
        return count

    def stamp(self) -> int:
        """Read a builtin_interfaces/Time as nanoseconds."""
        self.align(4)
        sec, nanosec = _TIME[self.order](self.data, self.pos)
        self.pos += 8
        return sec * 1_000_000_000 + nanosec

    def string(self) -> str:
        """Read a string; bytes that are not UTF-8 become U+FFFD."""
        pos = (self.pos + 3) & ~3
        (length,) = self._uint32(self.data, pos)
        start = pos + 4
        end = start + length
        if end > self.size:
            self.pos = pos
            raise CdrError(f"a string of {length} bytes is longer than the rest of the message")
        if length == 0:  # invalid, as CDR counts the final NUL, but some writers send it
            self.pos = end
            return ""
        if self.data[end - 1]:
            self.pos = pos
            raise CdrError(f"a string of {length} bytes does not end in NUL")
        if length > LONG_STRING:
            self._text += length
            if self._text > MAX_TEXT:
                raise TooLargeError(f"its strings have more than {MAX_TEXT >> 20} MB")
        self.pos = end
        return str(self.data[start : end - 1], "utf-8", "replace")

    def wstring(self) -> str:
        """Read a wstring; what is not UTF-16 becomes U+FFFD.

        Its length is that of its UTF-16 units, without a NUL. rmw_fastrtps writes each in 4 bytes,
        rmw_cyclonedds in 2, and nothing says which: only if all upper halves are zero, it is 4. A
        single character in 2 bytes is the same with the padding behind it.
        """
        count = self.count()
        start = self.pos
        if 2 * count > self.size - start:
            text = f"a wide string of {count} characters"
            raise CdrError(f"{text} is longer than the rest of the message")
        halves = np.frombuffer(self.data, f"{self.order}u2", (self.size - start) // 2, start)
        halves = halves[: 2 * count]
        upper, lower = (1, 0) if self.order == "<" else (0, 1)
        is_wide = len(halves) == 2 * count and not halves[upper::2].any()
        units = halves[lower::2] if is_wide else halves[:count]
        size = len(units) * (4 if is_wide else 2)
        if size > LONG_STRING:
            self._text += size
            if self._text > MAX_TEXT:
                raise TooLargeError(f"its strings have more than {MAX_TEXT >> 20} MB")
        self.pos = start + size
        return str(units.astype("<u2").tobytes(), "utf-16-le", "replace")

    def array(self, dtype: np.dtype, count: int) -> np.ndarray:
        """Read `count` primitives as a read-only array, a view if the byte order is native.

        Args:
            dtype: A numeric or boolean dtype in native byte order.
            count: Number of elements, checked against the size of the message before allocation.
        """
        if count == 0:  # an empty array has no padding
            return np.frombuffer(b"", dtype)
        itemsize = dtype.itemsize
        start = self.pos + ((ENCAPSULATION_SIZE - self.pos) & (itemsize - 1))
        end = start + count * itemsize
        if end > self.size:
            raise CdrError(f"{count} elements of {dtype} are longer than the rest of the message")
        self.pos = end
        if dtype is _BOOL:  # bytes other than 0 and 1 in a bool array are undefined behaviour
            array = np.frombuffer(self.data, np.uint8, count, start) != 0
        elif self.order == _NATIVE:
            return np.frombuffer(self.data, dtype, count, start)
        else:
            array = np.frombuffer(self.data, dtype.newbyteorder(), count, start).astype(dtype)
        array.flags.writeable = False
        return array
