"""Addresses of bridges, and the headers that are sent to them."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from urllib.parse import urlsplit

from webviz.api.errors import Error

HEADERS = "WEBVIZ_CONNECT_HEADERS"
"""Environment variable with headers, one a line."""
MAX_HEADERS = 64 << 10
"""Bytes of a file with headers."""
_HEADER = re.compile(r"([!#$%&'*+.^_`|~0-9A-Za-z-]+):[ \t]*([\x20-\x7e]*?)[ \t]*")


@dataclass(frozen=True)
class Address:
    """The address of a bridge.

    Args:
        url: with credentials, if it has any.
        headers: of the request, with tokens.
    """

    url: str = field(repr=False)
    headers: Sequence[tuple[str, str]] = field(default=(), repr=False)

    @property
    def name(self) -> str:
        """The address without credentials, for sentences."""
        parts = urlsplit(self.url)
        place = parts.netloc.rpartition("@")[2]
        return f"{parts.scheme}://{place}{parts.path.rstrip('/')}"

    @property
    def place(self) -> str:
        """Host and port."""
        parts = urlsplit(self.url)
        port = parts.port or (443 if parts.scheme == "wss" else 80)
        host = parts.hostname or ""
        return f"[{host}]:{port}" if ":" in host else f"{host}:{port}"


def address(
    url: str, headers: Path | None = None, environment: Mapping[str, str] = os.environ
) -> Address:
    """Return the address that a user gave.

    Args:
        url: such as ws://robot:8765 or wss://robot.example/bridge.
        headers: file with headers, one `Name: value` a line.
        environment: may have headers, too.

    Raises:
        Error: the URL, the file or a header is invalid.
    """
    try:
        parts = urlsplit(url)
        is_valid = parts.scheme in ("ws", "wss") and bool(parts.hostname) and parts.port != 0
    except ValueError:  # a bad port or [host]
        is_valid = False
    if not is_valid or not url.isascii() or any(c.isspace() for c in url):
        raise Error(
            f"{url!r} is not the address of a bridge. Write ws://HOST:PORT, such as "
            "ws://robot:8765 of Foxglove's bridge or ws://robot:9090 of rosbridge, wss:// for one "
            "with TLS, or tcp/HOST:7447 for a Zenoh router."
        )
    lines = environment.get(HEADERS, "").splitlines()
    if headers is not None:
        lines += _lines(headers)
    return Address(url, [_header(line) for line in lines if line.strip()])


def headers_of(robot: str, environment: Mapping[str, str] = os.environ) -> Mapping[str, str]:
    """Return the environment for the connection of a robot, whose headers have its name.

    Those of another connection are not for it.

    Args:
        robot: its namespace, such as robot1: its headers are in WEBVIZ_CONNECT_HEADERS_ROBOT1.
        environment: of this process.
    """
    name = f"{HEADERS}_{robot.replace('/', '_').upper()}"
    return {HEADERS: environment.get(name, "")}


def _lines(path: Path) -> list[str]:
    try:
        if not path.is_file():  # a FIFO would block
            raise Error(f"{path} with the headers is not a file.")
        text = path.read_bytes()[: MAX_HEADERS + 1]
    except OSError as error:
        raise Error(f"{path} with the headers cannot be read: {error.strerror}.") from error
    if len(text) > MAX_HEADERS:
        raise Error(f"{path} with the headers is larger than {MAX_HEADERS >> 10} kB.")
    return text.decode("utf-8", "replace").splitlines()


def _header(line: str) -> tuple[str, str]:
    match = _HEADER.fullmatch(line.strip())
    if not match:  # without its value, which may be a secret
        raise Error(
            f"The header {line.partition(':')[0][:40]!r} is invalid. Write one `Name: value` a "
            "line, such as `Authorization: Bearer TOKEN`."
        )
    return match[1], match[2]
