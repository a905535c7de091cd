"""COLLADA files that pycollada reads only in part."""

from __future__ import annotations

import io

from collada import Collada
from collada.common import DaeError
from lxml import etree  # pyright: ignore[reportAttributeAccessIssue]

_UTF_16 = (b"\xff\xfe", b"\xfe\xff")
"""Marks of an encoding that has NULs itself."""


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
