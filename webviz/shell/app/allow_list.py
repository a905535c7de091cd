"""Allow-list as named where a viewer is started."""

from __future__ import annotations

import logging
from collections.abc import Iterable

import msgspec

from webviz.api.errors import Error
from webviz.files.config.model import Name

log = logging.getLogger("webviz")


def check_names(names: Iterable[str]) -> None:
    """Refuse what is no name or pattern of a topic, service or action.

    Raises:
        Error: one is invalid.
    """
    for name in names:
        try:
            msgspec.convert(name, Name)
        except msgspec.ValidationError:
            raise Error(
                f"{name!r} is not a valid name to publish on. Use one such as /cmd_vel or /arm/*."
            ) from None


def report_everything(names: Iterable[str]) -> None:
    """Log a warning for each pattern that matches every name, whatever its namespace."""
    for name in names:
        if not name.strip("/*"):
            log.warning(
                "The pattern %s lets operators publish and call everything. List names instead, "
                "such as /cmd_vel or /arm/*.",
                name,
            )
