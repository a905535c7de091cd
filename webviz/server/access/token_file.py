"""Tokens in a file that only its owner can read, and in environment variables."""

from __future__ import annotations

import os
import stat
from collections.abc import Callable, MutableMapping, Sequence
from datetime import UTC, datetime
from pathlib import Path

import msgspec

from webviz.files.config import ConfigError
from webviz.files.config.atomic import alone_in, write_private
from webviz.server.access.roles import LINKS
from webviz.server.access.tokens import (
    MAX_CHARACTERS,
    MAX_TOKENS,
    MIN_CHARACTERS,
    SECRET,
    Token,
    TokenError,
    role_name,
)

MAX_BYTES = 1 << 20
OTHERS = 0o077
"""Permissions of the group and of everybody else."""

Tokens = tuple[Token, ...]


class _File(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    tokens: Tokens


def standard_path() -> Path:
    """Return the file of this user, according to the XDG base directory specification."""
    home = os.environ.get("XDG_CONFIG_HOME") or Path.home() / ".config"
    return Path(home) / "webviz" / "tokens.json"


def read(path: Path) -> Tokens:
    """Return the tokens of a file, () if there is none.

    Raises:
        TokenError: others may read or write the file, or it is invalid.
    """
    try:
        # A FIFO would wait for a writer.
        with open(os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC), "rb") as file:
            _check(os.fstat(file.fileno()), path)
            data = file.read(MAX_BYTES + 1)
    except FileNotFoundError:
        return ()
    except OSError as error:
        raise TokenError(f"Cannot read {path}: {error.strerror}.") from error
    try:
        tokens = msgspec.json.decode(data, type=_File).tokens
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError):
        # Not the reason in words, which might quote a secret.
        raise TokenError(
            f"{path} is not a valid file of tokens. Delete it, and create new tokens with "
            "`webviz token make`."
        ) from None
    if len({token.name for token in tokens}) < len(tokens) or len(tokens) > MAX_TOKENS:
        raise TokenError(f"{path} has two tokens of one name, or more than {MAX_TOKENS}.")
    return tokens


def modify(path: Path, change: Callable[[Tokens], Sequence[Token]]) -> Tokens:
    """Change the tokens of a file; other programs that do the same wait.

    Args:
        path: of the file, which is made if there is none.
        change: from the tokens to those that replace them.

    Returns:
        The tokens as they are now.

    Raises:
        TokenError: the file cannot be read or written, or `change` refuses.
    """
    try:
        path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        with alone_in(path.parent):
            tokens = tuple(change(read(path)))
            if len(tokens) > MAX_TOKENS:
                raise TokenError(f"There are {MAX_TOKENS} tokens, which is the limit. Revoke some.")
            text = msgspec.json.format(msgspec.json.encode(_File(tokens))).decode()
            write_private(f"{text}\n", path)
    except (OSError, ConfigError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise TokenError(f"Cannot write {path}: {reason}.") from error
    return tokens


def take_from(environment: MutableMapping[str, str]) -> Tokens:
    """Remove the tokens from environment variables, so that no child process inherits them.

    They are WEBVIZ_TOKEN_WATCH, WEBVIZ_TOKEN_OPERATE and WEBVIZ_TOKEN_OWN.

    Raises:
        TokenError: one is too short or has other characters than a link may have.
    """
    tokens: list[Token] = []
    for parameter, role in LINKS.items():
        variable = f"WEBVIZ_TOKEN_{parameter.upper()}"
        secret = environment.pop(variable, "")
        if not secret:
            continue
        if not SECRET.fullmatch(secret):
            raise TokenError(
                f"{variable} must have {MIN_CHARACTERS} to {MAX_CHARACTERS} of the characters "
                'A-Z, a-z, 0-9, - and _. Make one with `python3 -c "import secrets; '
                'print(secrets.token_urlsafe(24))"`.'
            )
        tokens.append(Token(variable, role_name(role), secret, datetime.now(UTC)))
    return tuple(tokens)


def _check(status: os.stat_result, path: Path) -> None:
    if not stat.S_ISREG(status.st_mode):
        raise TokenError(f"{path} is not a file.")
    if status.st_mode & OTHERS:
        mode = stat.S_IMODE(status.st_mode)
        raise TokenError(
            f"Other users may read or write {path} (mode {mode:04o}). Run `chmod 600 {path}`, and "
            "`webviz token rotate` for each token that may have been read."
        )
    if status.st_uid not in (os.geteuid(), 0):
        raise TokenError(f"{path} belongs to another user. Make your own file of tokens.")
