"""`webviz token`: lists, makes, rotates and revokes the tokens of links to a viewer."""

from __future__ import annotations

import socket
from datetime import UTC, datetime
from typing import Annotated

from cyclopts import App, Parameter

from webviz.api.roles import Role
from webviz.files.config import nearest
from webviz.server.access import token_file
from webviz.server.access.announcing import announced
from webviz.server.access.starting import link
from webviz.server.access.token_file import Tokens
from webviz.server.access.tokens import RoleName, Token, TokenError, make
from webviz.shell.cli.links import lines_of, qr_code
from webviz.shell.cli.options import Flag
from webviz.shell.cli.terminal import say, say_painted, warn

EXAMPLES = """\
Examples:
  webviz token make Ada                    a link for a person who watches
  webviz token make Ada --role operator    for a person who may drive
  webviz token make guests --days 1        which ends tomorrow
  webviz token list --links                all tokens with their links
  webviz token rotate Ada                  a new link instead of the old one
  webviz token revoke Ada                  close the pages of that link

A viewer that runs notices changes within two seconds.
"""

Url = Annotated[str, Parameter(metavar="URL", show_default=False)]
Days = Annotated[float | None, Parameter(metavar="DAYS")]

app = App("token", usage="Usage: webviz token COMMAND [OPTIONS]", help_epilogue=EXAMPLES)


@app.command(name="list")
def list_tokens(*, links: Flag = False, url: Url = "") -> None:
    """List names, roles and expiry.

    Args:
        links: Show the links, too. They grant access to the viewer.
        url: Address of the viewer (default: those of the viewers that run and ask for tokens).
    """
    tokens = token_file.read(token_file.standard_path())
    if not tokens:
        say("No tokens. Make one with `webviz token make NAME`.")
    addresses = _addresses(url) if links and tokens else []
    for token in tokens:
        say(*lines_of(token, addresses))


@app.command(name="make")
def make_token(
    name: str, /, *, role: RoleName = "watcher", days: Days = None, url: Url = ""
) -> None:
    """Make a token, and print its link and QR code.

    Args:
        name: Of the person or group that gets the link.
        role: What the link allows.
        days: Time until the link ends (default: never).
        url: Address of the viewer (default: those of the viewers that run and ask for tokens).
    """
    created = make(name, Role[role.upper()], datetime.now(UTC), days)

    def add(tokens: Tokens) -> Tokens:
        if any(token.name == name for token in tokens):
            raise TokenError(
                f"There is a token {name!r} already. Choose another name, or run `webviz token "
                f"rotate {name!r}`."
            )
        return (*tokens, created)

    token_file.modify(token_file.standard_path(), add)
    _print(created, url)


@app.command(name="rotate")
def rotate_token(name: str, /, *, days: Days = None, url: Url = "") -> None:
    """Replace the link of a token; pages of the old one are closed.

    Args:
        name: Of the token.
        days: Time until the new link ends (default: never).
        url: Address of the viewer (default: those of the viewers that run and ask for tokens).
    """
    rotated: list[Token] = []

    def renew(tokens: Tokens) -> Tokens:
        old = _find(tokens, name)
        rotated.append(make(name, Role[old.role.upper()], datetime.now(UTC), days))
        return tuple(rotated[-1] if token is old else token for token in tokens)

    token_file.modify(token_file.standard_path(), renew)
    _print(rotated[-1], url)


@app.command(name="revoke")
def revoke_token(name: str, /) -> None:
    """Remove a token; its pages are closed.

    Args:
        name: Of the token.
    """

    def remove(tokens: Tokens) -> Tokens:
        revoked = _find(tokens, name)
        return tuple(token for token in tokens if token is not revoked)

    token_file.modify(token_file.standard_path(), remove)
    say(f"webviz: revoked {name}.")


def _find(tokens: Tokens, name: str) -> Token:
    names = [token.name for token in tokens]
    if name not in names:
        raise TokenError(f"No token is named {name!r}: {nearest(name, names)}")
    return tokens[names.index(name)]


def _print(token: Token, url: str) -> None:
    addresses = _addresses(url)
    say(*lines_of(token, addresses))
    say_painted(qr_code(link(addresses[0], token)))


def _addresses(url: str) -> list[str]:
    """Return the addresses of the viewers that links are for, at least one."""
    if urls := [url] if url else announced():
        return urls
    guess = f"http://{socket.gethostname()}:8080"
    warn(
        f"No running viewer requires tokens. Links work once one serves {guess}; for another "
        "address give --url.",
    )
    return [guess]
