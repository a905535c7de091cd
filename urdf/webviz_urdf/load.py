"""Loading of a robot from its description and the files it names."""

from __future__ import annotations

import codecs
import re
from collections.abc import Mapping
from pathlib import Path, PurePosixPath
from types import MappingProxyType

from webviz_urdf.build import build_robot
from webviz_urdf.description import parse_description
from webviz_urdf.expand import expand
from webviz_urdf.files import read_file
from webviz_urdf.glb import MeshContent, PictureFile
from webviz_urdf.loading import LoadRequest
from webviz_urdf.meshes import MeshError, parse_mesh, read_mesh
from webviz_urdf.resolve import ResolveError, Resolver
from webviz_urdf.robot import Progress, Robot, RobotDescriptionError
from webviz_urdf.textures import TextureError, encode, open_image, parse_image

MAX_BYTES = 16 << 20
"""Limit in bytes of a file with a description."""
_MARKS = {
    codecs.BOM_UTF8: "utf-8-sig",
    codecs.BOM_UTF16_LE: "utf-16",
    codecs.BOM_UTF16_BE: "utf-16",
}
_DECLARATION = re.compile(rb"""<\?xml[^>]{0,100}?\sencoding\s*=\s*["']([A-Za-z][\w.-]{0,40})["']""")


def load_robot(
    description: str,
    resolver: Resolver,
    progress: Progress | None = None,
    collisions: bool = True,
    skip: Mapping[int, str] = MappingProxyType({}),
) -> Robot:
    """Load a robot from URDF text; shapes that cannot be read are listed in `Robot.missing`.

    Args:
        description: URDF, xacro already expanded.
        resolver: finds meshes and textures.
        progress: called before each shape and once at the end.
        collisions: whether to read collision shapes.
        skip: reasons for skipping shapes, by their numbers as passed to `progress`.

    Raises:
        RobotDescriptionError: the text is not a robot; one sentence says why.
    """
    return build_robot(parse_description(description), resolver, progress, collisions, skip)


def load_file(
    path: str | Path,
    resolver: Resolver | None = None,
    progress: Progress | None = None,
    collisions: bool = True,
    skip: Mapping[int, str] = MappingProxyType({}),
) -> Robot:
    """Load a robot from a URDF file, or a xacro file if that is allowed (`webviz_urdf.expand`).

    Raises:
        RobotDescriptionError: the file cannot be read, expanded or parsed.
    """
    path = Path(path)
    text = _read(path)
    if path.suffix.lower() == ".xacro":
        text = expand(path)
    resolver = (resolver or Resolver()).relative_to(path.absolute().parent)
    return load_robot(text, resolver, progress, collisions, skip)


def load_asset(request: LoadRequest, resolver: Resolver) -> MeshContent | PictureFile:
    """Load a mesh or a picture.

    Raises:
        RobotDescriptionError: it cannot be drawn; one sentence says why.
    """
    name = request.mesh or request.picture
    try:
        path = Path("/", PurePosixPath(name).name) if request.data else resolver.resolve(name)
        if request.mesh:
            # What came in a message may name no files of this machine.
            if request.data:
                return parse_mesh(request.data, path, Resolver(roots=(), ament_prefix_path=""))
            return read_mesh(path, resolver)
        image = parse_image(request.data, path) if request.data else open_image(path)
        return PictureFile(encode(image))
    except (ResolveError, MeshError, TextureError) as error:
        raise RobotDescriptionError(str(error)) from error


def _read(path: Path) -> str:
    try:
        data = read_file(path, MAX_BYTES)
        encoding = _encoding_of(data)
        return data.decode(encoding)
    except OSError as error:
        raise RobotDescriptionError(f"{path} cannot be read: {error.strerror}.") from error
    except UnicodeDecodeError as error:
        raise RobotDescriptionError(
            f"{path} is not {error.encoding} text: {error.reason}."
        ) from error
    except LookupError as error:
        raise RobotDescriptionError(
            f"{path} declares an encoding that is unknown: {error}."
        ) from error
    except ValueError as error:
        raise RobotDescriptionError(f"{str(path)!r} is not a usable path: {error}.") from error


def _encoding_of(data: bytes) -> str:
    """Return the encoding of an XML file, by its first bytes or its declaration (XML 1.0, F)."""
    for mark, encoding in _MARKS.items():
        if data.startswith(mark):
            return encoding
    declared = _DECLARATION.match(data)
    return declared[1].decode("ascii") if declared else "utf-8"
