"""From the command to its URL and to the first picture: imports, ROS, server and page apart.

    python -m side_by_side.start [--rounds 5] [--imports 12]

Each round starts `webviz` with a grid and opens its page in a headless Chromium that runs already;
a first round, which fills caches, does not count. With --imports, the modules that take the most
time by themselves, the least of all rounds each.
"""

from __future__ import annotations

import argparse
import json
import re
import subprocess
import sys
import tempfile
import time
from collections import defaultdict
from heapq import nlargest
from operator import itemgetter
from pathlib import Path
from statistics import median

import playwright.sync_api as playwright
from program import Program

from side_by_side.case import environment
from webviz.shell.pictures.browser import launched
from webviz.shell.testing.domain import isolated_domain

CONFIG = "version: 1\nfixed_frame: map\ndisplays:\n- {type: Grid}\n"
PAGE = """() => new Promise((resolve) => {
  const times = {};
  const step = () => {
    const scene = window.__viserMutable?.scene;
    if (scene) times.scene ??= performance.now();
    let drawn = false;
    scene?.traverse((node) => { drawn ||= node.isLine || node.isLineSegments2 || node.isMesh; });
    if (times.picture !== undefined) {
      const [loading] = performance.getEntriesByType("navigation");
      resolve({ page: loading.responseEnd, ...times, picture: performance.now() });
      return;
    }
    if (drawn) times.picture = 0;
    requestAnimationFrame(step);
  };
  step();
})"""


def measure(browser: playwright.Browser, folder: Path) -> dict[str, float]:
    """Seconds of one start by part."""
    config, timed = folder / "grid.yaml", [sys.executable, "-m", "side_by_side.systems.timed"]
    config.write_text(CONFIG)
    command = [*timed, str(time.time()), "-d", str(config), "--port", "0"]
    program = Program(command, environment(), folder / "webviz.txt")
    try:
        url = program.url()
        done = json.loads(re.findall(r"^\{.*\}$", program.output(), re.MULTILINE)[0])
        page = browser.new_page(viewport={"width": 640, "height": 480})
        page.goto(f"{url}/?fixedDpr=1", wait_until="commit")
        picture = {name: ms / 1000 for name, ms in page.evaluate(PAGE).items()}
        page.close()
    finally:
        program.end()
    url_s = done.pop("URL")
    return {
        **done,
        "the rest": url_s - sum(done.values()),
        "command to URL": url_s,
        "page loaded": picture["page"],
        "scene of the page": picture["scene"] - picture["page"],
        "first picture": picture["picture"] - picture["scene"],
        "URL to picture": picture["picture"],
    }


def imports(folder: Path) -> dict[str, float]:
    """Milliseconds that each module takes by itself until the URL is printed."""
    config = folder / "grid.yaml"
    config.write_text(CONFIG)
    command = [sys.executable, "-X", "importtime", "-m", "webviz", "-d", str(config), "--port", "0"]
    program = Program(command, environment(), folder / "imports.txt")
    program.url()
    program.end()
    lines = re.findall(r"import time: +(\d+) \| +\d+ \| +(\S+)", program.output())
    return {name: int(us) / 1000 for us, name in lines}


def main() -> int:
    """Print medians and the range of the rounds."""
    parser = argparse.ArgumentParser(prog="side_by_side.start", description=__doc__)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--imports", type=int, default=0, help="modules to list (default: 0)")
    options = parser.parse_args()
    rounds: list[dict[str, float]] = []
    least: defaultdict[str, float] = defaultdict(lambda: float("inf"))
    with isolated_domain(), launched() as browser, tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for number in range(options.rounds + 1):
            found = measure(browser, folder)
            rounds += [found] if number else []
            for module, ms in imports(folder).items() if options.imports else ():
                least[module] = min(least[module], ms)
    helps = []
    for _ in range(options.rounds):
        start = time.monotonic()
        subprocess.run([sys.executable, "-m", "webviz", "--help"], stdout=subprocess.DEVNULL)
        helps.append(time.monotonic() - start)
    print("| part | median s | least | most |\n| --- | ---: | ---: | ---: |")
    for part, values in {**{p: [r[p] for r in rounds] for p in rounds[0]}, "--help": helps}.items():
        print(f"| {part} | {median(values):.2f} | {min(values):.2f} | {max(values):.2f} |")
    packages: defaultdict[str, float] = defaultdict(float)
    for module, ms in least.items():
        packages[f"{module.partition('.')[0]}.*"] += ms
    for found in (least, packages):
        for module, ms in nlargest(options.imports, found.items(), key=itemgetter(1)):
            print(f"{ms:7.1f} ms  {module}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
