"""COLLADA files that pycollada reads only in part."""

from __future__ import annotations

import io

from collada import Collada
from collada.common import DaeError
from lxml import etree  # pyright: ignore[reportAttributeAccessIssue]


def without_broken_materials(data: bytes) -> tuple[bytes, list[str]]:
    """A COLLADA file whose bodies no longer name materials that the file fails to define.

    pycollada drops a body entirely when one of its materials refers to a picture or effect that
    is not in the file (exporters leave such remains behind); Assimp, and so RViz, draws it.

    Returns:
        The file, and the ids of the materials taken out.
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
