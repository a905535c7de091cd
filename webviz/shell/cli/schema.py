"""`webviz schema`: writes the JSON Schema of config files."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

from cyclopts import App, Parameter

from webviz.api.panel import Panel
from webviz.api.registry import display_types, plugin_types
from webviz.api.tool import Tool
from webviz.engine.pipeline import plugins
from webviz.files.config import write_text
from webviz.files.config.schema import schema as json_schema
from webviz.shell.cli.options import File, Plugins
from webviz.shell.cli.terminal import say, say_json

SHIPPED = Path(__file__).parents[2] / "files" / "config" / "webviz.schema.json"
"""The schema of the displays and tools that come with webviz."""
COMMAND = "`make docs`"

EXAMPLES = """\
Examples:
  webviz schema -o webviz.schema.json           all installed plug-ins
  webviz schema --plugin my_display.py -o ...   and the displays of a file

Editors with a YAML language server use it for files whose first line is
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
        output: File to write (default: standard output).
        plugin: Files with displays.
    """
    for path in plugin:
        plugins.load(path)
    written = text()
    if output is None:
        say_json(written)
    else:
        write_text(written, output)
        say(f"webviz: wrote {output}")


def text() -> str:
    """Return the text of the schema of all installed displays and tools."""
    schema = json_schema(display_types(), plugin_types(Tool), plugin_types(Panel))
    return json.dumps(schema, indent=1, ensure_ascii=False) + "\n"
