"""Links with tokens, for the terminal only: whoever reads them may use the viewer."""

from __future__ import annotations

import io
import socket
import sys
from collections.abc import Sequence
from datetime import UTC, datetime
from urllib.parse import urlsplit

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
        for line in lines_of(token, link(address, token)):
            print(f"  {line}")
    if tokens:
        print(f"  As a QR code, the link of {tokens[0].name}:")
        print(qr_code(link(address, tokens[0])))


def lines_of(token: Token, address: str) -> list[str]:
    """A token in words, and its link if there is one."""
    until = "" if token.expires is None else f" until {token.expires.astimezone():%Y-%m-%d %H:%M}"
    over = "" if token.is_valid(datetime.now(UTC)) else " (expired)"
    return [f"{token.name}: {token.role}{until}{over}", *([f"  {address}"] if address else [])]


def qr_code(text: str) -> str:
    """A QR code for terminals with dark or light background."""
    import segno  # here, as it would slow down the start

    lines = io.StringIO()
    segno.make(text, micro=False).terminal(lines, border=2, compact=True)
    return lines.getvalue().rstrip("\n")


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
    import psutil  # here, as it would slow down the start

    return [
        address.address
        for addresses in psutil.net_if_addrs().values()
        for address in addresses
        if address.family == socket.AF_INET and not address.address.startswith("127.")
    ]
