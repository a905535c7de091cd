"""Names that people give: of files, views, displays and links."""

from __future__ import annotations

import itertools
import re
from datetime import datetime
from pathlib import Path

MAX_NAME = 200
"""Characters of a name."""
MAX_FILE_BYTES = 251
"""Largest number of bytes of a file name, as Linux allows 255 and the previous version ends with
`.bak`."""

_UNREADABLE = re.compile(
    "[\x00-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ud800-\udfff\ufffe\uffff]"
)
"""Control characters, line ends, marks that turn the direction of text, halves of pairs, and what
XML cannot contain."""


def readable(name: str, mark: str = " ") -> str:
    """Return a name as one line that is read in one direction; `mark` replaces what prevents it."""
    return _UNREADABLE.sub(mark, name)


def escaped(json: str) -> str:
    """Return JSON whose texts have only readable characters; it means the same."""
    return _UNREADABLE.sub(lambda match: match[0] if match[0] == "\n" else _escape(match[0]), json)


def _escape(character: str) -> str:
    return f"\\u{ord(character):04x}"


def problem_of(name: str) -> str:
    """Return why a name cannot be given: a sentence, "" if it can."""
    if not name.strip():
        return "The name is empty. Enter one."
    if len(name) > MAX_NAME:
        return f"The name has {len(name)} characters; the limit is {MAX_NAME}."
    if _UNREADABLE.search(name):
        return "The name contains line breaks or other invisible characters. Remove them."
    return ""


def file_problem_of(name: str) -> str:
    """Return why a file cannot be given a name: a sentence, "" if it can."""
    if name.startswith("-"):
        return "The name begins with a dash, which programs take for an option. Remove it."
    if len(name.encode(errors="replace")) > MAX_FILE_BYTES:
        return f"The name is too long; the limit is {MAX_FILE_BYTES} bytes."
    return problem_of(name)


def new_path(stem: str, suffix: str = "", folder: Path = Path()) -> Path:
    """Return the path of a file or folder that does not exist yet, named by the time.

    Args:
        stem: beginning of its name.
        suffix: of its name, such as ".html".
        folder: for it; by default the working folder.
    """
    name = f"{stem}_{datetime.now():%Y_%m_%d-%H_%M_%S}"
    numbered = (f"{name}_{number}" for number in itertools.count(2))
    paths = (folder.absolute() / f"{each}{suffix}" for each in itertools.chain([name], numbered))
    return next(path for path in paths if not path.exists())
