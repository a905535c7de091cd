"""The command line: `webviz`, `webviz demo`, `webviz convert` and `webviz screenshot`."""

from __future__ import annotations

import argparse
import contextlib
import functools
import importlib.metadata
import importlib.util
import logging
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator, Sequence
from pathlib import Path

from webviz import config as config_file
from webviz.app.running import NO_ROS
from webviz.app.viewer import Viewer
from webviz.cli import convert, schema, screenshot
from webviz.cli.options import add_config, add_plugin, add_ros_args, new_parser
from webviz.config import Config
from webviz.config.overrides import override
from webviz.errors import Error

DEMO = Path(__file__).parent / "demo.yaml"
EPILOG = """\
examples:
  webviz                          show the usual topics of the robots around
  webviz -d lab.yaml -f odom      open a saved config, in another fixed frame
  webviz -d nav2.rviz             open RViz's config
  webviz convert nav2.rviz a.yaml make a config of RViz's, or the other way round
  webviz screenshot -d lab.yaml --bag run.mcap -o lab.png    a picture without a screen
  webviz --plugin my_display.py   with displays of your own, see the README
  webviz demo                     a simulated robot, nothing else needed
  webviz --ros-args -p use_sim_time:=true -r /scan:=/front/scan
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the program.

    Returns:
        The exit status: 0 after Ctrl-C, 1 after an error that is printed as one sentence.
    """
    own, ros = split_ros_arguments(sys.argv[1:] if arguments is None else arguments)
    logging.basicConfig(format="%(name)s: %(message)s", level=logging.WARNING)
    try:
        if own[:1] == ["convert"]:
            convert.run(own[1:])
            return 0
        if own[:1] == ["schema"]:
            schema.run(own[1:])
            return 0
        if own[:1] == ["screenshot"]:
            return screenshot.run(own[1:], ros)
        options = _parser().parse_args(own)
        if options.command == "demo":
            with _simulator(ros):
                _serve(options, ros)
        else:
            _serve(options, ros)
    except Error as error:
        print(f"webviz: {error}", file=sys.stderr)
        return 1
    return 0


def split_ros_arguments(arguments: Sequence[str]) -> tuple[list[str], list[str]]:
    """Our own arguments, and those between each `--ros-args` and the next `--` or the end."""
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


def _parser() -> argparse.ArgumentParser:
    parser = new_parser(
        "webviz", "RViz2 in a browser tab: shows a ROS 2 robot on a web page.", EPILOG
    )
    add = parser.add_argument
    add("command", nargs="?", choices=["demo"], help="demo: start a simulated robot as well")
    add_config(parser)
    add_plugin(parser, ", loaded again whenever it is saved")
    add("--port", type=int, default=8080, help="port of the page (default: 8080; 0: any free one)")
    add(
        "--host",
        default="127.0.0.1",
        help="address to listen on (default: 127.0.0.1, this machine only; 0.0.0.0: everybody)",
    )
    add(
        "--allow-host",
        action="append",
        default=[],
        metavar="NAME",
        help="name under which browsers may reach this machine, with --host (repeatable)",
    )
    add(
        "--autosave",
        action="store_true",
        help=f"keep the last session in {_last_session()}, and begin with it unless -d is given",
    )
    version = importlib.metadata.version("webviz")
    add("--version", action="version", version=f"webviz {version}")
    add_ros_args(parser)
    return parser


def _serve(options: argparse.Namespace, ros: Sequence[str]) -> None:
    """Show the page until Ctrl-C or SIGTERM."""
    with Viewer(
        options.display_config,
        read=functools.partial(_config, options),
        host=options.host,
        port=options.port,
        allow_hosts=options.allow_host,
        fixed_frame=options.fixed_frame or "",
        ros_args=ros,
        plugins=options.plugin,
        autosave=_last_session() if options.autosave else None,
    ) as viewer:
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, lambda *_: viewer.stop())
        _announce(options, viewer)
        viewer.wait()
    print("\nwebviz: stopped.")


def _announce(options: argparse.Namespace, viewer: Viewer) -> None:
    print(f"webviz: open {viewer.url} (Ctrl-C ends it)")
    if options.host not in ("127.0.0.1", "localhost", "::1"):
        names = ", ".join(options.allow_host) or "the address given with --host only"
        print(
            f"webviz: whoever reaches {options.host}:{viewer.port} can watch and change this "
            f"viewer; browsers must address it as: {names}."
        )
    sys.stdout.flush()


def _last_session() -> Path:
    """Where the last session is kept, by the XDG base directory specification."""
    home = os.environ.get("XDG_STATE_HOME") or Path.home() / ".local" / "state"
    return Path(home) / "webviz" / "last.yaml"


def _config(options: argparse.Namespace, path: Path | None) -> Config:
    """What to begin with; `path` is what somebody asked for."""
    if path is None and options.autosave and _last_session().exists():
        path = _last_session()
    if path is None and options.command == "demo":
        path = DEMO
    config = config_file.standard() if path is None else config_file.load(path)
    if path is not None:
        convert.tell(path, config.report)
    return override(config, options.set)


@contextlib.contextmanager
def _simulator(ros: Sequence[str]) -> Iterator[None]:
    """Run the simulator in a process of its own; if it ends by itself, so do we."""
    _ros_is_there()
    # The demo stays on this machine unless the environment says otherwise.
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    simulator = subprocess.Popen([sys.executable, "-m", "webviz_sim", *ros])
    ended = False

    def watch() -> None:
        if simulator.wait() and not ended:
            os.kill(os.getpid(), signal.SIGTERM)

    watcher = threading.Thread(target=watch, daemon=True)
    watcher.start()
    try:
        yield
        status = simulator.poll()
        if status:
            raise Error(f"the simulator ended by itself with status {status}.")
    finally:
        ended = True
        simulator.terminate()
        try:
            simulator.wait(timeout=5.0)
        except subprocess.TimeoutExpired:
            simulator.kill()
        watcher.join()


def _ros_is_there() -> None:
    if importlib.util.find_spec("rclpy") is None:
        raise Error(NO_ROS.format(version=sys.version.split()[0]))
