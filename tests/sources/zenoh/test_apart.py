"""Robots in processes of their own: huge messages, clocks that are wrong, and routers in a tree."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path

import psutil
import pytest
from waiting import until
from zenoh_robot import ZenohRobot, ZenohRouter, free_port

from webviz.api.declared import Topic
from webviz.data.messages import decode, encode
from webviz.sources import Advertisement, Subscription
from webviz.sources.inbox import MAX_TOTAL
from webviz.sources.zenoh.address import zenoh_address
from webviz.sources.zenoh.source import ZenohSource

SUPPORT = Path(__file__).parents[2] / "support"
STRING = "std_msgs/msg/String"
HUGE = 2 * MAX_TOTAL
"""Bytes of a message, above what is taken; with 1 GB it is the same, which was tried by hand."""
ELSE = 100 << 20
"""Bytes of memory for everything else."""
SHIFT = """
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdlib.h>
#include <time.h>
int clock_gettime(clockid_t id, struct timespec *now) {
  static int (*real)(clockid_t, struct timespec *);
  if (!real) real = dlsym(RTLD_NEXT, "clock_gettime");
  int result = real(id, now);
  if (id == CLOCK_REALTIME) now->tv_sec += atol(getenv("SHIFT_S"));
  return result;
}
"""
"""A library that moves the clock of a process."""


class Sender:
    """The robot of tests/support/zenoh_sender.py.

    Args:
        endpoint: of its router, "0" for one of its own.
        variables: of its environment.
    """

    def __init__(self, endpoint: str = "0", **variables: str) -> None:
        path = os.pathsep.join([str(SUPPORT), *sys.path])
        self._process = subprocess.Popen(
            [sys.executable, str(SUPPORT / "zenoh_sender.py"), endpoint],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env={**os.environ, "PYTHONPATH": path, **variables},
        )
        assert self._process.stdout is not None
        self.endpoint = self._process.stdout.readline().strip()

    def send(self, text: str) -> None:
        """Publish a text, or as many bytes as a number says."""
        assert self._process.stdin is not None
        self._process.stdin.write(f"{text}\n")
        self._process.stdin.flush()

    def close(self) -> None:
        """End it."""
        with self._process:
            self._process.kill()


def listening(stack: ExitStack, endpoint: str) -> tuple[ZenohSource, Callable[[], list[str]]]:
    """A source that hears /words, and what it has heard since the last call."""
    source = ZenohSource(zenoh_address(endpoint, {}))
    stack.callback(source.close)
    source.want({"/words": Subscription(STRING, Topic("/words"))})
    until(lambda: source.offers().get("/words") and source.offers()["/words"].subscribers)

    def texts() -> list[str]:
        return [decode(STRING, raw.cdr).data for raw in source.inbox.drain().get("/words", ())]

    return source, texts


def test_a_huge_message_takes_bounded_memory(stack: ExitStack) -> None:
    sender = Sender()
    stack.callback(sender.close)
    source, texts = listening(stack, sender.endpoint)
    process = psutil.Process()
    before = peak = process.memory_info().rss
    sender.send(str(HUGE))
    sender.send("small")
    results: list[str] = []

    def look() -> None:
        nonlocal peak
        peak = max(peak, process.memory_info().rss)
        results.extend(texts())

    until(lambda: "small" in results, turn=look, look_s=0.005)
    assert results[-1] == "small"
    assert peak - before < MAX_TOTAL + ELSE
    assert source.bridges[0].is_up


@pytest.mark.parametrize("hours", [-1, 1, 24 * 365])
def test_a_robot_whose_clock_is_wrong(
    stack: ExitStack, router: ZenohRouter, tmp_path: Path, hours: int
) -> None:
    """The engine replaces timestamps of the future, and orders cached messages by them."""
    compiler = shutil.which("cc")
    if compiler is None:
        pytest.skip("needs a C compiler, which makes a clock that is wrong")
    (tmp_path / "shift.c").write_text(SHIFT)
    library = str(tmp_path / "shift.so")
    build = ["-shared", "-fPIC", "-o", library, str(tmp_path / "shift.c"), "-ldl"]
    subprocess.run([compiler, *build], check=True)
    sender = Sender(router.endpoint, LD_PRELOAD=library, SHIFT_S=str(hours * 3600))
    stack.callback(sender.close)
    _, texts = listening(stack, router.endpoint)
    results: list[str] = []
    until(lambda: results.extend(texts()) or results)
    assert results == ["cached"]
    for number in range(10):
        sender.send(f"live {number}")
    until(lambda: results.extend(texts()) or len(results) > 10)
    assert results == ["cached", *(f"live {number}" for number in range(10))]


@pytest.mark.parametrize("place", ["laptop", "cloud", "robot"])
def test_one_router_of_a_tree_restarts(stack: ExitStack, place: str) -> None:
    """The laptop's router and the robot's connect to the one in the cloud."""
    ports = {name: free_port() for name in ("cloud", "robot", "laptop")}
    routers: dict[str, ZenohRouter] = {}

    def start(name: str) -> None:
        up = {} if name == "cloud" else {"connect__endpoints": [f"tcp/127.0.0.1:{ports['cloud']}"]}
        routers[name] = ZenohRouter(ports[name], **up)

    for name in ports:
        start(name)
    stack.callback(lambda: [router.close() for router in routers.values()])
    robot = ZenohRobot(routers["robot"].endpoint)
    stack.callback(robot.close)
    publish = robot.publisher("/words", STRING)
    driven = robot.subscription("/orders", STRING)
    source, texts = listening(stack, routers["laptop"].endpoint)
    order = Advertisement("/orders", STRING)

    def both_ways(text: str) -> None:
        results: list[str] = []

        def send() -> None:
            publish({"data": text})
            if source.bridges[0].is_up:
                source.graph.publish(order, encode(STRING, {"data": text})).result(5)
            results.extend(texts())

        until(lambda: text in results, turn=send, look_s=0.1)
        until(lambda: text in [message.data for message, _ in driven], turn=send, look_s=0.1)

    both_ways("before")
    routers.pop(place).close()
    time.sleep(1.0)
    start(place)
    both_ways("after")
    until(lambda: "/robot" in source.graph.nodes())
    assert not source.bridges[0].remarks
