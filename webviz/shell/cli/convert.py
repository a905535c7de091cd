"""`webviz convert`: converts config files between the formats of RViz and webviz."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from cyclopts import App

from webviz.engine.pipeline import plugins
from webviz.files import config as config_file
from webviz.files import opening, rviz
from webviz.files.config import ConfigError
from webviz.files.rviz.report import percent
from webviz.shell.cli.options import File, Flag, Plugins, report_unsupported
from webviz.shell.cli.terminal import say

EXAMPLES = """\
Examples:
  webviz convert nav2.rviz nav2.yaml    list unsupported keys, and keep them
  webviz convert nav2.yaml nav2.rviz    convert back, with the keys that were kept
  webviz convert --report nav2.rviz     show how much of a file is supported
  webviz convert --check *.rviz         list unsupported parts of each file, and a total
"""


def validate(
    *, files: tuple[Path, ...] = (), report: bool = False, check: bool = False, **_: object
) -> None:
    """Raise ValueError for an invalid combination of arguments."""
    if not files:
        raise ValueError("`webviz convert` needs SOURCE.")
    if check:
        if strange := [path for path in files if not config_file.is_rviz(path)]:
            raise ValueError(f"--check needs .rviz files, got {strange[0]}.")
        return
    source, *targets = files
    if len(targets) > 1:
        raise ValueError("Give one SOURCE and one TARGET, or --check for several files.")
    if not targets and not report:
        raise ValueError("Missing TARGET. Give the file to write, or --report.")
    if report and not config_file.is_rviz(source):
        raise ValueError("--report needs a .rviz file.")


app = App(
    "convert",
    usage="Usage: webviz convert [OPTIONS] SOURCE [TARGET]\n       webviz convert --check FILE ...",
    help_epilogue=EXAMPLES,
)


@app.default(validator=validate)
def convert(
    *files: File,
    report: Flag = False,
    check: Flag = False,
    plugin: Plugins = (),
) -> None:
    """Convert a file and report unsupported parts.

    Args:
        files: File to read, and file to write; the latter is overwritten if it exists.
        report: Show how much of a .rviz file is supported.
        check: List the unsupported parts of several .rviz files, and how many files are complete:
            every display, tool, view and panel is supported, and every property that affects the
            scene. Writes nothing.
        plugin: Files with displays.
    """
    for path in plugin:
        plugins.load(path)
    if check:
        print_check(files)
        return
    source, target = files[0], files[1] if len(files) == 2 else None
    imported = None
    if config_file.is_rviz(source):
        config, imported = rviz.read(config_file.read_text(source), str(source))
        report_unsupported(source, config.report)
    else:
        config = opening.load(source)
    if report and imported is not None:
        say(*imported.table().split("\n"))
    if target is None:
        return
    if target.exists() and target.samefile(source):
        raise ConfigError(f"SOURCE and TARGET are both {target}. Choose another TARGET.")
    if config_file.is_rviz(target):
        text, written = rviz.write(config)
        report_unsupported(target, written.sentences())
    else:
        text = config_file.dump(config)
    config_file.write_text(text, target)
    say(f"webviz: wrote {target}")


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
