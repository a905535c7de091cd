"""`webviz convert`: config files from RViz's form into webviz's and back."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from webviz import config as config_file
from webviz import plugins, rviz
from webviz.cli.options import add_plugin, new_parser
from webviz.config import ConfigError

EPILOG = """\
examples:
  webviz convert nav2.rviz nav2.yaml    what has no counterpart here is listed and kept
  webviz convert nav2.yaml nav2.rviz    back, with all that was kept
  webviz convert --report nav2.rviz     how much of a file has a counterpart
"""


def run(arguments: Sequence[str]) -> None:
    """Convert a file and tell what was not carried over.

    Raises:
        ConfigError: a file cannot be read or written.
        PluginError: a plug-in cannot be loaded.
    """
    parser = _parser()
    options = parser.parse_args(arguments)
    source, target = options.source, options.target
    if target is None and not options.report:
        parser.error("a TARGET is needed, or --report")
    if options.report and not config_file.is_rviz(source):
        parser.error("--report counts what is carried over from a .rviz file")
    for path in options.plugin:
        plugins.load(path)
    report = None
    if config_file.is_rviz(source):
        config, report = rviz.read(config_file.read_text(source), str(source))
        tell(source, config.report)
    else:
        config = config_file.load(source)
    if options.report and report is not None:
        print(report.table())
    if target is None:
        return
    if target.exists() and target.samefile(source):
        raise ConfigError(f"{target} is the file to be converted: give another name.")
    if config_file.is_rviz(target):
        text, written = rviz.write(config)
        tell(target, written.sentences())
    else:
        text = config_file.dump(config)
    config_file.write_text(text, target)
    print(f"webviz: wrote {target}")


def tell(path: Path, sentences: Sequence[str]) -> None:
    """Print what was not carried over from or into a file."""
    if sentences:
        print(f"webviz: {path}: not all of it has a counterpart:")
        for sentence in sentences:
            print(f"  {sentence}")


def _parser() -> argparse.ArgumentParser:
    parser = new_parser(
        "webviz convert",
        "Converts config files: a name that ends with .rviz is RViz's, others are webviz's YAML.",
        EPILOG,
    )
    add = parser.add_argument
    add("source", type=Path, metavar="SOURCE", help="file to read")
    add("target", type=Path, nargs="?", metavar="TARGET", help="file to write, overwritten")
    add("--report", action="store_true", help="count what of a .rviz file is carried over")
    add_plugin(parser)
    return parser
