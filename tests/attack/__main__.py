"""`make attack`: attacks a viewer, and prints what was tried and what became of it."""

from __future__ import annotations

import argparse
import random
import sys
import tempfile
from pathlib import Path

from tests.attack.report import Report
from tests.attack.run import CORPUS, KINDS, run


def main() -> int:
    """Attack as the arguments say; the exit status is 1 if a promise was broken."""
    parser = argparse.ArgumentParser(prog="make attack", description=__doc__)
    parser.add_argument("--seed", type=int, default=random.randrange(2**32))
    length = parser.add_mutually_exclusive_group()
    length.add_argument("--seconds", type=float, default=60.0, help="default: 60")
    length.add_argument("--hours", type=float)
    parser.add_argument("--only", action="append", default=[], choices=KINDS)
    parser.add_argument("--first", type=int, default=0, help="number of the first case")
    options = parser.parse_args()
    seconds = 3600 * options.hours if options.hours else options.seconds
    print(f"seed {options.seed}, {seconds:g} s", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        report = run(options.seed, seconds, Path(folder), options.only, options.first)
    print(report)
    _keep(report)
    return 1 if report.breaches else 0


def _keep(report: Report) -> None:
    """Add what broke a promise to the corpus."""
    for breach in report.breaches:
        if breach.case is not None and isinstance(breach.number, int):
            folder = CORPUS / breach.kind.replace(" ", "_")
            folder.mkdir(parents=True, exist_ok=True)
            path = folder / f"{report.seed}_{breach.number}__{breach.case.name}"
            path.write_bytes(breach.case.data)
            print(f"kept as {path}; say in {CORPUS / 'README.md'} what it broke")


if __name__ == "__main__":
    sys.exit(main())
