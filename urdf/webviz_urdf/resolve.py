"""Where a mesh or texture of a robot description lies on this machine.

A description names its files as `package://` URIs, `file://` URIs or plain paths. Nothing is ever
fetched from a network: a viewer that follows a URL found in a message would let any publisher make
this machine call out.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Sequence
from functools import cached_property
from pathlib import Path
from urllib.parse import unquote, urlsplit

_SKIPPED_FOLDERS = {"build", "install", "log", "node_modules", "__pycache__"}
_PACKAGE_NAME = re.compile(r"<name>\s*([^<\s]+)\s*</name>")


class ResolveError(Exception):
    """A URI leads to no file; the text is one sentence that says why."""


class Resolver:
    """Finds the files that a robot description names.

    A `package://` URI is looked up in the user's roots first, then on AMENT_PREFIX_PATH, then in
    the folders above the description's own file. Its path may not leave the package by `..`, but
    symbolic links are followed, since `colcon build --symlink-install` makes packages of them.
    `file://` URIs and absolute paths may name any file that the user may read: a description is
    trusted to choose what is *read as a mesh*, and nothing but triangles leaves the process.

    Args:
        roots: folders given by the user: a package, or anything that holds packages
            (a `package.xml` is searched below, at most `MAX_DEPTH` folders deep).
        ament_prefix_path: prefixes separated by `os.pathsep`; by default the environment's.
        base: folder that relative paths begin at, that of the description's file.
    """

    MAX_DEPTH = 6

    def __init__(
        self,
        roots: Sequence[str | Path] = (),
        ament_prefix_path: str | None = None,
        base: str | Path | None = None,
    ) -> None:
        self.roots = tuple(Path(root).expanduser().absolute() for root in roots)
        if ament_prefix_path is None:
            ament_prefix_path = os.environ.get("AMENT_PREFIX_PATH", "")
        self.ament_prefix_path = ament_prefix_path
        self.base = None if base is None else Path(base).absolute()

    def relative_to(self, base: str | Path) -> Resolver:
        """The same resolver for a description that lies in the folder `base`."""
        return Resolver(self.roots, self.ament_prefix_path, base)

    def resolve(self, uri: str) -> Path:
        """The file that `uri` names.

        Raises:
            ResolveError: it names none, or one that the viewer refuses to open.
        """
        try:
            return self._resolve(uri.strip())
        except (OSError, ValueError) as error:  # a name too long, a null byte, a bad [host]
            raise ResolveError(f"'{uri[:200]}' is not a usable path ({error}).") from error

    def _resolve(self, uri: str) -> Path:
        if not uri:
            raise ResolveError("The file name is empty.")
        scheme, separator, rest = uri.partition("://")
        if not separator:
            return self._plain(uri)
        if scheme == "package":
            return self._package(rest)
        if scheme == "file":
            parts = urlsplit(uri)
            host = "" if parts.netloc == "localhost" else parts.netloc
            return _existing(Path("/", host + uri.partition("://")[2][len(parts.netloc) :]))
        if scheme in ("http", "https", "ftp"):
            raise ResolveError(
                f"'{uri}' lies on a network, and the viewer reads files of this machine only: "
                "download it and name it by package:// or file://."
            )
        raise ResolveError(f"'{uri}' begins with {scheme}://, which is not package:// or file://.")

    def _plain(self, path: str) -> Path:
        if os.path.isabs(path):
            return _existing(Path(path))
        if self.base is None:
            raise ResolveError(
                f"'{path}' is a relative path, and a description that came by topic has no folder "
                "to begin at: name it by package:// or file://."
            )
        return _existing(self.base / path)

    def _package(self, rest: str) -> Path:
        # Some files in the wild have a third slash: package:///name/mesh.stl.
        package, _, path = rest.lstrip("/").partition("/")
        for text in dict.fromkeys((path, unquote(path))):
            if os.path.isabs(text) or os.path.normpath(text).split(os.sep)[0] == "..":
                raise ResolveError(f"'package://{rest}' leaves its package by '..'.")
        folders = list(dict.fromkeys(self._package_folders(package))) if package.strip(".") else []
        if not folders:
            raise ResolveError(
                f"Package '{package}' is neither on AMENT_PREFIX_PATH nor below the given package "
                "folders: source its workspace before starting, or give the folder it lies in."
            )
        reasons = []
        for folder in folders:
            try:
                return _existing(folder / path)
            except ResolveError as error:
                reasons.append(str(error))
        raise ResolveError(reasons[0])

    def _package_folders(self, package: str) -> Iterator[Path]:
        yield from self._packages_below_roots.get(package, ())
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
                if folder.name == package or _package_name(folder) == package:
                    yield folder
                if (folder / package / "package.xml").is_file():
                    yield folder / package
        if package == __package__:  # the demo robot, wherever webviz is installed
            yield Path(__file__).parent

    @cached_property
    def _packages_below_roots(self) -> dict[str, list[Path]]:
        packages: dict[str, list[Path]] = {}
        for root in self.roots:
            for folder in _walk(root, self.MAX_DEPTH):
                name = _package_name(folder)
                if name is not None:
                    packages.setdefault(name, []).append(folder)
        return packages


def _walk(root: Path, depth: int) -> Iterator[Path]:
    """Folders from `root` down; a package is not searched for packages, as colcon has it."""
    for folder, children, files in os.walk(root):
        path = Path(folder)
        yield path
        too_deep = len(path.relative_to(root).parts) >= depth
        is_package = "package.xml" in files
        if too_deep or is_package:
            children.clear()
        children[:] = sorted(c for c in children if c[0] != "." and c not in _SKIPPED_FOLDERS)


def _package_name(folder: Path) -> str | None:
    """The name in the folder's `package.xml`, None without one."""
    try:
        text = (folder / "package.xml").read_text(encoding="utf-8", errors="replace")
    except OSError:
        return None
    match = _PACKAGE_NAME.search(text)
    return match[1] if match else None


def _existing(path: Path) -> Path:
    """`path` as it stands or with its %20 decoded, whichever is a file."""
    for candidate in (path, Path(unquote(str(path)))):
        if candidate.is_file():
            return candidate
    raise ResolveError(f"There is no file {path}.")
