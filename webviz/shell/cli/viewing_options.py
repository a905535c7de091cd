"""The options of the commands that serve a page."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import msgspec
from cyclopts import Group, Parameter, validators

from webviz.shell.cli.amounts import memory_of
from webviz.shell.cli.comparison_options import ComparisonOptions
from webviz.shell.cli.options import ConfigOptions, File, Flag, Repeatable

if TYPE_CHECKING:
    from webviz.files.config import Config
    from webviz.sources import Source

LOCAL = "127.0.0.1"
BAG = Parameter(group=Group("A bag instead of live topics", sort_key=2))


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class BagOptions(ComparisonOptions):
    """The bag to play, and a second one."""

    bag: Annotated[Repeatable[Path], BAG, Parameter(metavar="FILE", consume_multiple=1)] = ()
    """Play an MCAP or db3 file, a rosbag2 folder or ROS 1 bag; several are merged (repeatable)."""
    paused: Annotated[Flag, BAG] = False
    """Stay at the start of the bag, instead of playing once a browser connects."""


def _check_memory(type_: object, text: str) -> None:
    """Raise ValueError for what is not an amount of memory."""
    if text:
        memory_of(text)


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class ViewingOptions(ConfigOptions):
    """Address of the page, and what to save."""

    template: File | None = None
    """Config to start with if --display-config is not given; saving asks for a name."""
    port: Annotated[int, Parameter(validator=validators.Number(gte=0, lte=65535))] = 8080
    """Port of the page; 0 picks a free one."""
    host: Annotated[str, Parameter(metavar="ADDRESS")] = LOCAL
    """Address to listen on; 0.0.0.0 is all networks. Others than the default ask for tokens."""
    allow_host: Annotated[Repeatable[str], Parameter(metavar="NAME")] = ()
    """Host name that browsers may use with --host (repeatable)."""
    certfile: File | None = None
    """Serve https with the certificate in this PEM file, and those that it is signed with."""
    keyfile: File | None = None
    """Private key of the certificate (default: in --certfile)."""
    trust_proxy: Annotated[Repeatable[str], Parameter(metavar="ADDRESS")] = ()
    """Use the X-Forwarded headers of a proxy at this IP address or network (repeatable)."""
    link: Annotated[str, Parameter(metavar="RATE")] = ""
    """Rate of the link to each browser, such as 5Mbit/s or 500kbit/s (default: measured)."""
    token: Flag = False
    """Also ask browsers on this machine for a link with a token, see `webviz token`."""
    journal: File | None = None
    """Append to this file who published, saved and opened what; kept to 2 MB, in two files."""
    memory: Annotated[
        str, Parameter(metavar="TIME[,SIZE]", show_default=False, validator=_check_memory)
    ] = ""
    """Remember live topics, such as 120s,512MB, to rewind and save them; 0s keeps nothing."""
    config_folder: Annotated[Repeatable[Path], Parameter(metavar="FOLDER")] = ()
    """Also let the ROS parameter config_file open configs in this folder (repeatable)."""
    bag_folder: Annotated[Repeatable[Path], Parameter(name="--library", metavar="FOLDER")] = ()
    """Let owners open the bags and bug reports of this folder in the page (repeatable)."""
    allow_publish: Annotated[Repeatable[str], Parameter(metavar="NAME")] = ()
    """Let tools use this topic, service or action, besides those of the config (repeatable)."""
    no_publish: Flag = False
    """Watch only: no tool may publish, call a service or send a goal."""
    no_control: Flag = False
    """Let no parameter or service of the ROS node change the viewer."""
    autosave: Annotated[bool, Parameter(negative="--no-autosave", show_default=False)] = True
    """Keep unsaved changes in ~/.local/state/webviz, and restore them at the next start."""
    no_restore: Flag = False
    """Do not show the unsaved changes of the last session; they stay in a file beside it."""
    open: Flag = False
    """Open the page in a browser of this machine."""
    debug: Flag = False
    """Show viser's own panel beside the page."""

    def read(self, path: Path | None, source: "Source | None" = None) -> "Config":
        """Return the config, with the overrides of --set and --memory; see `ConfigOptions.read`."""
        config = super().read(path, source)
        if self.memory:
            memory = msgspec.structs.replace(config.settings.memory, **memory_of(self.memory))
            config.settings.memory = memory
        return config
