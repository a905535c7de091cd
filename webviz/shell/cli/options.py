"""Options that several commands share."""

# Annotations are no strings in modules of options: those of a base class are looked up in the
# module of the class that inherits them.
import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, TypeVar

from cyclopts import Parameter

from webviz.api.errors import Error

T = TypeVar("T")
Repeatable = Annotated[tuple[T, ...], Parameter(show_default=False)]
"""An option that may be given several times."""
Flag = Annotated[bool, Parameter(show_default=False)]
File = Annotated[Path, Parameter(metavar="FILE")]
Plugins = Annotated[
    Repeatable[Path],
    Parameter(metavar="FILE", help="Load displays from a Python file (repeatable)."),
]
RosArgs = Annotated[Sequence[str], Parameter(parse=False)]
"""The arguments for ROS, which `webviz.shell.cli.main` splits off before parsing."""
MESH_ROOT = "WEBVIZ_MESH_ROOT"
"""The environment variable with the folders of --mesh-root, separated by colons."""
ROS_ARGS_HELP = "Arguments from --ros-args up to `--` or the end go to ROS."


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class ConfigOptions:
    """What to show: a config, and how to change it for this run."""

    display_config: Annotated[File | None, Parameter(alias="-d")] = None
    """Config to show (YAML or .rviz)."""
    fixed_frame: Annotated[str, Parameter(alias="-f", metavar="FRAME", show_default=False)] = ""
    """Draw everything in this frame."""
    set: Annotated[Repeatable[str], Parameter(metavar="PATH=VALUE")] = ()
    """Override a value of the config, such as displays.Scan.size=0.1 (repeatable)."""
    plugin: Plugins = ()
    mesh_root: Annotated[Repeatable[Path], Parameter(metavar="FOLDER")] = ()
    """Open meshes and textures below this folder, too, besides ROS packages (repeatable)."""

    def allow_meshes(self) -> None:
        """Add the mesh roots to those of the environment, where every reader of meshes looks.

        Raises:
            Error: one is not a folder.
        """
        for root in self.mesh_root:
            if not root.is_dir():
                raise Error(f"--mesh-root {root} is not a folder.")
        known = os.environ.get(MESH_ROOT, "")
        roots = [str(root.absolute()) for root in self.mesh_root]
        os.environ[MESH_ROOT] = os.pathsep.join([*roots, *filter(None, [known])])
