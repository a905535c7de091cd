"""The commands of webviz: runs one, and turns errors into a message and exit status."""

from __future__ import annotations

import logging
import sys
from collections.abc import Sequence
from pathlib import Path

from cyclopts import (
    App,
    Argument,
    CoercionError,
    CycloptsError,
    Group,
    MissingArgumentError,
    Parameter,
    Token,
    UnusedCliTokensError,
    ValidationError,
)

from webviz.api.errors import Error, UsageError
from webviz.shell.cli import viewing
from webviz.shell.cli.options import ROS_ARGS_HELP
from webviz.shell.cli.terminal import LogFormatter, warn

FAILED, WRONG_USAGE = 1, 2
CONFIG, BAG = "--display-config", "--bag"
OPENERS = {
    **dict.fromkeys((".rviz", ".yaml", ".yml"), CONFIG),
    **dict.fromkeys((".mcap", ".db3", ".bag", ".zst", ".zstd", ".lz4"), BAG),
}
"""Options that open a file, by the end of its name."""
OPENING = {
    **dict.fromkeys(("doctor", "export", "report", "screenshot", "test"), (CONFIG, BAG)),
    "frames": (BAG,),
}
"""Options that a command has, by its name."""
KINDS = {int: "a whole number", float: "a number"}

app = App(
    "webviz",
    help="RViz2 in a browser tab: show a ROS 2 robot on a web page.",
    usage="Usage: webviz [COMMAND] [OPTIONS]",
    help_format="plaintext",
    help_epilogue=viewing.EXAMPLES + ROS_ARGS_HELP,
    version=lambda: version(),
    group_parameters=Group("Options", sort_key=1),
    default_parameter=Parameter(negative=(), allow_repeating=True),
)
app.default(viewing.view, validator=viewing.check)
app.command(viewing.demo, help_epilogue=ROS_ARGS_HELP)
for name, summary in {
    "screenshot": "Save pictures of a config without a screen, live or from a bag.",
    "export": "Write a part of a bag as one HTML file that opens without a server.",
    "record": "Record topics to MCAP files that ROS 2 plays.",
    "recover": "Recover the readable part of a damaged or unfinished bag.",
    "report": "Write a bug report of a bag or of live topics, which webviz opens again.",
    "open": "Open a bug report; `webviz FILE.zip` does the same.",
    "doctor": "Find out why data is not shown, live or in a bag, without a browser.",
    "frames": "Print or draw the tree of transforms, live or of a bag.",
    "test": "Check that rules hold, over a bag or live topics, for CI.",
    "convert": "Convert a config between RViz's format (*.rviz) and webviz's (any other name).",
    "token": "List, make, rotate and revoke the links by which others may use a viewer.",
    "mcp": "Let agents see, ask and act over the Model Context Protocol.",
    "new": "Write a ROS package with a display, tool, panel or check of your own.",
    "schema": "Write the JSON Schema of config files, for completion and checks in editors.",
}.items():
    # Imported when called, which makes --help a third faster.
    app.command(f"webviz.shell.cli.{name}:app", name=name, help=summary)


def run(arguments: Sequence[str] | None = None) -> int:
    """Run a command and print its error, if any.

    Returns:
        The exit status: 0 (also after Ctrl-C), 1 after an error, 2 for invalid arguments.
        `webviz screenshot` has more.
    """
    own, ros = split_ros_arguments(sys.argv[1:] if arguments is None else arguments)
    terminal = logging.StreamHandler()
    terminal.setFormatter(LogFormatter())
    logging.basicConfig(handlers=[terminal], level=logging.WARNING)
    try:
        command, bound, unparsed = app.parse_args(
            with_openers(own), exit_on_error=False, print_error=False, verbose=False
        )
        if "ros" in unparsed:
            bound.arguments["ros"] = ros
        return command(*bound.args, **bound.kwargs) or 0
    except CycloptsError as error:
        warn(f"webviz: {_mistake(error)}")
        return WRONG_USAGE
    except Error as error:
        warn(f"webviz: {error}")
        return WRONG_USAGE if isinstance(error, UsageError) else FAILED


def version() -> str:
    """Return the version of this package."""
    import importlib.metadata  # here, as it takes a tenth of the time of --help

    return importlib.metadata.version("ros-webviz")


def split_ros_arguments(arguments: Sequence[str]) -> tuple[list[str], list[str]]:
    """webviz's own arguments, and those from each `--ros-args` to the next `--` or the end."""
    own: list[str] = []
    ros: list[str] = []
    target = own
    for argument in arguments:
        if argument == "--ros-args":
            target = ros
        target.append(argument)
        if argument == "--" and target is ros:
            target = own
    return own, ros


def with_openers(arguments: Sequence[str]) -> list[str]:
    """Return the arguments, with what opens the files that they begin with.

    That is the command `open` of a bug report, `--display-config` of a config and `--bag` of a bag,
    so that `webviz lab.rviz run.mcap` and `webviz frames run.mcap` need no options.
    """
    first = arguments[0] if arguments else ""
    if first.lower().endswith(".zip") and not first.startswith("-"):
        return ["open", *arguments]
    openers = OPENING.get(first, (CONFIG, BAG))
    opened = [first] if first in OPENING else []
    begin = len(opened)
    for place, word in enumerate(arguments[begin:], begin):
        path = Path(word)
        option = OPENERS.get(path.suffix.lower(), BAG if path.is_dir() else "")
        if option not in openers or word.startswith("-") or word in app:
            return [*opened, *arguments[place:]]
        opened += [option, word]
    return opened


def _mistake(error: CycloptsError) -> str:
    """Return the error in the arguments, as a sentence."""
    match error:
        case UnusedCliTokensError() if error.unused_tokens:
            return _unused(error.unused_tokens[0], error.command_chain)
        case ValidationError(argument=None):
            return error.exception_message
        case MissingArgumentError(argument=Argument() as argument):
            metavar = argument.parameter.metavar or "a value"
            if error.keyword or argument.tokens:
                return f"{error.keyword or argument.name} needs {metavar}."
            name = f"{argument.name} {metavar}" if argument.name.startswith("-") else argument.name
            return f"`{' '.join(('webviz', *(error.command_chain or ())))}` needs {name}."
        case CoercionError(token=Token() as token, msg=None) if error.target_type in KINDS:
            kind = KINDS[error.target_type]
            return f"Invalid value for {token.keyword}: `{token.value}` is not {kind}."
    return str(error)


def _unused(word: str, command_chain: Sequence[str] | None) -> str:
    """Return the error for an argument that no option or command takes."""
    from webviz.files.config import nearest

    if command_chain:
        return f"Unexpected argument for `webviz {command_chain[0]}`: `{word}`."
    commands = [name for name in app if not name.startswith("-")]
    if word in commands:
        return f"The command must come first: `webviz {word} ...`."
    if "." in word:
        return f"Unknown command `{word}`. To open it as a config, run `webviz -d {word}`."
    return f"Unknown command `{word}`: {nearest(word, commands)}"
