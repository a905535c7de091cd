"""`webviz schema`: what editors need to complete and check config files."""

from __future__ import annotations

import argparse
import json
from collections.abc import Mapping, Sequence
from pathlib import Path

from webviz import plugins
from webviz.cli.options import add_plugin, new_parser
from webviz.config import write_text
from webviz.config.schema import schema
from webviz.display import Display
from webviz.registry import display_types

SHIPPED = Path(__file__).parents[1] / "config" / "webviz.schema.json"
"""That of the displays that come with webviz."""
COMMAND = "`webviz schema -o webviz/config/webviz.schema.json`"

EPILOG = """\
examples:
  webviz schema -o webviz.schema.json           of all displays that are installed
  webviz schema --plugin my_display.py -o ...   and of those of a file

An editor with a YAML language server uses it for a file that begins with
  # yaml-language-server: $schema=webviz.schema.json
"""


def run(arguments: Sequence[str]) -> None:
    """Write the JSON Schema of config files.

    Raises:
        ConfigError: the file cannot be written.
        PluginError: a plug-in cannot be loaded.
    """
    options = _parser().parse_args(arguments)
    for path in options.plugin:
        plugins.load(path)
    written = text(display_types())
    if options.output is None:
        print(written, end="")
    else:
        write_text(written, options.output)
        print(f"webviz: wrote {options.output}")


def text(types: Mapping[str, type[Display]]) -> str:
    """The schema as a file has it."""
    return json.dumps(schema(types), indent=1, ensure_ascii=False) + "\n"


def _parser() -> argparse.ArgumentParser:
    parser = new_parser(
        "webviz schema", "Writes the JSON Schema of config files, for editors.", EPILOG
    )
    add = parser.add_argument
    add("-o", "--output", type=Path, metavar="FILE", help="file to write, instead of the terminal")
    add_plugin(parser)
    return parser
