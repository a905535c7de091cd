"""`webviz new`: writes the package of a new plug-in."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import App, Parameter

from webviz.shell.cli.terminal import say
from webviz.shell.new.writing import Kind, write_package

EXAMPLES = """\
Examples:
  webviz new display nearest_obstacle    a package with a display, its test and a config
  webviz new tool docking_station -o src
"""

app = App("new", help_epilogue=EXAMPLES)


@app.default
def new(
    kind: Annotated[Kind, Parameter(metavar="KIND")],
    name: Annotated[str, Parameter(metavar="NAME")],
    /,
    *,
    output: Annotated[Path, Parameter(alias="-o", metavar="FOLDER")] = Path(),
) -> None:
    """Write a ROS package with a display, tool, panel or check of your own, which works at once.

    Args:
        kind: display, tool, panel or check.
        name: Name of the package, such as docking_station.
        output: Folder to write it to (default: the working folder).
    """
    for path in write_package(kind, name, output):
        say(str(path))
    where = output / name
    say(
        "",
        f"webviz: wrote {where}. Next:",
        f"  pip install -e {where}",
        f"  pytest {where}",
        f"  webviz demo -d {where / 'demo.yaml'}",
    )
