"""`webviz` and `webviz demo`; slow imports wait until a command runs."""

from webviz.shell.cli.ending import Stop, until_signal
from webviz.shell.cli.options import RosArgs
from webviz.shell.cli.viewing_options import ViewingOptions

EXAMPLES = """\
Examples:
  webviz                          show the usual topics of the ROS graph
  webviz -d lab.yaml -f odom      open a config, in another fixed frame
  webviz -d nav2.rviz             open a config of RViz
  webviz --plugin my_display.py   load your own display, see the README
  webviz demo                     show a simulated robot
  webviz screenshot -d lab.yaml --bag run.mcap -o lab.png
  webviz --ros-args -p use_sim_time:=true -r /scan:=/front/scan

Run `webviz COMMAND --help` for the options of a command.
"""


def view(*, options: ViewingOptions = ViewingOptions(), ros: RosArgs) -> int:
    """Serve the page until Ctrl-C or SIGTERM."""

    def work(stop: Stop) -> int:
        from webviz.shell.cli.serving import serve

        return serve(options, ros, stop)

    return until_signal(work)


def demo(*, options: ViewingOptions = ViewingOptions(), ros: RosArgs) -> int:
    """Serve the page with a simulated robot."""

    def work(stop: Stop) -> int:
        from webviz.shell.cli.serving import DEMO, serve
        from webviz.shell.cli.simulator import simulator

        with simulator(ros, stop):
            return serve(options, ros, stop, DEMO)

    return until_signal(work)
