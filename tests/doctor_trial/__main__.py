"""Provokes faults with real nodes, and counts those that the doctor names: `make doctor-trial`.

Each robot and its doctor have network, processes and shared memory of their own.
"""

from __future__ import annotations

import argparse
import os
import shlex
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import msgspec

from tests.doctor_trial import bags, clocks, data, frames, graph, machine, well
from tests.doctor_trial.provocation import Provocation, written
from webviz.shell.doctor.report import DoctorReport

ALL = [*machine.ALL, *graph.ALL, *clocks.ALL, *frames.ALL, *data.ALL, *bags.ALL]
ROOT = Path(__file__).resolve().parents[2]
PATHS = ROOT, ROOT / "tests/support"
OF_ROS = ("ROS", "RMW", "FASTRTPS", "FASTDDS", "CYCLONEDDS", "AMENT", "ZENOH")
NETWORK = """
ip link set lo up
ip link add eth0 type veth peer name eth1
ip address add 192.0.2.9/24 dev eth0
ip link set eth0 up
ip link set eth1 up
ip route add default dev eth0
mount -t tmpfs -o size=1g none /dev/shm
"""
MORE = 2.5


def main() -> None:
    """Provoke faults, and print a table and the numbers."""
    parser = argparse.ArgumentParser(prog="make doctor-trial")
    parser.add_argument("names", nargs="*", help="only faults with these words in name or id")
    parser.add_argument("--jobs", type=int, default=2, help="faults at a time")
    parser.add_argument("--minutes", type=float, default=2.0, help="of a demo that is well")
    parser.add_argument("--bags", nargs="*", type=Path, default=[], help="bags that are well")
    parser.add_argument("--reports", type=Path, help="folder in which to keep the reports")
    options = parser.parse_args()
    chosen = [
        each
        for each in ALL
        if not options.names or any(word in f"{each.name} {each.id}" for word in options.names)
    ]
    print("| fault | finding | result |\n|---|---|---|", flush=True)
    named = 0
    with ThreadPoolExecutor(options.jobs) as pool:
        for each, report in zip(chosen, pool.map(report_of, chosen), strict=True):
            problem = problem_of(each, report)
            if options.reports:
                options.reports.mkdir(parents=True, exist_ok=True)
                (options.reports / f"{each.name}.json".replace("/", "-")).write_text(report)
            named += not problem
            print(f"| {each.name} | {each.id or 'none'} | {problem or 'first'} |", flush=True)
    alarms = [] if options.names else [*well.demo(options.minutes * 60), *well.bags(options.bags)]
    print(f"\nNamed first, once, with its remedy: {named} of {len(chosen)}.")
    if not options.names:
        print("\n".join(alarms) or "Nothing above a note is found where all is well.")
    sys.exit(named < len(chosen) or bool(alarms))


def problem_of(fault: Provocation, report: str) -> str:
    """Return why a report, as JSON, does not name the fault, "" if it does."""
    try:
        return fault.problem(msgspec.json.decode(report, type=DoctorReport))
    except msgspec.DecodeError:
        return f"no report: {report.strip()[-200:]}"


def report_of(fault: Provocation) -> str:
    """Provoke a fault; return the doctor's report as JSON, or what it said instead.

    A busy machine may leave the doctor too little time, which it says; it gets more then.
    """
    text = _provoked(fault)
    if '"unfinished": true' in text:
        text = _provoked(replace(fault, seconds=MORE * fault.seconds))
    return text


def _provoked(fault: Provocation) -> str:
    bare = {name: value for name, value in os.environ.items() if not name.startswith(OF_ROS)}
    bare["PYTHONPATH"] = ":".join(map(str, PATHS))
    with tempfile.TemporaryDirectory() as folder:
        written(Path(folder), fault.files)
        completed = subprocess.run(
            ["unshare", "-rnmpf", "--mount-proc", "--kill-child", "sh", "-ec", _script(fault)],
            cwd=folder,
            env=bare,
            capture_output=True,
            text=True,
            check=False,
        )
    return completed.stdout or completed.stderr


def _script(fault: Provocation) -> str:
    """Return what starts the robot and its doctor."""
    robot = shlex.join([sys.executable, "-m", "tests.doctor_trial.start", fault.name])
    here, there = map(_assigned, (fault.here, fault.there))
    examined = shlex.join([sys.executable, "-m", "webviz", "doctor", "--json"])
    if fault.is_recorded:
        return f"{NETWORK}{robot} run.mcap >&2\nenv {here} {examined} --bag run.mcap"
    if fault.apart:
        robot = f"unshare -m sh -ec {shlex.quote(f'{fault.apart}; exec {robot}')}"
    start = (
        ""
        if fault.is_alone
        else f"env {there} {robot} >&2 &\nuntil [ -e started ] || ! kill -0 $!; do sleep 0.1; done"
    )
    options = shlex.join(["--seconds", f"{fault.seconds}", *fault.options])
    return f"{NETWORK}{fault.shell}\n{start}\nenv {here} {examined} {options}"


def _assigned(variables: Mapping[str, str]) -> str:
    return shlex.join(f"{name}={value}" for name, value in variables.items())


if __name__ == "__main__":
    main()
