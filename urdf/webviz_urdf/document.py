"""URDF text to a clean XML tree: hardened against hostile XML, every number checked.

Faults that urdfdom would misread silently, or yourdfpy report as a bare `ValueError`, are found
here, where the line number is known. The resulting tree contains only what a viewer draws.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from lxml import etree  # pyright: ignore[reportAttributeAccessIssue]

from webviz_urdf.robot import MissingShape, RobotDescriptionError

_CHILDREN = {
    "robot": ("link", "joint", "material"),
    "link": ("visual", "collision", "inertial"),
    "visual": ("origin", "geometry", "material"),
    "collision": ("origin", "geometry"),
    "geometry": ("box", "cylinder", "sphere", "mesh"),
    "material": ("color", "texture"),
    "inertial": ("origin", "mass", "inertia"),
    "joint": ("origin", "parent", "child", "axis", "limit", "mimic"),
}
_TEXTS = {
    "robot": ("name",),
    "link": ("name",),
    "visual": ("name",),
    "collision": ("name",),
    "mesh": ("filename",),
    "material": ("name",),
    "texture": ("filename",),
    "joint": ("name", "type"),
    "parent": ("link",),
    "child": ("link",),
    "mimic": ("joint",),
}
# How many numbers each attribute holds.
_NUMBERS = {
    "origin": {"xyz": (3,), "rpy": (3,)},
    "box": {"size": (3,)},
    "cylinder": {"radius": (1,), "length": (1,)},
    "sphere": {"radius": (1,)},
    "mesh": {"scale": (1, 3)},
    "color": {"rgba": (4,)},
    "mass": {"value": (1,)},
    "inertia": dict.fromkeys(("ixx", "ixy", "ixz", "iyy", "iyz", "izz"), (1,)),
    "axis": {"xyz": (3,)},
    "limit": {"lower": (1,), "upper": (1,), "effort": (1,)},
    "mimic": {"multiplier": (1,), "offset": (1,)},
}
_LARGEST = 1e12
_PARSER: dict[str, Any] = {
    "encoding": "utf-8",
    "resolve_entities": False,
    "no_network": True,
    "load_dtd": False,
    "huge_tree": False,
    "remove_comments": True,
    "remove_pis": True,
}
_REQUIRED = {
    "link": ("name",),
    "joint": ("name", "type"),
    "parent": ("link",),
    "child": ("link",),
    "mimic": ("joint",),
    "box": ("size",),
    "cylinder": ("radius", "length"),
    "sphere": ("radius",),
    "color": ("rgba",),
}
_REQUIRED_CHILDREN = {"joint": ("parent", "child")}


@dataclass
class Document:
    """A description's XML after the checks.

    Args:
        root: `<robot>` with known elements and attributes only, no comments, no namespaces.
        missing: visuals and collisions without a known geometry, which are not in `root`.
        warnings: sentences about tolerated faults.
    """

    root: etree._Element
    missing: list[MissingShape] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)


def parse_document(text: str) -> Document:
    """Parse and check URDF text.

    External entities, DTDs and URLs are never loaded; a description that declares entities is
    refused.

    Raises:
        RobotDescriptionError: one sentence with the line and the element.
    """
    source = _parse_xml(text)
    namespace = etree.QName(source).namespace
    if etree.QName(source).localname != "robot":
        raise RobotDescriptionError(
            f"The root element is <{source.tag}>, not <robot>: this is not a robot description."
        )
    document = Document(etree.Element("robot"))
    _copy(source, document.root, document, namespace, link="")
    if document.root.find("link") is None:
        raise RobotDescriptionError(
            "The robot has no <link>"
            + (
                ": it is a xacro file that was not expanded."
                if any("xacro" in (etree.QName(child).namespace or "") for child in source)
                else "."
            )
        )
    if not document.root.get("name"):
        document.warnings.append("The robot has no name.")
        document.root.set("name", "robot")
    return document


def _parse_xml(text: str) -> etree._Element:
    parser = etree.XMLParser(**_PARSER)
    text = text.partition("\0")[0].strip()
    if not text:
        raise RobotDescriptionError("The robot description is empty.")
    try:
        try:
            root = etree.fromstring(text.encode(), parser)
        except etree.XMLSyntaxError as error:
            if any(each.type_name != "NS_ERR_UNDEFINED_NAMESPACE" for each in parser.error_log):
                raise
            root = _without_unbound_prefixes(text, error)
    except etree.XMLSyntaxError as error:
        reason = " ".join((error.msg or "").split())[:200]
        raise RobotDescriptionError(f"The robot description is not XML: {reason}.") from error
    except ValueError as error:  # lone surrogates
        raise RobotDescriptionError(f"The robot description is not text: {error}.") from error
    declarations = root.getroottree().docinfo.internalDTD
    if declarations is not None and any(True for _ in declarations.iterentities()):
        raise RobotDescriptionError(
            "The robot description declares XML entities, which webviz does not expand."
        )
    return root


def _without_unbound_prefixes(text: str, error: etree.XMLSyntaxError) -> etree._Element:
    """Return the tree without elements of undeclared namespace prefixes, as TinyXML reads it.

    Raises:
        XMLSyntaxError: `error`, if the root is one of them.
    """
    root = etree.fromstring(text.encode(), etree.XMLParser(recover=True, **_PARSER))
    for element in list(root.iter(etree.Element)):
        if _is_unbound(element):
            if element is root:
                raise error
            element.getparent().remove(element)
    return root


def _is_unbound(element: etree._Element) -> bool:
    return ":" in element.tag and not element.tag.startswith("{")


def _copy(
    source: etree._Element,
    target: etree._Element,
    document: Document,
    namespace: str | None,
    link: str,
) -> None:
    """Copy the known attributes and children of `source` to `target`, checking each."""
    tag = str(target.tag)
    for name in _TEXTS.get(tag, ()):
        value = source.get(name)
        if value is not None:
            target.set(name, value)
    for name, counts in _NUMBERS.get(tag, {}).items():
        value = source.get(name)
        if value is not None:
            target.set(name, _numbers(source, tag, name, value, counts))
    for name in _REQUIRED.get(tag, ()):
        if not target.get(name):
            raise RobotDescriptionError(
                f"Line {source.sourceline}: <{tag}> has no '{name}' attribute."
            )
    if tag == "link":
        link = target.get("name", "")
    for child in source:
        name = etree.QName(child)
        if name.localname not in _CHILDREN.get(tag, ()) or name.namespace != namespace:
            continue
        copy = etree.SubElement(target, name.localname)
        _copy(child, copy, document, namespace, link)
        if name.localname in ("visual", "collision"):
            reason = _no_geometry(child, copy)
            if reason:
                target.remove(copy)
                document.missing.append(MissingShape(link, "", reason, name.localname))
    for name in _REQUIRED_CHILDREN.get(tag, ()):
        if target.find(name) is None:
            raise RobotDescriptionError(
                f"Line {source.sourceline}: <{tag}> '{target.get('name')}' has no <{name}>."
            )


def _no_geometry(source: etree._Element, copy: etree._Element) -> str:
    """Return why a visual or collision cannot be drawn, "" if it can.

    As in urdfdom the first of several geometries counts.
    """
    geometry = copy.find("geometry")
    line = f"Line {source.sourceline}: <{copy.tag}>"
    if geometry is None:
        return f"{line} has no <geometry>."
    if len(geometry) == 0:
        names = [etree.QName(each).localname for each in source.iterfind("{*}geometry/*")]
        what = f"<{names[0]}>, which is not a geometry of URDF" if names else "nothing"
        return f"{line} has a <geometry> with {what}."
    if geometry[0].tag == "mesh" and not geometry[0].get("filename"):
        return f"{line} has a <mesh> without a file name."
    return ""


def _numbers(
    source: etree._Element, tag: str, name: str, value: str, counts: tuple[int, ...]
) -> str:
    """Return the attribute's numbers as clean text."""
    where = f"Line {source.sourceline}: {name}='{value[:80]}' of <{tag}>"
    words = value.split()
    if len(words) not in counts:
        expected = " or ".join(map(str, counts))
        raise RobotDescriptionError(f"{where}: expected {expected} numbers, got {len(words)}.")
    try:
        numbers = [float(word) for word in words]
    except ValueError:
        raise RobotDescriptionError(f"{where} is not a number.") from None
    if tag != "limit" and not all(abs(number) <= _LARGEST for number in numbers):
        raise RobotDescriptionError(f"{where} is not finite, or larger than {_LARGEST:g}.")
    return " ".join(map(repr, numbers))
