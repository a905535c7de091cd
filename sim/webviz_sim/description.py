"""What robot_state_publisher needs of a URDF: its joints and the transforms they make."""

import math
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]
"""x, y, z, w."""


class Transform(NamedTuple):
    """A frame in its parent's frame: metres, and a unit quaternion (x, y, z, w)."""

    parent: str
    child: str
    translation: Vector
    rotation: Quaternion


class Joint(NamedTuple):
    """One joint of a URDF."""

    name: str
    kind: str
    parent: str
    child: str
    translation: Vector
    rotation: Quaternion
    axis: Vector

    def transform(self, angle: float = 0.0) -> Transform:
        """The child link in the parent link's frame when the joint is turned by an angle."""
        sin = math.sin(0.5 * angle)
        x, y, z = self.axis
        turn = (x * sin, y * sin, z * sin, math.cos(0.5 * angle))
        rotation = _multiply(self.rotation, turn)
        return Transform(self.parent, self.child, self.translation, rotation)


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
            rotation=from_euler(*_vector(origin, "rpy", (0.0, 0.0, 0.0))),
            axis=_vector(element.find("axis"), "xyz", (1.0, 0.0, 0.0)),
        )
        joints.append(joint)
    return joints


def from_euler(roll: float, pitch: float, yaw: float) -> Quaternion:
    """The rotation that URDF's rpy means: about the fixed axes x, then y, then z."""
    about_x = (math.sin(roll / 2), 0.0, 0.0, math.cos(roll / 2))
    about_y = (0.0, math.sin(pitch / 2), 0.0, math.cos(pitch / 2))
    about_z = (0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2))
    return _multiply(about_z, _multiply(about_y, about_x))


def _multiply(a: Quaternion, b: Quaternion) -> Quaternion:
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


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
