"""The file of the config, as panels show it."""

from __future__ import annotations

from webviz.engine.store import PageStore


class ConfigFile(PageStore, frozen=True):
    """The file of the config.

    Args:
        path: of the file, "" if there is none.
        is_changed: whether there are unsaved changes.
        folder: base of relative paths.
        others: names of all config files in the folder, sorted.
    """

    path: str = ""
    is_changed: bool = False
    folder: str = ""
    others: tuple[str, ...] = ()
