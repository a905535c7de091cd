"""Config files on the disk."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from webviz.config.errors import ConfigError

MAX_BYTES = 16 << 20


def read_text(path: Path) -> str:
    """The text of a config file.

    Raises:
        ConfigError: it is missing, too large or no text.
    """
    try:
        if path.stat().st_size > MAX_BYTES:
            raise ConfigError(f"{path} is larger than {MAX_BYTES >> 20} MB and no config file.")
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise ConfigError(f"Cannot read {path}: {error.strerror or error}.") from error
    except UnicodeDecodeError as error:
        raise ConfigError(f"{path} is not UTF-8 text.") from error


def is_rviz(path: Path) -> bool:
    """Whether a file is RViz's by its name."""
    return path.suffix.lower() == ".rviz"


def write_text(text: str, path: Path) -> None:
    """Write a file in one step: after a failure the old file is still there.

    Raises:
        ConfigError: it cannot be written.
    """
    try:
        with tempfile.NamedTemporaryFile(
            "w", encoding="utf-8", dir=path.parent, prefix=path.name, delete=False
        ) as file:
            temporary = Path(file.name)
            try:
                file.write(text)
                file.flush()
                os.fsync(file.fileno())
                temporary.replace(path)
            except BaseException:
                temporary.unlink(missing_ok=True)
                raise
    except OSError as error:
        raise ConfigError(f"Cannot write {path}: {error.strerror or error}.") from error
