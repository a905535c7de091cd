"""Exported files: recordings with markup in every text, and files damaged on their way."""

from __future__ import annotations

import base64
import contextlib
import gzip
import json
import logging
import re
import sys
import tempfile
import traceback
from pathlib import Path
from random import Random
from typing import Any

import playwright.sync_api as playwright
from bags import START_NS, Bag

from tests.attack.attack import Case, mutated
from webviz.shell.pictures.browser import FLAGS, executable_of

MARKUP = (
    '<img src=x onerror="window.ran = 1">',
    "</script><script>window.ran = 1</script>",
    '"><svg onload=window.ran=1>',
    "javascript:window.ran=1",
    "__proto__",
    "constructor",
    "\u202e\x00\x1b[2J",
    "x" * 20_000,
)
SHARE = 0.1
"""Share of the texts that are replaced."""
PART = re.compile(rb'(<script type="webviz/(about|chunk)"[^>]*>)([^<]*)')
CONFIG = """\
version: 1
fixed_frame: map
displays:
- {type: TF}
- {type: Marker, topic: /marker}
- {type: Text, topic: /words}
panels: [{type: Log}]
"""
ANSWER_MS = 20_000.0
"""Time in ms in which the page must still answer."""
SETTLED_MS = 300.0
"""Time in ms that markup has to run."""
MARKER = {
    "header": {"frame_id": "laser", "stamp": {"sec": START_NS // 10**9}},
    "ns": "walls",
    "type": 9,
    "text": "Entrance",
    "color": {"r": 1.0, "a": 1.0},
    "scale": {"z": 1.0},
    "pose": {"orientation": {"w": 1.0}},
}


def draw(random: Random) -> Case:
    """Opens attacked files in a browser."""
    how = random.choice(("texts", "bytes", "cut"))
    return Case("a.json", json.dumps([how, random.getrandbits(32)]).encode())


def _exported(folder: Path) -> bytes:
    """Return the file of a small run."""
    from webviz.shell.cli import main as webviz

    bag = Bag()
    bag.add("/marker", "visualization_msgs/msg/Marker", latched=True)
    bag.add("/tf", "tf2_msgs/msg/TFMessage")
    bag.add("/words", "std_msgs/msg/String")
    bag.put(0.0, "/marker", MARKER)
    for i in range(10):
        bag.transform(i / 10, "map", "laser", float(i))
        bag.put(i / 10, "/words", {"data": f"word {i}"})
    bag.write(folder / "run")
    (folder / "lab.yaml").write_text(CONFIG)
    path = folder / "run.html"
    status = webviz([
        "export", str(folder / "run"), "-d", str(folder / "lab.yaml"), "-o", str(path),
    ])  # fmt: skip
    assert status == 0
    return path.read_bytes()


def attacked(file: bytes, how: str, random: Random) -> bytes:
    """Return an exported file with other texts or bytes, or cut off."""
    if how == "cut":
        return file[: random.randrange(len(file) // 2, len(file))]

    def changed(match: re.Match[bytes]) -> bytes:
        data = base64.b64decode(match[3])
        if how == "bytes":
            return match[1] + base64.b64encode(mutated(random, data))
        is_packed = match[2] == b"chunk"
        data = gzip.decompress(data) if is_packed else data
        head, body, rest = b"", data, b""
        if is_packed:  # its length, JSON, and buffers
            length = int.from_bytes(data[:4], "little")
            body, rest = data[4 : 4 + length], data[-(-(4 + length) // 8) * 8 :]
        values = _with_markup(random, json.loads(body))
        body = json.dumps(values).encode()
        if is_packed:
            head = len(body).to_bytes(4, "little")
            padding = bytes(-(4 + len(body)) % 8)
            data = gzip.compress(head + body + padding + rest)
        else:
            data = body
        return match[1] + base64.b64encode(data)

    return PART.sub(changed, file)


def _with_markup(random: Random, value: Any) -> Any:
    """Return values of JSON of which a few texts are others."""
    match value:
        case dict():
            # Modules of panels are a part of the program.
            return {
                key: each if key.endswith(".js") else _with_markup(random, each)
                for key, each in value.items()
            }
        case list():
            return [_with_markup(random, each) for each in value]
        case str() if random.random() < SHARE:
            return random.choice(MARKUP)
        case _:
            return value


def _open(browser: playwright.Browser, path: Path, *, is_damaged: bool) -> None:
    """Open a file, and look whether anything of it ran, and whether damage is reported."""
    context = browser.new_context(viewport={"width": 500, "height": 300}, offline=True)
    context.set_default_timeout(ANSWER_MS)
    try:
        page = context.new_page()
        requests: list[str] = []
        page.on("dialog", lambda dialog: requests.append(f"a dialog: {dialog.message}"))
        page.on("request", lambda request: requests.append(request.url))
        page.goto(f"{path.as_uri()}?fixedDpr=0.1", wait_until="load")
        with contextlib.suppress(playwright.TimeoutError):
            page.wait_for_function("() => window.webviz?.hasView()", timeout=3000)
        page.wait_for_timeout(SETTLED_MS)
        assert page.evaluate("window.ran") is None, "markup of a recording ran"
        others = [url for url in requests if not url.startswith(("blob:", "data:"))]
        assert len(others) <= 1, f"a recording asked for {others[1:]}"
        if is_damaged:
            assert page.evaluate("document.body.innerText.trim()"), "the page is empty"
    finally:
        context.close()


def main() -> None:
    """Open files until there are no more names, and say what became of each."""
    logging.disable()
    out = sys.stdout
    sys.stdout = sys.stderr
    with tempfile.TemporaryDirectory() as folder, playwright.sync_playwright() as driver:
        whole = _exported(Path(folder))
        executable = executable_of(driver.chromium)
        browser = driver.chromium.launch(executable_path=executable, args=list(FLAGS))
        for line in sys.stdin:
            how, seed = json.loads(Path(line.rstrip("\n")).read_bytes())
            path = Path(folder) / "attacked.html"
            path.write_bytes(attacked(whole, how, Random(seed)))
            broken = ""
            try:
                _open(browser, path, is_damaged=how != "texts")
            except Exception:
                broken = traceback.format_exc()
            print(json.dumps({"refused": how == "cut", "broken": broken}), file=out, flush=True)


if __name__ == "__main__":
    main()
