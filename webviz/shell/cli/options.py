"""Options that several commands share."""

# Without `from __future__ import annotations`: cyclopts would resolve the annotations of a base
# class in the module of the subclass.
import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

from cyclopts import Parameter

from webviz.api.errors import Error
from webviz.shell.cli.amounts import bytes_of
from webviz.shell.cli.terminal import warn

if TYPE_CHECKING:
    from webviz.files.config import Config
    from webviz.sources import Source

T = TypeVar("T")
Repeatable = Annotated[tuple[T, ...], Parameter(show_default=False)]
"""An option that can be repeated."""
Flag = Annotated[bool, Parameter(show_default=False)]
File = Annotated[Path, Parameter(metavar="FILE")]
Plugins = Annotated[
    Repeatable[Path],
    Parameter(
        metavar="FILE",
        help="Load plug-ins from a Python file (repeatable).",
    ),
]
RosArgs = Annotated[Sequence[str], Parameter(parse=False)]
"""Arguments for ROS, split off by `webviz.shell.cli.commands` before parsing."""
MESH_ROOT = "WEBVIZ_MESH_ROOT"
"""Environment variable for the folders of --mesh-root, separated by colons."""
ROS_ARGS_HELP = "Arguments after --ros-args, up to `--` or the end, are passed to ROS."


def _size(type_: object, tokens: object) -> int:
    """Convert the value of an option of bytes."""
    (token,) = tokens  # pyright: ignore[reportGeneralTypeIssues]
    return bytes_of(token.value)


Size = Annotated[int, Parameter(converter=_size, metavar="SIZE", show_default=False)]


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class ConfigOptions:
    """The config to show, and changes to it for this run."""

    display_config: Annotated[File | None, Parameter(alias="-d")] = None
    """Config to show (YAML or .rviz)."""
    fixed_frame: Annotated[str, Parameter(alias="-f", metavar="FRAME", show_default=False)] = ""
    """Draw everything in this frame."""
    set: Annotated[Repeatable[str], Parameter(metavar="PATH=VALUE")] = ()
    """Override a value of the config, such as displays.Scan.size=0.1 (repeatable)."""
    plugin: Plugins = ()
    mesh_root: Annotated[Repeatable[Path], Parameter(metavar="FOLDER")] = ()
    """Also load meshes and textures from this folder (default: ROS packages; repeatable)."""

    def read(self, path: Path | None, source: "Source | None" = None) -> "Config":
        """Return the config of a file, or the default one of a source, with the overrides of --set.

        Raises:
            Error: the file cannot be read, or an override is invalid.
        """
        from webviz.files.config.overrides import override
        from webviz.shell.app.reading import read_config

        config = read_config(path, source)
        if path is not None:
            report_unsupported(path, config.report)
        return override(config, self.set)

    def config_of(self, source: "Source | None") -> "Config":
        """Return the config to show of a source: in the given frame, with the second run of a bag.

        Raises:
            Error: see `read`.
        """
        from webviz.engine.parts.comparison_config import with_comparison
        from webviz.shell.bag_player import bag_of

        config = self.read(self.display_config, source)
        if self.fixed_frame:
            config.set_fixed_frame(self.fixed_frame)
        bag = bag_of(source)
        return with_comparison(config, bag) if bag and bag.comparison else config

    def allow_meshes(self) -> None:
        """Add the mesh roots to the environment variable.

        Raises:
            Error: a root is not a folder.
        """
        for root in self.mesh_root:
            if not root.is_dir():
                raise Error(f"--mesh-root {root} is not a folder.")
        former = os.environ.get(MESH_ROOT, "")
        roots = [str(root.absolute()) for root in self.mesh_root]
        os.environ[MESH_ROOT] = os.pathsep.join([*roots, *filter(None, [former])])


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class ConnectOptions:
    """The bridge or Zenoh router whose topics are live, instead of the ROS graph."""

    connect: Annotated[str, Parameter(metavar="URL", show_default=False)] = ""
    """Connect without ROS here: to a bridge, such as ws://robot:8765 of foxglove_bridge or
    ws://robot:9090 of rosbridge, or over Zenoh: tcp/robot:7447, tls/…, several with commas, or a
    session config such as zenoh.json5."""
    connect_headers: File | None = None
    """File with headers for the bridge, such as `Authorization: Bearer TOKEN`, one a line."""

    def check(self, has_bag: bool) -> None:
        """Raise ValueError for an invalid combination of arguments.

        Args:
            has_bag: whether a bag is given.
        """
        if self.connect and has_bag:
            raise ValueError("Give either --bag or --connect.")
        if self.connect_headers and not self.connect:
            raise ValueError("--connect-headers needs --connect.")

    def source(self, ros: Sequence[str], config: "Config | None" = None) -> "Source":
        """Return the topics of the bridge, or of the ROS graph if none is given.

        Args:
            ros: arguments for ROS.
            config: whose robots may have connections of their own.

        Raises:
            Error: the connection is invalid, or ROS is missing or does not start.
        """
        from webviz.shell.cli.terminal import progress
        from webviz.shell.live_source import live_source

        progress(f"connecting to {self.connect}" if self.connect else "starting ROS", 0.0)
        robots = config.settings.robots if config else ()
        return live_source(self.connect, self.connect_headers, ros, robots)


def check_source(
    *, options: Any = None, connect: ConnectOptions = ConnectOptions(), **_: object
) -> None:
    """Validate the arguments of a command whose options have a bag; raise ValueError if invalid."""
    connect.check(options is not None and options.bag is not None)


def report_unsupported(path: Path, sentences: Sequence[str]) -> None:
    """Print to standard error which parts of a file are unsupported."""
    if sentences:
        warn(f"webviz: parts of {path} are unsupported:")
        for sentence in sentences:
            warn(f"  {sentence}")
