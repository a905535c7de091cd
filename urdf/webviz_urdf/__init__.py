"""Robot descriptions: URDF and meshes as plain data that a viewer can draw."""

from webviz_urdf.build import Progress
from webviz_urdf.glb import glb_with
from webviz_urdf.inertia import inertia_box, mass_sphere
from webviz_urdf.load import load_file, load_robot
from webviz_urdf.loading import Loading, LoadingStopped, LoadRequest
from webviz_urdf.resolve import ResolveError, Resolver
from webviz_urdf.robot import Inertial, Joint, Link, Missing, Robot, RobotDescriptionError, Shape

__all__ = [
    "Inertial",
    "Joint",
    "Link",
    "LoadRequest",
    "Loading",
    "LoadingStopped",
    "Missing",
    "Progress",
    "ResolveError",
    "Resolver",
    "Robot",
    "RobotDescriptionError",
    "Shape",
    "glb_with",
    "inertia_box",
    "load_file",
    "load_robot",
    "mass_sphere",
]
