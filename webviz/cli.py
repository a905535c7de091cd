"""The command line: `webviz`, `webviz demo`, `webviz convert` and `webviz screenshot`."""

from __future__ import annotations

import argparse
import contextlib
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

import msgspec

from webviz import config as config_file
from webviz import convert, plugins, screenshot
from webviz.config import Config, ConfigError

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
NO_ROS = (
    "webviz needs rclpy of ROS 2 Jazzy, which this Python ({version}) does not have: run "
    "`source /opt/ros/jazzy/setup.bash` if ROS is installed, or `pip install 'webviz[ros]'`."
)


class UserError(Exception):
    """Something the user can put right; one sentence."""


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
        if own[:1] == ["screenshot"]:
            return screenshot.run(own[1:], ros)
        options = _parser().parse_args(own)
        if options.command == "demo":
            with _simulator(ros):
                _serve(options, ros)
        else:
            _serve(options, ros)
    except (UserError, ConfigError, plugins.PluginError) as error:
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
    parser = argparse.ArgumentParser(
        prog="webviz",
        description="RViz2 in a browser tab: shows a ROS 2 robot on a web page.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add = parser.add_argument
    add("command", nargs="?", choices=["demo"], help="demo: start a simulated robot as well")
    add("-d", "--display-config", type=Path, metavar="FILE", help="config to open (YAML or .rviz)")
    add(
        "--plugin",
        type=Path,
        action="append",
        default=[],
        metavar="FILE",
        help="Python file with displays, loaded again whenever it is saved (repeatable)",
    )
    add("-f", "--fixed-frame", metavar="FRAME", help="frame that everything is drawn in")
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
    add("--ros-args", action="store_true", help="arguments for ROS follow, up to `--`")
    return parser


def _serve(options: argparse.Namespace, ros: Sequence[str]) -> None:
    """Show the page until Ctrl-C or SIGTERM."""
    watcher = plugins.Watcher(options.plugin)
    for path in options.plugin:
        plugins.load(path)
    config = _config(options)
    with contextlib.ExitStack() as stack:
        # viser takes a while to import; --help and errors in the config come before.
        from webviz.gui import Panel
        from webviz.scene import CannotListen, Scene, open_server, set_view
        from webviz.viewer import Viewer

        try:
            server = open_server(options.host, options.port, options.allow_host)
        except CannotListen as error:
            raise UserError(str(error)) from error
        stack.callback(server.stop)
        set_view(server, config.settings.view)
        source = ros_source(ros)
        stack.callback(source.close)
        viewer = Viewer(
            config,
            source,
            Scene(server),
            lambda state: panel.update(state),
            path=options.display_config,
            autosave=_last_session() if options.autosave else None,
        )
        panel = Panel(server, viewer.enqueue)
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, lambda *_: viewer.stop())
        watcher.start(viewer.enqueue)
        stack.callback(watcher.stop)
        _announce(options, server.get_port())
        viewer.run()
        print("\nwebviz: stopped.")


def _announce(options: argparse.Namespace, port: int) -> None:
    local = options.host in ("127.0.0.1", "localhost", "::1")
    host = options.host if options.host not in ("0.0.0.0", "::") else "127.0.0.1"
    print(f"webviz: open http://{f'[{host}]' if ':' in host else host}:{port} (Ctrl-C ends it)")
    if not local:
        names = ", ".join(options.allow_host) or "the address given with --host only"
        print(
            f"webviz: whoever reaches {options.host}:{port} can watch and change this viewer; "
            f"browsers must address it as: {names}."
        )
    sys.stdout.flush()


def _last_session() -> Path:
    """Where the last session is kept, by the XDG base directory specification."""
    home = os.environ.get("XDG_STATE_HOME") or Path.home() / ".local" / "state"
    return Path(home) / "webviz" / "last.yaml"


def _config(options: argparse.Namespace) -> Config:
    path = options.display_config
    if path is None and options.autosave and _last_session().exists():
        path = _last_session()
    if path is None and options.command == "demo":
        path = DEMO
    config = config_file.standard() if path is None else config_file.load(path)
    if path is not None:
        convert.tell(path, config.report)
    if options.fixed_frame:
        config.settings = msgspec.structs.replace(
            config.settings, fixed_frame=options.fixed_frame.removeprefix("/")
        )
    return config


def ros_source(ros: Sequence[str]):
    """The ROS graph, as the arguments for ROS say.

    Raises:
        UserError: there is no ROS, or it does not start.
    """
    try:
        from webviz.ros.node import RosSource
    except ImportError as error:
        raise UserError(NO_ROS.format(version=sys.version.split()[0])) from error
    try:
        return RosSource(ros)
    except Exception as error:  # rclpy has no common base: bad arguments, no RMW, no network
        reason = " ".join(str(error).split()).partition(", at /")[0]
        raise UserError(f"ROS did not start: {reason}.") from error


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
            raise UserError(f"the simulator ended by itself with status {status}.")
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
        raise UserError(NO_ROS.format(version=sys.version.split()[0]))
