"""The command line: which systems on which scenes, in interleaved rounds."""

from __future__ import annotations

import argparse
import contextlib
import itertools
import json
import signal
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from side_by_side import machine, report
from side_by_side.case import CaseFailed, CaseResult, Load, run
from side_by_side.figures import rows
from side_by_side.scenes import SCENES
from side_by_side.small_computer import NoControlGroups, small_computer
from side_by_side.systems.registry import SYSTEMS

USUAL = (Load(1),)
LOADS = {str(load): load for load in (Load(0), *USUAL, Load(1, 1), Load(4), Load(30))}
THE_CALLBACK = [Load(1)]
"""The floor has no clients but itself."""

Cases = list[tuple[str, str, CaseResult]]
"""Scene, system and what was measured."""


def main() -> int:
    """Measure, print a table and write JSON; Ctrl-C or SIGTERM ends it with what there is."""
    for number in (signal.SIGINT, signal.SIGTERM):  # a shell lets its background ignore Ctrl-C
        signal.signal(number, signal.default_int_handler)
    options = _options()
    cases: Cases = []
    failures: list[tuple[str, str, str]] = []
    with contextlib.suppress(KeyboardInterrupt):
        for number in range(options.rounds):
            for scene, system in itertools.product(options.scenes, options.systems):
                print(f"round {number + 1}: {scene}, {system}", file=sys.stderr, flush=True)
                try:
                    cases.append((scene, system, _case(scene, system, options)))
                except (CaseFailed, NoControlGroups, OSError) as error:
                    reason = " ".join(str(error).split())
                    print(f"  failed: {reason}", file=sys.stderr)
                    failures.append((scene, system, reason))
                if options.json:
                    options.json.write_text(f"{_report(options, cases, failures)}\n")
    if cases:
        contents = json.loads(_report(options, cases, failures))
        print(report.facts(contents), report.table([contents], report.TITLES), sep="\n\n")
    return 0 if cases else 1


def _report(options: argparse.Namespace, cases: Cases, failures: list[tuple[str, str, str]]) -> str:
    facts = {
        **machine.machine(),
        "commit": machine.commit(),
        "versions": machine.versions(options.systems),
        "date": time.strftime("%Y-%m-%d"),
        "seconds of each load": options.seconds,
        "rounds": options.rounds,
        "cores": options.cores,
    }
    contents = {**facts, "rows": rows(cases), "failures": failures}
    return json.dumps(contents, indent=1, default=asdict)


def _case(scene: str, system: str, options: argparse.Namespace) -> CaseResult:
    loads = [LOADS[name] for name in options.clients]
    if not SYSTEMS[system].is_served:
        loads = THE_CALLBACK
    with (
        tempfile.TemporaryDirectory() as folder,
        small_computer(options.cores, options.memory) as computer,
    ):
        where = Path(folder)
        seconds, patience = options.seconds, options.patience
        return run(SYSTEMS[system], SCENES[scene], loads, seconds, where, patience, computer)


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="side_by_side", description=__doc__)

    def names(available: dict[str, Any], usual: Sequence[object] = ()) -> dict[str, Any]:
        default, choices = [str(name) for name in usual or available], ", ".join(available)
        return {"nargs": "+", "default": default, "choices": list(available), "help": choices}

    parser.add_argument("--scenes", **names(SCENES))
    parser.add_argument("--systems", **names(SYSTEMS))
    parser.add_argument("--clients", **names(LOADS, USUAL))
    parser.add_argument("--seconds", type=float, default=8.0, help="of each load (default: 8)")
    parser.add_argument("--rounds", type=int, default=3, help="interleaved (default: 3)")
    parser.add_argument(
        "--patience",
        type=float,
        default=10.0,
        help="seconds to wait, before each load, for other programs to rest (default: 10)",
    )
    parser.add_argument(
        "--cores",
        type=float,
        help="of the system alone, in a control group, such as 0.2 (default: the machine's)",
    )
    parser.add_argument(
        "--memory", type=int, default=1000, help="of that group in MB (default: 1000)"
    )
    parser.add_argument("--json", type=Path, help="file for all figures")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
