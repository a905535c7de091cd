"""Options that several commands have."""

from __future__ import annotations

import argparse
from pathlib import Path


def new_parser(prog: str, description: str, epilog: str) -> argparse.ArgumentParser:
    """A parser that shows its examples as they are written."""
    return argparse.ArgumentParser(
        prog=prog,
        description=description,
        epilog=epilog,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )


def add_config(parser: argparse.ArgumentParser) -> None:
    """What to show: a config, and what is different from it."""
    add = parser.add_argument
    add("-d", "--display-config", type=Path, metavar="FILE", help="config to show (YAML or .rviz)")
    add("-f", "--fixed-frame", metavar="FRAME", help="frame that everything is drawn in")
    add(
        "--set",
        action="append",
        default=[],
        metavar="PATH=VALUE",
        help="another value than the config's, such as displays.Scan.size=0.1 (repeatable)",
    )


def add_plugin(parser: argparse.ArgumentParser, note: str = "") -> None:
    """Displays from files."""
    parser.add_argument(
        "--plugin",
        type=Path,
        action="append",
        default=[],
        metavar="FILE",
        help=f"Python file with displays{note} (repeatable)",
    )


def add_ros_args(parser: argparse.ArgumentParser) -> None:
    """A place in the help for what `split_ros_arguments` takes out before."""
    parser.add_argument(
        "--ros-args", action="store_true", help="arguments for ROS follow, up to `--`"
    )
