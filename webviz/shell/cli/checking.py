"""`webviz convert --check`: what is unsupported in several .rviz files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from webviz.files import config as config_file
from webviz.files import rviz
from webviz.files.config import ConfigError
from webviz.files.rviz.report import percent
from webviz.shell.cli.terminal import say


def print_check(paths: Sequence[Path]) -> None:
    """Print the unsupported parts of each file, and totals.

    Raises:
        ConfigError: some files cannot be read; the others are printed nevertheless.
    """
    whole, complete, unreadable = rviz.Report(), 0, 0
    for path in paths:
        try:
            config, report = rviz.read(config_file.read_text(path), str(path))
        except ConfigError as error:
            say(f"{path}: {error}")
            unreadable += 1
            continue
        whole.total += report.total
        whole.carried += report.carried
        complete += report.is_complete
        counts = ", ".join(f"{report.carried[k]} of {report.total[k]} {k}" for k in report.missing)
        say(f"{path}: {counts or 'complete'}")
        for sentence in config.report:
            say(f"  {sentence}")
    say("", f"Complete: {complete} of {len(paths)} files, {percent(complete, len(paths)).strip()}")
    say(*whole.table().split("\n"))
    if unreadable:
        raise ConfigError(f"{unreadable} of {len(paths)} files cannot be read.")
