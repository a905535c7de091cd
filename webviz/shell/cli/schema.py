"""`webviz schema`: what editors need to complete and check config files."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

from cyclopts import App, Parameter

from webviz.api.registry import display_types, plugin_types
from webviz.api.tool import Tool
from webviz.engine import plugins
from webviz.files.config import write_text
from webviz.files.config.schema import schema as json_schema
from webviz.shell.cli.options import File, Plugins

SHIPPED = Path(__file__).parents[2] / "files" / "config" / "webviz.schema.json"
"""That of the displays and tools that come with webviz."""
COMMAND = "`make docs`"

EXAMPLES = """\
Examples:
  webviz schema -o webviz.schema.json           all displays and tools installed
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
    written = text()
    if output is None:
        print(written, end="")
    else:
        write_text(written, output)
        print(f"webviz: wrote {output}")


def text() -> str:
    """The schema as a file has it, of all that is installed."""
    schema = json_schema(display_types(), plugin_types(Tool))
    return json.dumps(schema, indent=1, ensure_ascii=False) + "\n"
