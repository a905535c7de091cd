"""Fetches the meshes and textures that this machine lacks from the robot, through a bridge."""

from __future__ import annotations

import atexit
import contextlib
import functools
import posixpath
import re
import shutil
import tempfile
import threading
from collections.abc import Iterator, Sequence
from concurrent.futures import Future, wait
from pathlib import Path

from webviz.data.assets import Fetch, fetches
from webviz_urdf.resolve import ResolveError, Resolver

MAX_FILES = 500
"""Largest number of files of one robot."""
MAX_BYTES = 500_000_000
"""Limit in bytes of all files that are fetched while the program runs."""
TIMEOUT_S = 60.0
"""Time in seconds for the files of one robot."""
_URI = re.compile(r"package://([A-Za-z]\w*)/([^\s\"'<>?#|*:\\]{1,300})", re.ASCII)
_INSIDE = {
    ".dae": re.compile(rb"<init_from>\s*([^<>\s]{1,200})\s*</init_from>"),
    ".obj": re.compile(rb"^mtllib[ \t]+(\S{1,200})", re.MULTILINE),
    ".mtl": re.compile(rb"^map_Kd[ \t]+(\S{1,200})", re.MULTILINE),
}
"""Names of further files in a file, relative to it."""

_lock = threading.Lock()
_sizes: dict[Path, int] = {}


def with_remote_files(text: str, resolver: Resolver) -> Resolver:
    """Fetch the files that a description names and that are not on this machine.

    Args:
        text: URDF, or the URI of a file.
        resolver: of this machine.

    Returns:
        A resolver that also finds what was fetched; the same without a bridge.
    """
    sources = fetches()
    if not sources:
        return resolver
    uris = list(dict.fromkeys(_URI.findall(text)))[:MAX_FILES]
    missing = [uri for uri in uris if not _is_here(resolver, *uri)]
    for _ in range(3):  # a mesh, its materials, their pictures
        missing = _fetch_all(missing, sources)
    return resolver.with_root(folder())


def _fetch_all(uris: Sequence[tuple[str, str]], sources: Sequence[Fetch]) -> list[tuple[str, str]]:
    """Fetch files, and return the further ones that they name."""
    pending: dict[tuple[str, str], list[Future[bytes]]] = {
        uri: [fetch("package://{}/{}".format(*uri)) for fetch in sources]
        for uri in uris[:MAX_FILES]
        if _target(*uri) is not None and not _is_kept(*uri)
    }
    wait([each for answers in pending.values() for each in answers], TIMEOUT_S)
    named: dict[tuple[str, str], None] = {}
    for uri, answers in pending.items():
        for answer in answers:
            if answer.done() and not answer.exception() and _keep(*uri, answer.result()):
                named |= dict.fromkeys(_named(*uri, answer.result()))
                break
    return list(named)


def _named(package: str, path: str, data: bytes) -> Iterator[tuple[str, str]]:
    """Yield the files that a file names."""
    pattern = _INSIDE.get(posixpath.splitext(path)[1].lower())
    for name in pattern.findall(data[: 64 << 20]) if pattern else ():
        with contextlib.suppress(UnicodeDecodeError):
            yield package, posixpath.join(posixpath.dirname(path), name.decode())


def _keep(package: str, path: str, data: bytes) -> bool:
    """Write a file to the folder, if there is room; whether there is."""
    target = _target(package, path)
    with _lock:
        if target is None or sum(_sizes.values()) + len(data) > MAX_BYTES:
            return False
        _sizes[target] = len(data)
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_bytes(data)
    return True


def _is_kept(package: str, path: str) -> bool:
    return _target(package, path) in _sizes


def _is_here(resolver: Resolver, package: str, path: str) -> bool:
    try:
        resolver.resolve(f"package://{package}/{path}")
    except ResolveError:
        return False
    return True


def _target(package: str, path: str) -> Path | None:
    """Return where a file is kept, None if its path leaves the package."""
    inside = posixpath.normpath(path)
    if inside.startswith(("/", "..")) or inside == "." or not package.isidentifier():
        return None
    return folder() / package / inside


@functools.cache
def folder() -> Path:
    """Return the folder of fetched files, which is removed at the end of the program."""
    path = Path(tempfile.mkdtemp(prefix="webviz-robot-files-"))
    atexit.register(shutil.rmtree, path, ignore_errors=True)
    return path
