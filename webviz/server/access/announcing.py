"""The addresses of the viewers of this user that run and ask for tokens, for `webviz token`."""

from __future__ import annotations

import contextlib
import logging
import os
import socket
from collections.abc import Sequence
from pathlib import Path
from urllib.parse import urlsplit

from webviz.data.locks import lock
from webviz.server.access import token_file
from webviz.server.access.starting import is_local

EVERY_INTERFACE = ("", "0.0.0.0", "::")
MAX_BYTES = 1000
"""Limit in bytes of a file with an address."""

log = logging.getLogger("webviz")


class Announcement:
    """A file with the address of a viewer, locked while it runs, however it ends.

    Args:
        url: of the page.
        port: of the viewer.
        folder: of all such files.
    """

    def __init__(self, url: str, port: int, folder: Path | None = None) -> None:
        self._path = (folder or _folder()) / f"{os.getpid()}-{port}"
        self._lock: int | None = None
        try:
            self._path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
            flags = os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_NOFOLLOW | os.O_CLOEXEC
            self._lock = os.open(self._path, flags, 0o600)
            lock(self._lock)
            os.write(self._lock, url.encode())
        except OSError as error:
            log.warning("`webviz token` does not know this viewer: %s.", error.strerror)

    def close(self) -> None:
        """Withdraw it."""
        if self._lock is not None:
            self._path.unlink(missing_ok=True)
            os.close(self._lock)
            self._lock = None


def announced(folder: Path | None = None) -> list[str]:
    """Return the addresses of viewers that run, sorted."""
    with contextlib.suppress(OSError):
        return sorted(filter(None, map(_read, (folder or _folder()).iterdir())))
    return []


def _read(path: Path) -> str:
    """Return the address in a file, "" if its viewer has ended, upon which it is removed."""
    try:
        with path.open("rb") as file:
            try:
                has_ended = lock(file.fileno(), shared=True)
            except BlockingIOError:
                has_ended = False
            if not has_ended:
                return file.read(MAX_BYTES).decode()
            path.unlink(missing_ok=True)
    except (OSError, UnicodeDecodeError):
        pass
    return ""


def _folder() -> Path:
    return token_file.standard_path().parent / "viewers"


def reachable(url: str, host: str, names: Sequence[str]) -> str:
    """Return the address of the page for other machines, if they reach it; else `url`.

    Args:
        url: of the page for this machine.
        host: address that the viewer listens on.
        names: that it may be addressed by.
    """
    if is_local(host):
        return url
    address = names[0] if names else host
    if address in EVERY_INTERFACE:
        address = next(iter(_own_addresses()), socket.gethostname())
    parts = urlsplit(url)
    host_text = f"[{address}]" if ":" in address else address
    return parts._replace(netloc=f"{host_text}:{parts.port}").geturl()


def _own_addresses() -> list[str]:
    """Return the IPv4 addresses of this machine in networks."""
    import psutil  # here, as it would slow down the start

    return [
        address.address
        for addresses in psutil.net_if_addrs().values()
        for address in addresses
        if address.family == socket.AF_INET and not address.address.startswith("127.")
    ]
