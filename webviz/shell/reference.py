"""Pages generated from the command line, the config's keys and the Python API: `make docs`."""

from __future__ import annotations

import importlib
import inspect
import re
import typing
from collections.abc import Callable, Iterator

import msgspec
from cyclopts import App, Group
from cyclopts.argument import Argument, ArgumentCollection

from webviz.files.config.schema import schema
from webviz.files.rviz.docs import table
from webviz.server.access.roles import LINKS
from webviz.server.access.tokens import role_name
from webviz.shell.cli.commands import app
from webviz.shell.cli.options import MESH_ROOT
from webviz.shell.pictures.browser import VARIABLE
from webviz.sources.zenoh.address import PASSWORD, USER
from webviz_urdf.expand import ALLOWED_BY

COMMAND = "make docs"
ENVIRONMENT = {
    "WEBVIZ_CONNECT_HEADERS": "Headers for the bridge of `--connect`, with tokens, one a line.",
    USER: "User for a Zenoh router that asks for one.",
    PASSWORD: "Password of that user.",
    VARIABLE: "Chromium or Chrome for pictures; otherwise one is searched for.",
    MESH_ROOT: "Folders of meshes besides ROS packages, separated by colons: `--mesh-root`.",
    ALLOWED_BY: "`1` lets RobotModel expand xacro files, which can run any Python as this user.",
    "WEBVIZ_TILE_SERVERS": "Addresses whose map tiles may be loaded, by their beginnings.",
    "WEBVIZ_BAG": "Recording for tests of bug reports, instead of the one beside them.",
    **{
        f"WEBVIZ_TOKEN_{parameter.upper()}": f"Token of a link with the role {role_name(role)}."
        for parameter, role in LINKS.items()
    },
    "XDG_CONFIG_HOME": "Folder of `webviz/tokens.json`, by default `~/.config`.",
    "XDG_CACHE_HOME": "Folder of map tiles from servers in `webviz/`, by default `~/.cache`.",
    "XDG_STATE_HOME": "Folder of the last session in `webviz/`, by default `~/.local/state`.",
    "ROS_DOMAIN_ID": "As for any ROS 2 node, like all other variables of ROS; "
    "`webviz demo` sets `ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST` unless it is set.",
}
"""Environment variables by name."""


def reference_page() -> str:
    """Commands with their options, keys of the config file, and environment variables."""
    lines = ["# Reference", "", "## Commands", ""]
    global_options: set[str] = set()
    for words, command in _commands(app, ("webviz",)):
        arguments = command.assemble_argument_collection(parse_docstring=True)
        rows = list(_options(arguments, global_options))
        global_options |= {name for name, *_ in rows} if words == ("webviz",) else set()
        summary = command.help.partition("\n")[0]
        more = " Besides, options of `webviz`." if len(words) > 1 and _shares(arguments) else ""
        lines += [f"### {' '.join(words)}", "", summary + more, ""]
        lines += [*table(("option", "default", "what it does"), rows), ""] if rows else []
    lines += ["## Keys of a config file", "", *table(("key", "default", "what it is"), _keys())]
    lines += ["", "## Environment variables", ""]
    lines += table(("variable", "meaning"), [(f"`{k}`", v) for k, v in ENVIRONMENT.items()])
    return "\n".join([*lines, "", f"Written by `{COMMAND}`.", ""])


def _commands(app: App, words: tuple[str, ...]) -> Iterator[tuple[tuple[str, ...], App]]:
    """Yield the commands of a program, each with the words that call it."""
    if app.default_command is not None:
        yield words, app
    for name in app:
        if not name.startswith("-"):
            yield from _commands(app[name], (*words, name))


def _options(arguments: ArgumentCollection, flag_names: set[str]) -> Iterator[tuple[str, str, str]]:
    for each in sorted(arguments, key=_place):
        # Assembled apart from the program, subcommands lack its rule against negative names.
        names = [each.names[0], *(name for name in each.names if name[:2] != "--")]
        flags = ", ".join(f"`{name}`" for name in dict.fromkeys(names))
        if each.show and flags not in flag_names:
            value = each.field_info.default
            has_default = each.parameter.show_default is None and value not in (None, "")
            is_given = isinstance(value, int | float | str) and not isinstance(value, bool)
            default = f"`{value}`" if has_default and is_given else ""
            yield flags, default, " ".join((each.parameter.help or "").split()).replace("|", "\\|")


def _place(argument: Argument) -> int:
    """Return the place of the group of an option, as in --help."""
    groups = typing.cast(tuple[Group, ...], argument.parameter.group or ())  # once it is assembled
    return min((group.sort_key or 0 for group in groups), default=0)


def _shares(arguments: ArgumentCollection) -> bool:
    return any("--display-config" in each.names for each in arguments)


def _keys() -> Iterator[tuple[str, str, str]]:
    for name, key in schema({}, {}, {})["properties"].items():
        default = msgspec.json.encode(key.get("default")).decode()
        is_short = name != "version" and default not in ("null", "[]") and len(default) < 20
        yield f"`{name}`", f"`{default}`" if is_short else "", key["description"]


def api_page() -> str:
    """Return the names that `import webviz` offers."""
    lines = ["# Python API", "", "All names are in the module `webviz`.", ""]
    package = importlib.import_module("webviz")  # whose names come from the rooms below, too
    for name in sorted(package.__all__):
        thing = getattr(package, name)
        lines += [f"## {name}", "", *_paragraphs(thing), ""]
        if inspect.isclass(thing):
            lines += _members(thing)
    return "\n".join([*lines, f"Written by `{COMMAND}`.", ""])


def _members(cls: type) -> list[str]:
    rows: list[tuple[str, str]] = []
    for base in reversed(cls.__mro__):
        if base.__module__.split(".")[0] != "webviz":
            continue
        for name, member in vars(base).items():
            if name.startswith("_") or not (inspect.isfunction(member) or _is_property(member)):
                continue
            text = next(iter(_paragraphs(getattr(cls, name))), "")
            call = f"`{name}`" if _is_property(member) else f"`{name}{_parameters(member)}`"
            rows = [row for row in rows if row[0].strip("`").partition("(")[0] != name]
            rows.append((call.replace("|", "\\|"), text.replace("|", "\\|")))
    return [*table(("member", ""), rows), ""] if rows else []


def _is_property(member: object) -> bool:
    return isinstance(member, property)


def _parameters(function: Callable[..., object]) -> str:
    """Return the parameters of a method by name, without annotations."""
    parameters = list(inspect.signature(function).parameters.values())[1:]
    plain = [each.replace(annotation=inspect.Parameter.empty) for each in parameters]
    # Those have addresses.
    plain = [
        each.replace(default=...)
        if callable(each.default) and each.default is not each.empty
        else each
        for each in plain
    ]
    return str(inspect.Signature(plain))


def _paragraphs(thing: object) -> list[str]:
    """Return a docstring, one line per paragraph, with its sections as lists."""
    alias = typing.get_origin(thing) is not None
    text = f"An alias of `{thing}`." if alias else inspect.getdoc(thing) or ""
    return [line for part in text.split("\n\n") for line in (*_paragraph(part), "")][:-1]


def _paragraph(text: str) -> list[str]:
    heading, _, rest = text.partition("\n")
    if not re.fullmatch(r"[A-Z]\w+:", heading):
        return [" ".join(text.split())]
    entries = re.split(r"\n(?=    \S)", f"\n{rest}")[1:]
    return [heading, "", *(f"- {' '.join(entry.split())}" for entry in entries)]
