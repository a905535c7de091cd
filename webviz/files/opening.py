"""Config files of both kinds: webviz's YAML and RViz's."""

from __future__ import annotations

import contextlib
import itertools
from pathlib import Path

from webviz.files import rviz
from webviz.files.config import (
    Branch,
    Config,
    ConfigError,
    Item,
    Unreadable,
    dump,
    is_rviz,
    read,
    read_text,
    write_text,
)


def load(path: Path) -> Config:
    """Read a config file: YAML, or RViz's if its name ends with .rviz.

    Raises:
        ConfigError: the file is missing, not YAML, or not a config; the sentence does not
            quote the file. A single invalid display is not an error: it becomes an
            `Unreadable`.
    """
    return parse(read_text(path), str(path))


def parse(text: str, where: str) -> Config:
    """Return a config from its text.

    Args:
        text: in RViz's format if `where` ends with .rviz, else YAML.
        where: names the text in errors.

    Raises:
        ConfigError: as `load`.
    """
    if is_rviz(Path(where)):
        return rviz.read(text, where)[0]
    config = read(text, where)
    if any(map(_is_kept, config.displays)):
        config.displays, config.settings, report = rviz.revive(config.displays, config.settings)
        config.report = report.sentences()
    return config


def text_of(config: Config, name: str) -> tuple[str, list[str]]:
    """Return the text of a config file, in RViz's format if `name` ends with .rviz, else YAML.

    Returns:
        The text, and sentences on what RViz's format cannot hold, which is left out.
    """
    if is_rviz(Path(name)):
        text, report = rviz.write(config)
        return text, report.sentences()
    return dump(config), []


def save(config: Config, path: Path) -> list[str]:
    """Write a config file, in RViz's format if its name ends with .rviz.

    The previous version is kept, see `write_text`. Comments at the beginning of the file stay, such
    as a licence or the reference to a schema; other comments are removed, since the displays they
    belong to may have moved.

    Returns:
        Sentences on what RViz's format cannot hold, which is left out.

    Raises:
        ConfigError: it cannot be written.
    """
    text, left_out = text_of(config, path.name)
    write_text(text if is_rviz(path) else _comments(path) + text, path)
    return left_out


def _is_kept(item: Item) -> bool:
    """Return whether the displays include unsupported ones of a .rviz file, in groups too."""
    if isinstance(item, Branch):
        return any(map(_is_kept, item.displays))
    return isinstance(item, Unreadable) and item.is_from_rviz


def _comments(path: Path) -> str:
    """Return the comments at the beginning of a file, with the lines between them."""
    with contextlib.suppress(ConfigError, OSError):
        if path.is_file():
            lines = read_text(path).splitlines(keepends=True)
            return "".join(itertools.takewhile(lambda line: line.startswith(("#", "\n")), lines))
    return ""
