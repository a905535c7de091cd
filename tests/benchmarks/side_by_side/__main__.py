"""The command line: which systems on which scenes, in interleaved rounds."""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
import time
from dataclasses import asdict
from pathlib import Path

from side_by_side import table
from side_by_side.case import CaseFailed, CaseResult, Load, run
from side_by_side.figures import rows
from side_by_side.scenes import SCENES
from side_by_side.systems.registry import SYSTEMS

LOADS = {str(load): load for load in (Load(0), Load(1), Load(4), Load(1, 1))}
THE_CALLBACK = [Load(1)]
"""The floor has no clients but itself."""


def main() -> int:
    """Measure, print a table and write JSON."""
    options = _options()
    cases: list[tuple[str, str, CaseResult]] = []
    failures: list[tuple[str, str, str]] = []
    for number in range(options.rounds):
        for scene in options.scenes:
            for system in options.systems:
                print(f"round {number + 1}: {scene}, {system}", file=sys.stderr, flush=True)
                loads = [LOADS[name] for name in options.clients]
                if not SYSTEMS[system].is_served:
                    loads = THE_CALLBACK
                try:
                    with tempfile.TemporaryDirectory() as folder:
                        result = run(
                            SYSTEMS[system],
                            SCENES[scene],
                            loads,
                            options.seconds,
                            Path(folder),
                            options.patience,
                        )
                except (CaseFailed, OSError) as error:
                    reason = " ".join(str(error).split())
                    print(f"  failed: {reason}", file=sys.stderr)
                    failures.append((scene, system, reason))
                else:
                    cases.append((scene, system, result))
    measured = rows(cases)
    facts = {
        "machine": table.machine(),
        "versions": table.versions(options.systems),
        "date": time.strftime("%Y-%m-%d"),
        "seconds": options.seconds,
        "rounds": options.rounds,
    }
    print("\n".join(table.markdown(measured, failures)))
    if options.json:
        figures = [asdict(row) for row in measured]
        report = {**facts, "rows": figures, "failures": failures}
        options.json.write_text(json.dumps(report, indent=1) + "\n")
    return 0 if cases else 1


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="side_by_side", description=__doc__)

    def names(known: dict) -> dict:
        choices = ", ".join(known)
        return {"nargs": "+", "default": list(known), "choices": list(known), "help": choices}

    parser.add_argument("--scenes", **names(SCENES))
    parser.add_argument("--systems", **names(SYSTEMS))
    parser.add_argument("--clients", **names(LOADS))
    parser.add_argument("--seconds", type=float, default=8.0, help="of each load (default: 8)")
    parser.add_argument("--rounds", type=int, default=3, help="interleaved (default: 3)")
    parser.add_argument(
        "--patience",
        type=float,
        default=10.0,
        help="seconds to wait, before each load, for other programs to rest (default: 10)",
    )
    parser.add_argument("--json", type=Path, help="file for all figures")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
