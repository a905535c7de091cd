"""`webviz` and `webviz demo`; slow imports wait until a command runs."""

from typing import Annotated

from cyclopts import Parameter, validators

from webviz.shell.cli.ending import Stop, until_signal
from webviz.shell.cli.options import ConnectOptions, Repeatable, RosArgs
from webviz.shell.cli.viewing_options import BagOptions, ViewingOptions
from webviz_sim.options import fault_parameter

EXAMPLES = """\
Examples:
  webviz                          show the usual topics of the ROS graph
  webviz lab.yaml -f odom         open a config, in another fixed frame
  webviz nav2.rviz                open a config of RViz; -d opens one whatever its name
  webviz run.mcap                 play a bag, without ROS; --bag plays one whatever its name
  webviz --bag today.mcap --ghost yesterday.mcap
  webviz --connect ws://robot:8765
                                  show a robot through its bridge, without ROS
  webviz --plugin my_display.py   load your own display, see the README
  webviz demo                     show a simulated robot
  webviz demo --robots 3          show several, each in a namespace of its own
  webviz record -o run            record all topics
  webviz screenshot lab.yaml run.mcap -o lab.png
  webviz --ros-args -p use_sim_time:=true -r /scan:=/front/scan

Run `webviz COMMAND --help` for the options of a command.
"""


def check(
    *,
    bag: BagOptions = BagOptions(),
    connect: ConnectOptions = ConnectOptions(),
    **_: object,
) -> None:
    """Raise ValueError for an invalid combination of arguments."""
    if bag.paused and not bag.bag:
        raise ValueError("--paused needs --bag.")
    connect.check(bool(bag.bag))
    bag.check_comparison(bool(bag.bag))


def view(
    *,
    bag: BagOptions = BagOptions(),
    connect: ConnectOptions = ConnectOptions(),
    options: ViewingOptions = ViewingOptions(),
    ros: RosArgs,
) -> int:
    """Serve the page until Ctrl-C or SIGTERM."""

    def work(stop: Stop) -> int:
        from webviz.shell.cli.serving import serve

        return serve(options, ros, stop, bag=bag, connect=connect)

    return until_signal(work)


def _check_fault(type_: object, fault: str) -> None:
    """Raise ValueError for a fault that the simulator does not have."""
    fault_parameter(fault)


def demo(
    *,
    robots: Annotated[int, Parameter(validator=validators.Number(gte=1, lte=20))] = 1,
    fault: Annotated[
        Repeatable[Annotated[str, Parameter(validator=_check_fault)]],
        Parameter(metavar="NAME=VALUE"),
    ] = (),
    zenoh: Annotated[bool, Parameter(negative=())] = False,
    options: ViewingOptions = ViewingOptions(),
    ros: RosArgs,
) -> int:
    """Serve the page with a simulated robot.

    Args:
        robots: How many; several have the namespaces robot1, robot2 ...
        fault: A fault to find, such as laser_yaw=0.3 (repeatable): see `webviz-sim --help`.
        zenoh: Over Zenoh without ROS: router, simulator and viewer in three processes.
        options: Of the viewer.
        ros: Arguments for ROS.
    """

    def work(stop: Stop) -> int:
        from webviz.shell.cli.demo import simulator, standard_config, zenoh_simulator
        from webviz.shell.cli.serving import serve
        from webviz.shell.domains import demo_domain

        extra = ["--robots", str(robots)] if robots > 1 else []
        extra += [word for each in fault for word in ("--fault", each)]
        if zenoh:
            with (
                standard_config(robots) as standard,
                zenoh_simulator(extra, stop) as endpoint,
            ):
                note = f"webviz: over Zenoh, --connect {endpoint} shows the demo elsewhere, too"
                link = ConnectOptions(connect=endpoint)
                return serve(options, ros, stop, standard, note, connect=link)
        with (
            standard_config(robots) as standard,
            demo_domain() as other,
            simulator([*extra, *ros], stop) as note,
        ):
            return serve(options, ros, stop, standard, "\n".join(filter(None, (other, note))))

    return until_signal(work)
