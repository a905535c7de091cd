"""Loading a robot description beside the frame loop."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from webviz_urdf import Resolver, Robot, load_file, load_robot


class Loading:
    """How far the loading of a robot is; written by a worker, read by the frame loop."""

    def __init__(self) -> None:
        self._at = (0, 0, "")

    def __call__(self, done: int, total: int, link: str) -> None:
        """Note the shapes done, their total and the link at work."""
        self._at = (done, total, link)

    @property
    def text(self) -> str:
        """For a status."""
        done, total, link = self._at
        return f"Loading: {done} of {total} shapes, at link '{link}'." if total else "Loading."


@dataclass(frozen=True)
class Description:
    """A robot description and where to find its meshes; equal ones need not be loaded again.

    Args:
        text: URDF, if it came as a message.
        path: of the file, if it did not.
        changed_ns: when the file was last written, 0 if it cannot be told.
        package_paths: folders that hold ROS packages.
    """

    text: str = ""
    path: str = ""
    changed_ns: int = 0
    package_paths: tuple[str, ...] = ()

    def load(self, collisions: bool, loading: Loading) -> Robot:
        """The robot.

        Raises:
            RobotDescriptionError: it cannot be drawn; one sentence says why.
        """
        resolver = Resolver(self.package_paths)
        if self.path:
            return load_file(Path(self.path).expanduser(), resolver, loading, collisions)
        return load_robot(self.text, resolver, loading, collisions)


def describe_file(path: str, package_paths: tuple[str, ...]) -> Description:
    """The description in a file as it is now."""
    try:
        changed_ns = Path(path).expanduser().stat().st_mtime_ns
    except OSError:
        changed_ns = 0  # loading will say what is wrong
    return Description(path=path, changed_ns=changed_ns, package_paths=package_paths)
