"""`webviz` and `webviz demo`, as far as the command line knows them: imports wait for a call."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter, validators

from webviz.cli.ending import Stop, until_signal
from webviz.cli.options import ConfigOptions, Flag, Repeatable, RosArgs

LOCAL = "127.0.0.1"
EXAMPLES = """\
Examples:
  webviz                          show the usual topics of the robots around
  webviz -d lab.yaml -f odom      open a saved config, in another fixed frame
  webviz -d nav2.rviz             open a config of RViz
  webviz --plugin my_display.py   with a display of your own, see the README
  webviz demo                     a simulated robot, nothing else needed
  webviz screenshot -d lab.yaml --bag run.mcap -o lab.png
  webviz --ros-args -p use_sim_time:=true -r /scan:=/front/scan

`webviz COMMAND --help` lists the options of a command.
"""


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


def view(*, options: ViewingOptions = ViewingOptions(), ros: RosArgs) -> int:
    """Show the page until Ctrl-C or SIGTERM."""

    def work(stop: Stop) -> int:
        from webviz.cli.serving import serve

        return serve(options, ros, stop)

    return until_signal(work)


def demo(*, options: ViewingOptions = ViewingOptions(), ros: RosArgs) -> int:
    """Show the page, and start a simulated robot as well."""

    def work(stop: Stop) -> int:
        from webviz.cli.serving import DEMO, serve
        from webviz.cli.simulator import simulator

        with simulator(ros, stop):
            return serve(options, ros, stop, DEMO)

    return until_signal(work)
