"""Definitions of message types of a ROS workspace that is not built, from its .msg files.

They are looked for when nothing else knows a type: in packages below the current folder, as in
`src` of a workspace, and beside the folders of COLCON_PREFIX_PATH.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

from webviz.data.messages import typestore
from webviz.data.messages.decode import register
from webviz.data.messages.errors import DefinitionError

DEPTHS = ("", "*/", "*/*/", "src/*/*/")
"""Folders of packages: `src` of a workspace, repositories in it, and their folders."""


def learn(type_name: str) -> None:
    """Register a message type from its .msg file, with the types that it contains.

    Args:
        type_name: full name of a type that is unknown, such as "my_msgs/msg/Wheel"; services and
            actions are ignored.

    Raises:
        DefinitionError: the file cannot be read, or is invalid.
    """
    package, kind, name = type_name.split("/")
    if kind != "msg" or typestore.type_exists(type_name):
        return
    path = next((each for each in _files(package, name) if each.is_file()), None)
    if path is None:
        return
    try:
        with path.open(encoding="utf-8") as file:
            text = file.read(typestore.MAX_TEXT + 1)
    except (OSError, UnicodeDecodeError) as error:
        raise DefinitionError(f"{path} cannot be read: {error}.") from error
    for each in typestore.fields_in(type_name, text):
        if each.is_message and each.base != type_name and not typestore.type_exists(each.base):
            typestore.find(each.base)
    register(type_name, text)


def _files(package: str, name: str) -> Iterator[Path]:
    """Paths at which the definition may be, of packages that are in folders of their name."""
    here = Path.cwd()
    if here.name == package and (here / "package.xml").is_file():
        yield here / "msg" / f"{name}.msg"
    prefixes = filter(None, os.environ.get("COLCON_PREFIX_PATH", "").split(os.pathsep))
    for workspace in (here, *(Path(prefix).parent for prefix in prefixes)):
        for depth in DEPTHS:
            for package_file in workspace.glob(f"{depth}{package}/package.xml"):
                yield package_file.parent / "msg" / f"{name}.msg"
