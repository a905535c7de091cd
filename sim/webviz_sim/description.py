"""What robot_state_publisher needs of a URDF: its joints and the transforms they make."""

from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

from webviz.data.rotations import Quaternion, Vector, from_axis_angle, from_rpy, multiply, w_last


class Transform(NamedTuple):
    """A frame in its parent's frame: metres, and a unit quaternion (x, y, z, w)."""

    parent: str
    child: str
    translation: Vector
    rotation: Quaternion


class Joint(NamedTuple):
    """One joint of a URDF; its rotation has w first."""

    name: str
    kind: str
    parent: str
    child: str
    translation: Vector
    rotation: Quaternion
    axis: Vector

    def transform(self, angle: float = 0.0) -> Transform:
        """The child link in the parent link's frame when the joint is turned by an angle."""
        rotation = multiply(self.rotation, from_axis_angle(self.axis, angle))
        return Transform(self.parent, self.child, self.translation, w_last(rotation))


def demo_description() -> str:
    """The bundled robot's URDF.

    Found beside the package webviz_urdf without importing it: the simulator needs the file only.
    """
    spec = find_spec("webviz_urdf")
    assert spec is not None  # one distribution contains both
    assert spec.submodule_search_locations is not None
    [folder] = spec.submodule_search_locations
    return (Path(folder) / "demo" / "robot.urdf").read_text()


def read_joints(urdf: str) -> list[Joint]:
    """The joints of a URDF in document order."""
    joints = []
    for element in ElementTree.fromstring(urdf).iterfind("joint"):
        origin = element.find("origin")
        joint = Joint(
            element.attrib["name"],
            element.attrib["type"],
            parent=_link(element, "parent"),
            child=_link(element, "child"),
            translation=_vector(origin, "xyz", (0.0, 0.0, 0.0)),
            rotation=from_rpy(*_vector(origin, "rpy", (0.0, 0.0, 0.0))),
            axis=_vector(element.find("axis"), "xyz", (1.0, 0.0, 0.0)),
        )
        joints.append(joint)
    return joints


def _link(joint: ElementTree.Element, tag: str) -> str:
    element = joint.find(tag)
    assert element is not None, f"a URDF joint without {tag}"
    return element.attrib["link"]


def _vector(element: ElementTree.Element | None, key: str, default: Vector) -> Vector:
    text = None if element is None else element.get(key)
    if text is None:
        return default
    x, y, z = map(float, text.split())
    return x, y, z
