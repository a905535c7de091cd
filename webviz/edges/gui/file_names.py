"""Names of config files."""

from __future__ import annotations

from pathlib import Path

from webviz.edges.gui.text import plain
from webviz.engine.state import File
from webviz.files.config.files import SUFFIXES

NAME = "webviz"
NEW_NAME = f"{NAME}.yaml"


def file_name(entered: str) -> str:
    """A plain file name of what somebody entered; `.yaml` is added where no suffix is known.

    Raises:
        ValueError: it is no plain file name; one sentence.
    """
    name = entered.strip()
    if not name or name in (".", ".."):
        raise ValueError("Enter a file name, such as lab.yaml.")
    if any(separator in name for separator in "/\\\0"):
        raise ValueError("Enter a name without folders; the file is saved in the folder above.")
    return name if Path(name).suffix.lower() in SUFFIXES else f"{name}.yaml"


def title_of(file: File, is_paused: bool = False) -> str:
    """What the panel is called: the name of the file, and whether something is not saved."""
    name = plain(Path(file.path).name) if file.path else NAME
    return f"{name}{'*' if file.is_changed else ''}{' · paused' if is_paused else ''}"
