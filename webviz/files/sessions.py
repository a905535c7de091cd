"""Session files: the unsaved changes of viewers, which their next start restores."""

from __future__ import annotations

import contextlib
import hashlib
import json
import logging
import os
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import msgspec

from webviz.data.disk import within
from webviz.data.locks import lock
from webviz.files import opening
from webviz.files.config import Config, ConfigError, dump, read_text
from webviz.files.config.atomic import write_private

MAX_VIEWERS = 8
"""Largest number of viewers that show one config at once, and have a session file each."""
MAX_NAME = 40
"""Characters of a config's name in the name of its session file."""
SET_ASIDE = ".old.yaml"
"""Suffix of a session that was not restored; a later one replaces it."""
PATIENCE_S = 2.0
"""Time in seconds for the disk, when a viewer starts."""
_START = "# Unsaved changes, see `webviz --help`: "

log = logging.getLogger("webviz")


class Base(msgspec.Struct, frozen=True):
    """The config that a session began with.

    Args:
        digest: of its content without the fixed frame, which is often given for one start only.
        fixed_frame: of it.
    """

    digest: str
    fixed_frame: str

    @staticmethod
    def of(values: Mapping[str, Any]) -> Base:
        """Identify a config by the values of its file; see `webviz.files.config.document`."""
        rest = {key: value for key, value in values.items() if key != "fixed_frame"}
        text = json.dumps(rest, sort_keys=True, default=str)
        digest = hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()
        return Base(digest, values.get("fixed_frame", ""))


class Session(msgspec.Struct, frozen=True):
    """The content of a session file.

    Args:
        config: as it was shown.
        path: of the config file that was open, "" for none.
        base: what the viewer was started with.
    """

    config: Config
    path: str
    base: Base


class _Head(msgspec.Struct, frozen=True):
    """The first line of a session file."""

    path: str
    base: Base


def write(session: Session, path: Path) -> None:
    """Write a session file atomically, readable by its owner only.

    Raises:
        OSError: it cannot be written.
    """
    head = msgspec.json.encode(_Head(session.path, session.base)).decode()
    path.parent.mkdir(parents=True, exist_ok=True)
    write_private(f"{_START}{head}\n{dump(session.config)}", path)


def read(path: Path) -> Session:
    """Read a session file.

    Raises:
        ConfigError: it is missing, damaged, or not a session; one sentence.
    """
    text = read_text(path)
    first = text.partition("\n")[0]
    try:
        head = msgspec.json.decode(first.removeprefix(_START), type=_Head)
    except msgspec.DecodeError as error:
        raise ConfigError(f"{path} is damaged.") from error
    return Session(opening.parse(text, str(path)), head.path, head.base)


def set_aside(path: Path) -> Path:
    """Rename a session file, so that no later session replaces it; return its new name.

    Raises:
        OSError: it cannot be renamed.
    """
    return path.rename(path.with_suffix(SET_ASIDE))


class Claim:
    """A session file that belongs to one viewer while it runs, however it ends.

    Args:
        path: of the file; it need not exist.
        lock: descriptor of the locked file beside it.
    """

    def __init__(self, path: Path, lock: int) -> None:
        self.path = path
        self._lock = lock

    def close(self) -> None:
        """Let other viewers have the file."""
        os.close(self._lock)


class Sessions(msgspec.Struct, frozen=True):
    """The session files of a user's viewers.

    Args:
        standard: names what is shown without a config file.
        restore: whether to show the changes of the last session.
    """

    standard: str = "default"
    restore: bool = True

    def claim(self, config: Path | None) -> Claim | None:
        """Return the session file of a config that no other running viewer has.

        Args:
            config: the config file, None for none.

        Returns:
            None if the folder cannot be written, or too many viewers show this config; it is
            logged.
        """
        name = self.standard if config is None else name_of(config)
        try:
            return within(PATIENCE_S, lambda: _claim(name, _folder()))
        except OSError as error:
            log.warning("Changes are not kept for the next start: %s", error)
            return None


def _folder() -> Path:
    """According to the XDG base directory specification."""
    home = os.environ.get("XDG_STATE_HOME") or Path.home() / ".local" / "state"
    return Path(home) / "webviz" / "sessions"


def _claim(name: str, folder: Path) -> Claim:
    folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    for number in range(1, MAX_VIEWERS + 1):
        path = folder / (f"{name}.yaml" if number == 1 else f"{name}-{number}.yaml")
        descriptor = os.open(
            path.with_suffix(".lock"), os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600
        )
        try:
            lock(descriptor)
        except BlockingIOError:
            os.close(descriptor)
            continue
        except OSError:  # a file system without locks
            pass
        return Claim(path, descriptor)
    raise OSError(f"{MAX_VIEWERS} viewers show this config already.")


def name_of(config: Path) -> str:
    """Tell files of the same name in different folders apart."""
    full = os.path.realpath(config)
    stem = re.sub(r"[^\w.-]+", "_", config.stem)[:MAX_NAME]
    return f"{stem}-{hashlib.sha256(os.fsencode(full)).hexdigest()[:8]}"


def remove(path: Path) -> None:
    """Remove a session file that is not needed any more.

    Raises:
        OSError: it exists and cannot be removed.
    """
    with contextlib.suppress(FileNotFoundError):
        path.unlink()
