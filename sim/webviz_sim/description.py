"""The joints of a URDF and their transforms, as robot_state_publisher has them."""

from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

from webviz.data.messages import FrameTransform
from webviz.data.rotations import Quaternion, Vector, from_axis_angle, from_rpy, multiply, w_last
from webviz_sim.world import WorldError

WHEEL_JOINTS = ("wheel_left_joint", "wheel_right_joint")
SCANNER = "base_scan"


class JointOfDescription(NamedTuple):
    """One joint of a URDF; its rotation has w first."""

    name: str
    kind: str
    parent: str
    child: str
    translation: Vector
    rotation: Quaternion
    axis: Vector

    def transform(self, stamp_ns: int, angle: float = 0.0) -> FrameTransform:
        """Return the pose of the child link in the parent's frame with the joint at `angle` rad."""
        rotation = multiply(self.rotation, from_axis_angle(self.axis, angle))
        return FrameTransform(self.parent, self.child, stamp_ns, self.translation, w_last(rotation))


def demo_description() -> str:
    """Return the bundled robot's URDF.

    It is found without importing webviz_urdf, which takes long.
    """
    spec = find_spec("webviz_urdf")
    assert spec is not None  # one distribution contains both
    assert spec.submodule_search_locations is not None
    [folder] = spec.submodule_search_locations
    return (Path(folder) / "demo" / "robot.urdf").read_text()


def read_robot(path: str) -> str:
    """Return the text of a URDF that has what the simulator moves.

    Raises:
        WorldError: it cannot be read, or lacks a joint.
    """
    try:
        text = Path(path).read_text()
        joints = read_joints(text)
    except OSError as error:
        raise WorldError(f"Cannot read the robot {path}: {error.strerror}.") from None
    except (ElementTree.ParseError, ValueError, KeyError):
        raise WorldError(f"The robot {path} is not a valid URDF.") from None
    names = {joint.name for joint in joints} | {joint.child for joint in joints}
    if missing := sorted({*WHEEL_JOINTS, SCANNER} - names):
        raise WorldError(
            f"The robot {path} lacks {' and '.join(missing)}, which the simulator moves."
        )
    return text


def read_joints(urdf: str) -> list[JointOfDescription]:
    """Return the joints of a URDF in document order."""
    return [
        JointOfDescription(
            element.attrib["name"],
            element.attrib["type"],
            parent=_attribute(element, "parent", "link"),
            child=_attribute(element, "child", "link"),
            translation=_vector(_attribute(element, "origin", "xyz", "0 0 0")),
            rotation=from_rpy(*_vector(_attribute(element, "origin", "rpy", "0 0 0"))),
            axis=_vector(_attribute(element, "axis", "xyz", "1 0 0")),
        )
        for element in ElementTree.fromstring(urdf).iterfind("joint")
    ]


def _attribute(joint: ElementTree.Element, tag: str, key: str, default: str = "") -> str:
    element = joint.find(tag)
    return default if element is None else element.get(key, default)


def _vector(text: str) -> Vector:
    x, y, z = map(float, text.split())
    return x, y, z
