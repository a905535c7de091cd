"""`webviz new`: writes the package of a new plug-in."""

from __future__ import annotations

import importlib.util
import keyword
import re
import sys
from pathlib import Path
from string import Template
from typing import Annotated, Literal, get_args

from cyclopts import App, Parameter

from webviz.api.errors import Error
from webviz.files.config import write_text
from webviz.shell.cli.terminal import say

EXAMPLES = """\
Examples:
  webviz new display nearest_obstacle    a package with a display, its test and a config
  webviz new tool docking_station -o src
"""

app = App("new", help_epilogue=EXAMPLES)
Kind = Literal["display", "tool", "panel", "check"]
KINDS: tuple[Kind, ...] = get_args(Kind)
TEMPLATES = Path(__file__).with_name("templates")
NAME = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*")
"""Name of a ROS package: REP 144."""
LONGEST = 60


def write_package(kind: Kind, name: str, folder: Path) -> list[Path]:
    """Write a ROS package with one plug-in, its test and a config that shows it.

    Args:
        kind: of the plug-in.
        name: of the package; the class has it in CamelCase.
        folder: in which the folder of the package is made.

    Returns:
        The files.

    Raises:
        Error: the name is not one of a ROS package or is one of a module, the folder exists, or
            cannot be written.
    """
    if not NAME.fullmatch(name) or len(name) > LONGEST or keyword.iskeyword(name):
        raise Error(
            f"`{name[:LONGEST]}` is not the name of a ROS package. Use lower-case letters, digits "
            "and single underscores, such as `docking_station`."
        )
    if _is_taken(name):
        raise Error(
            f"Python already has a module `{name}`, which the package would hide. Choose another "
            f"name, such as `my_{name}`."
        )
    root = folder / name
    if root.exists():
        raise Error(f"{root} already exists. Choose another name, or remove it.")
    words = name.split("_")
    values = {
        "name": name,
        "cls": "".join(word.capitalize() for word in words),
        "title": " ".join(words).capitalize(),
        "kind": kind,
        "group": f"webviz.{kind}s",
        "entry": f"{name} = {name}.{kind}" if kind == "check" else "$cls = $name.$kind:$cls",
    }
    values["entry"] = Template(values["entry"]).substitute(values)
    written = []
    for template, target in _files(kind, name).items():
        text = (TEMPLATES / f"{template}.txt").read_text(encoding="utf-8") if template else ""
        path = root / target
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise Error(f"Cannot make {path.parent}: {error.strerror}.") from error
        write_text(Template(text).substitute(values), path)
        written.append(path)
    return written


def _is_taken(name: str) -> bool:
    """Return whether Python or an installed package has a module of this name."""
    if name in sys.stdlib_module_names:
        return True
    try:
        spec = importlib.util.find_spec(name)
    except (ImportError, ValueError):
        return True
    # A folder that only has this name is none.
    return spec is not None and spec.origin is not None


def _files(kind: Kind, name: str) -> dict[str, str]:
    """Path in the package by name of the template."""
    return {
        "README.md": "README.md",
        "package.xml": "package.xml",
        "setup.py": "setup.py",
        "setup.cfg": "setup.cfg",
        "resource": f"resource/{name}",
        "__init__.py": f"{name}/__init__.py",
        f"{kind}.py": f"{name}/{kind}.py",
        f"{kind}.yaml": "demo.yaml",
        f"test_{kind}.py": f"test/test_{name}.py",
    }


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
