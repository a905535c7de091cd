"""Links with tokens, for the terminal only: whoever reads them may use the viewer."""

from __future__ import annotations

import socket
import sys
from collections.abc import Sequence
from urllib.parse import urlsplit

import psutil

from webviz.edges.access.starting import is_local, link
from webviz.edges.access.tokens import Token

EVERY_INTERFACE = ("", "0.0.0.0", "::")
ELSEWHERE = (
    "webviz: this viewer asks for a link with a token. Run `webviz token list --links` in a "
    "terminal to see them."
)


def show_links(tokens: Sequence[Token], url: str, host: str, names: Sequence[str]) -> None:
    """Print the link of each token, unless the output may be kept, such as by a log.

    Args:
        tokens: to print.
        url: of the page for this machine.
        host: address that the viewer listens on.
        names: that it may be addressed by.
    """
    if not sys.stdout.isatty():
        print(ELSEWHERE)
        return
    address = reachable(url, host, names)
    for token in tokens:
        until = (
            "" if token.expires is None else f", until {token.expires.astimezone():%Y-%m-%d %H:%M}"
        )
        print(f"  {token.name} ({token.role}{until}): {link(address, token)}")


def reachable(url: str, host: str, names: Sequence[str]) -> str:
    """The address of the page for other machines, if they reach it; else `url`."""
    if is_local(host):
        return url
    found = names[0] if names else host
    if found in EVERY_INTERFACE:
        found = next(iter(_own_addresses()), socket.gethostname())
    parts = urlsplit(url)
    shown = f"[{found}]" if ":" in found else found
    return parts._replace(netloc=f"{shown}:{parts.port}").geturl()


def _own_addresses() -> list[str]:
    """The IPv4 addresses of this machine in networks."""
    return [
        address.address
        for addresses in psutil.net_if_addrs().values()
        for address in addresses
        if address.family == socket.AF_INET and not address.address.startswith("127.")
    ]
