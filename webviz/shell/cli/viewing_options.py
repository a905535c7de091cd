"""The options of the commands that serve a page."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter, validators

from webviz.shell.cli.options import ConfigOptions, Flag, Repeatable

LOCAL = "127.0.0.1"


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class ViewingOptions(ConfigOptions):
    """Where the page is served, and what is kept."""

    port: Annotated[int, Parameter(validator=validators.Number(gte=0, lte=65535))] = 8080
    """Port of the page; 0 picks a free one."""
    host: Annotated[str, Parameter(metavar="ADDRESS")] = LOCAL
    """Address to listen on; the default is this machine only, 0.0.0.0 is everybody."""
    allow_host: Annotated[Repeatable[str], Parameter(metavar="NAME")] = ()
    """With --host: a name under which browsers may reach this machine (repeatable)."""
    config_folder: Annotated[Repeatable[Path], Parameter(metavar="FOLDER")] = ()
    """Let the ROS parameter config_file open configs below this folder, too (repeatable)."""
    autosave: Flag = False
    """Keep the last session in ~/.local/state/webviz, and begin with it unless -d is given."""
