"""Places of the meshes and textures of a robot description on this machine.

A description names its files as `package://` URIs, `file://` URIs or plain paths. Nothing is ever
fetched from a network: otherwise any publisher could make this machine send requests.
"""

from __future__ import annotations

import copy
import os
import re
from collections.abc import Iterator, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlsplit

from webviz_urdf.files import read_file

_SKIPPED_FOLDERS = {"build", "install", "log", "node_modules", "__pycache__"}
_PACKAGE_NAME = re.compile(rb"<name>\s*([^<\s]+)\s*</name>")
_PACKAGE_XML_BYTES = 1 << 20
_LONGEST = 4096  # characters of a path on Linux


class ResolveError(Exception):
    """A URI cannot be resolved to a file; the text is one sentence that says why."""


class Resolver:
    """Finds the files that a robot description names, in ROS packages and mesh roots only.

    A `package://` URI is looked up below the mesh roots and package paths first, then on
    AMENT_PREFIX_PATH, then in the folders above the description's own file. A file is opened if,
    with all symbolic links followed, it lies in a mesh root or in a ROS package: that of the URI,
    or one found in those places, with its `package.xml` above the file. Links of
    `colcon build --symlink-install` lead into such a package.

    Args:
        roots: mesh roots, folders in which the user allows every file; by default those of the
            environment variable `MESH_ROOT`.
        ament_prefix_path: prefixes separated by `os.pathsep`; by default the environment's.
        base: folder of the description's file, to which paths are relative.
        package_paths: folders in which packages are searched, by their `package.xml`, at most
            `MAX_DEPTH` folders deep, as they are in mesh roots.
    """

    MAX_DEPTH = 6
    MESH_ROOT = "WEBVIZ_MESH_ROOT"

    def __init__(
        self,
        roots: Sequence[str | Path] | None = None,
        ament_prefix_path: str | None = None,
        base: str | Path | None = None,
        package_paths: Sequence[str | Path] = (),
    ) -> None:
        if roots is None:
            roots = [*filter(None, os.environ.get(self.MESH_ROOT, "").split(os.pathsep))]
        self.roots = tuple(Path(root).expanduser().absolute() for root in roots)
        self.package_paths = tuple(Path(path).expanduser().absolute() for path in package_paths)
        if ament_prefix_path is None:
            ament_prefix_path = os.environ.get("AMENT_PREFIX_PATH", "")
        self.ament_prefix_path = ament_prefix_path
        self.base = None if base is None else Path(base).absolute()
        self._folders: dict[str, list[Path]] = {}

    def relative_to(self, base: str | Path) -> Resolver:
        """Return the same resolver for a description in the folder `base`."""
        return self._with(base=Path(base).absolute())

    def with_root(self, root: Path) -> Resolver:
        """Return the same resolver with one more root."""
        return self._with(roots=(*self.roots, root))

    def _with(self, **changed: Any) -> Resolver:
        resolver = copy.copy(self)
        vars(resolver).update(changed, _folders={})  # what was not there may be now
        return resolver

    def resolve(self, uri: str) -> Path:
        """Return the file that `uri` names.

        Raises:
            ResolveError: there is none, or webviz may not open it.
        """
        try:
            return self._resolve(uri.strip())
        except (OSError, ValueError) as error:  # a name too long, a null byte, a bad [host]
            raise ResolveError(f"'{uri[:200]}' is not a usable path ({error}).") from error

    def _resolve(self, uri: str) -> Path:
        if not uri:
            raise ResolveError("The file name is empty.")
        if len(uri) > _LONGEST:
            raise ValueError("it is too long")
        scheme, separator, rest = uri.partition("://")
        if not separator:
            return self._plain(uri)
        if scheme == "package":
            return self._package(rest)
        if scheme == "file":
            parts = urlsplit(uri)
            host = "" if parts.netloc == "localhost" else parts.netloc
            return self._allowed(Path("/", host + uri.partition("://")[2][len(parts.netloc) :]))
        if scheme in ("http", "https", "ftp"):
            raise ResolveError(
                f"'{uri}' is on a network, and webviz reads files of this machine only. "
                "Download it and use package:// or file://."
            )
        raise ResolveError(f"'{uri}' is unsupported. Use package:// or file://.")

    def _plain(self, path: str) -> Path:
        if os.path.isabs(path):
            return self._allowed(Path(path))
        if self.base is None:
            raise ResolveError(
                f"'{path}' is a relative path, but a description from a topic has no folder. "
                "Use package:// or file://."
            )
        return self._allowed(self.base / path)

    def _package(self, rest: str) -> Path:
        # Some public files have a third slash: package:///name/mesh.stl.
        package, _, path = rest.lstrip("/").partition("/")
        for text in dict.fromkeys((path, unquote(path))):
            if os.path.isabs(text) or os.path.normpath(text).split(os.sep)[0] == "..":
                raise ResolveError(f"'package://{rest}' leaves its package by '..'.")
        folders = self._package_folders(package) if package.strip(".") else []
        if not folders:
            raise ResolveError(
                f"Package '{package}' is neither on AMENT_PREFIX_PATH nor below a mesh root or "
                "package path. Source its workspace before starting webviz, or add its folder with "
                "--mesh-root."
            )
        reasons = []
        for folder in folders:
            try:
                return self._allowed(folder / path, folder)
            except ResolveError as error:
                reasons.append(str(error))
        raise ResolveError(reasons[0])

    def _allowed(self, path: Path, package: Path | None = None) -> Path:
        """`path`, unchanged or with %20 decoded, if it is a file that may be opened."""
        refused = None
        for candidate in (path, Path(unquote(str(path)))):
            target = candidate.resolve()
            if not self._may_open(target, package):
                refused = refused or (candidate, target)
            elif target.is_file():
                return candidate
        if refused is None:
            raise ResolveError(f"{path} does not exist.")
        # The sender must not learn whether it exists.
        candidate, target = refused
        link = "" if target == Path(os.path.normpath(candidate)) else f", a link to {target},"
        raise ResolveError(
            f"{candidate}{link} is outside all ROS packages and mesh roots. "
            f"Start webviz with --mesh-root {target.parent} to allow it."
        )

    def _may_open(self, target: Path, package: Path | None) -> bool:
        trusted = (*self.roots, *((package,) if package else ()))
        if any(target.is_relative_to(folder.resolve()) for folder in trusted):
            return True
        names = (_package_name(folder) for folder in target.parents)
        name = next(filter(None, names), None)
        return name is not None and bool(self._package_folders(name))

    def _package_folders(self, package: str) -> list[Path]:
        """Return the folders of a package, looked for once: a robot has dozens of meshes in it."""
        if package not in self._folders:
            self._folders[package] = list(dict.fromkeys(self._look_for(package)))
        return self._folders[package]

    def _look_for(self, package: str) -> Iterator[Path]:
        yield from self._packages_below.get(package, ())
        for root in self.roots:
            for folder in (root, root / package):
                if folder.name == package and folder.is_dir():
                    yield folder
        for prefix in filter(None, self.ament_prefix_path.split(os.pathsep)):
            share = Path(prefix, "share", package)
            if share.is_dir():
                yield share
        if self.base is not None:
            for folder in (self.base, *self.base.parents):
                if _package_name(folder) == package:
                    yield folder
                if (folder / package / "package.xml").is_file():
                    yield folder / package
        if package == __package__:  # the demo robot, wherever webviz is installed
            yield Path(__file__).parent

    @cached_property
    def _packages_below(self) -> dict[str, list[Path]]:
        packages: dict[str, list[Path]] = {}
        for root in (*self.roots, *self.package_paths):
            for folder in _walk(root, self.MAX_DEPTH):
                name = _package_name(folder)
                if name is not None:
                    packages.setdefault(name, []).append(folder)
        return packages


def _walk(root: Path, depth: int) -> Iterator[Path]:
    """Folders from `root` down; as in colcon, a package is not searched for packages."""
    for folder, children, files in os.walk(root):
        path = Path(folder)
        yield path
        too_deep = len(path.relative_to(root).parts) >= depth
        is_package = "package.xml" in files
        if too_deep or is_package:
            children.clear()
        children[:] = sorted(c for c in children if c[0] != "." and c not in _SKIPPED_FOLDERS)


def _package_name(folder: Path) -> str | None:
    """Return the name in the folder's `package.xml`, None without one."""
    try:
        text = read_file(folder / "package.xml", _PACKAGE_XML_BYTES)
    except OSError:
        return None
    match = _PACKAGE_NAME.search(text)
    return match[1].decode(errors="replace") if match else None
