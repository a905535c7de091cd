"""Links with tokens, for the terminal only: they grant access to the viewer."""

from __future__ import annotations

import io
import sys
from collections.abc import Sequence
from datetime import UTC, datetime

from webviz.server.access.announcing import reachable
from webviz.server.access.starting import link
from webviz.server.access.tokens import Token
from webviz.shell.cli.terminal import say, say_painted

ELSEWHERE = (
    "webviz: this viewer requires a link with a token. Run `webviz token list --links` in a "
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
        say(ELSEWHERE)
        return
    address = reachable(url, host, names)
    for token in tokens:
        for line in lines_of(token, [address]):
            say(f"  {line}")
    if tokens:
        say(f"  As a QR code, the link of {tokens[0].name}:")
        say_painted(qr_code(link(address, tokens[0])))


def lines_of(token: Token, addresses: Sequence[str]) -> list[str]:
    """Return a token in words, and its links to the pages of these addresses."""
    until = "" if token.expires is None else f" until {token.expires.astimezone():%Y-%m-%d %H:%M}"
    over = "" if token.is_valid(datetime.now(UTC)) else " (expired)"
    links = [f"  {link(address, token)}" for address in addresses]
    return [f"{token.name}: {token.role}{until}{over}", *links]


def qr_code(text: str) -> str:
    """Return a QR code for terminals with dark or light background."""
    import segno  # here, as it would slow down the start

    lines = io.StringIO()
    segno.make(text, micro=False).terminal(lines, border=2, compact=True)
    return lines.getvalue().rstrip("\n")
