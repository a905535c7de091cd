"""Repairs of mesh files that RViz's readers take: binary STL and COLLADA of careless exporters."""

from __future__ import annotations

import io
import struct

from collada import Collada
from collada.common import DaeError
from lxml import etree  # pyright: ignore[reportAttributeAccessIssue]

HEADER, TRIANGLE = 84, 50
"""Bytes of the header with its count, and of each triangle."""
TEXT_BYTES = 1000
"""In which an ASCII file has its first facet, and no zeros."""
_UTF_16 = (b"\xff\xfe", b"\xfe\xff")
"""Marks of an encoding that has NULs itself."""


def whole_stl(data: bytes) -> bytes:
    """Return an STL file whose count of triangles fits its size.

    Bytes behind the triangles are dropped, and a count of zero is that of the bytes, since some
    exporters write it before they know it.

    Raises:
        ValueError: a binary file was cut off.
    """
    if len(data) < HEADER or _is_text(data):
        return data
    (count,) = struct.unpack_from("<I", data, HEADER - 4)
    room = (len(data) - HEADER) // TRIANGLE
    if count > room:
        raise ValueError(f"it is cut off after {room} of {count} triangles")
    count = count or room
    return data[: HEADER - 4] + struct.pack("<I", count) + data[HEADER : HEADER + TRIANGLE * count]


def _is_text(data: bytes) -> bool:
    start = data[:TEXT_BYTES]
    return b"\0" not in start and b"facet" in start.lower()


def only_xml(data: bytes) -> bytes:
    """Return a COLLADA file without white space before its declaration and text after a NUL.

    Exporters leave both behind; XML forbids them, and Assimp, and so RViz, tolerates them.
    """
    return data.partition(b"\0")[0].lstrip() if not data.startswith(_UTF_16) else data


def without_broken_materials(data: bytes) -> tuple[bytes, list[str]]:
    """Return a COLLADA file without references to materials that it does not define.

    pycollada drops a body entirely when one of its materials refers to a missing picture or
    effect, which some exporters leave behind; Assimp, and so RViz, draws it.

    Returns:
        The file, and the ids of the removed materials.
    """
    document = Collada(io.BytesIO(data), ignore=[DaeError])
    defined = {material.id for material in document.materials}
    parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False)
    root = etree.fromstring(data, parser)
    broken = []
    for binding in root.findall(".//{*}instance_material"):
        material = binding.get("target", "").lstrip("#")
        if material not in defined:
            broken.append(material)
            binding.getparent().remove(binding)
    return etree.tostring(root), sorted(set(broken))
