"""`webviz schema`: what editors need to complete and check config files."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated

from cyclopts import App, Parameter

from webviz.api.display import Display
from webviz.api.registry import display_types
from webviz.engine import plugins
from webviz.files.config import write_text
from webviz.files.config.schema import schema as json_schema
from webviz.shell.cli.options import File, Plugins

SHIPPED = Path(__file__).parents[2] / "files" / "config" / "webviz.schema.json"
"""That of the displays that come with webviz."""
COMMAND = "`webviz schema -o webviz/files/config/webviz.schema.json`"

EXAMPLES = """\
Examples:
  webviz schema -o webviz.schema.json           all displays that are installed
  webviz schema --plugin my_display.py -o ...   and those of a file

An editor with a YAML language server uses it for a file that begins with
  # yaml-language-server: $schema=webviz.schema.json
"""


app = App("schema", help_epilogue=EXAMPLES)


@app.default
def schema(
    *,
    output: Annotated[File | None, Parameter(alias="-o")] = None,
    plugin: Plugins = (),
) -> None:
    """Write the JSON Schema of config files.

    Args:
        output: File to write, instead of the terminal.
        plugin: Files with displays.

    Raises:
        ConfigError: the file cannot be written.
        PluginError: a plug-in cannot be loaded.
    """
    for path in plugin:
        plugins.load(path)
    written = text(display_types())
    if output is None:
        print(written, end="")
    else:
        write_text(written, output)
        print(f"webviz: wrote {output}")


def text(types: Mapping[str, type[Display]]) -> str:
    """The schema as a file has it."""
    return json.dumps(json_schema(types), indent=1, ensure_ascii=False) + "\n"
