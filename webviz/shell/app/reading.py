"""Reading of configs, and the default one."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from webviz.files import config as config_file
from webviz.files import opening
from webviz.files.config import Config

if TYPE_CHECKING:
    from webviz.sources import Source


def read_config(path: Path | None, source: Source | None = None) -> Config:
    """Return the config of a file, or the default one: of a bag that of its topics.

    Raises:
        ConfigError: the file cannot be read.
    """
    if path is not None:
        return opening.load(path)
    from webviz.shell.app.bag_config import config_of  # here, as it takes a tenth of a second
    from webviz.shell.bag_player import bag_of

    bag = bag_of(source)
    return config_of(bag) if bag else config_file.standard()
