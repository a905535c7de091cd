"""`webviz convert`: config files from RViz's form into webviz's and back."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from cyclopts import App

from webviz.engine import plugins
from webviz.files import config as config_file
from webviz.files import opening, rviz
from webviz.files.config import ConfigError
from webviz.shell.cli.options import File, Flag, Plugins

EXAMPLES = """\
Examples:
  webviz convert nav2.rviz nav2.yaml    unsupported keys are listed, and kept
  webviz convert nav2.yaml nav2.rviz    back, with all that was kept
  webviz convert --report nav2.rviz     how much of a file is supported
"""


def check(source: Path, target: Path | None = None, *, report: bool = False, **_: object) -> None:
    """Refuse arguments that make no sense together.

    Raises:
        ValueError: a sentence.
    """
    if target is None and not report:
        raise ValueError("Give the TARGET to write, or --report.")
    if report and not config_file.is_rviz(source):
        raise ValueError("--report is for a .rviz file.")


app = App(
    "convert",
    usage="Usage: webviz convert [OPTIONS] SOURCE [TARGET]",
    help_epilogue=EXAMPLES,
)


@app.default(validator=check)
def convert(
    source: File,
    target: File | None = None,
    /,
    *,
    report: Flag = False,
    plugin: Plugins = (),
) -> None:
    """Convert a file and report what was not carried over.

    Args:
        source: File to read.
        target: File to write, overwritten.
        report: Print how much of a .rviz file is supported.
        plugin: Files with displays.

    Raises:
        ConfigError: a file cannot be read or written.
        PluginError: a plug-in cannot be loaded.
    """
    for path in plugin:
        plugins.load(path)
    imported = None
    if config_file.is_rviz(source):
        config, imported = rviz.read(config_file.read_text(source), str(source))
        tell(source, config.report)
    else:
        config = opening.load(source)
    if report and imported is not None:
        print(imported.table())
    if target is None:
        return
    if target.exists() and target.samefile(source):
        raise ConfigError(f"{target} is the file to convert. Choose another TARGET.")
    if config_file.is_rviz(target):
        text, written = rviz.write(config)
        tell(target, written.sentences())
    else:
        text = config_file.dump(config)
    config_file.write_text(text, target)
    print(f"webviz: wrote {target}")


def tell(path: Path, sentences: Sequence[str]) -> None:
    """Print what was not carried over from or into a file, apart from any output."""
    if sentences:
        print(f"webviz: parts of {path} are unsupported:", file=sys.stderr)
        for sentence in sentences:
            print(f"  {sentence}", file=sys.stderr)
