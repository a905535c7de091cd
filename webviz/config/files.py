"""Reading config files from the disk."""

from __future__ import annotations

import codecs
from pathlib import Path

from webviz.config.errors import ConfigError

MAX_BYTES = 16 << 20
_UTF_16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)


def read_text(path: Path) -> str:
    """The text of a config file.

    Raises:
        ConfigError: it is missing, too large or no text.
    """
    try:
        with path.open("rb") as file:
            data = file.read(MAX_BYTES + 1)  # what is no plain file has no size to ask for
    except OSError as error:
        raise ConfigError(f"Cannot read {path}: {error.strerror or error}.") from error
    if len(data) > MAX_BYTES:
        raise ConfigError(f"{path} is larger than {MAX_BYTES >> 20} MB and no config file.")
    try:
        return data.decode("utf-8-sig")  # Windows' editors begin files with a mark
    except UnicodeDecodeError as error:
        hint = "it is UTF-16, save it as UTF-8" if data.startswith(_UTF_16) else "no config file"
        raise ConfigError(f"{path} is not UTF-8 text: {hint}.") from error


def is_rviz(path: Path) -> bool:
    """Whether a file is RViz's by its name."""
    return path.suffix.lower() == ".rviz"
