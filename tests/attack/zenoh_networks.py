"""Zenoh networks that lie: tokens, messages and attachments of any kind."""

from __future__ import annotations

import base64
import json
import time
from contextlib import ExitStack
from pathlib import Path
from random import Random
from typing import Any

import zenoh
from zenoh_robot import ZenohRobot, ZenohRouter, config, robot_attachment

from tests.attack.attack import Case, mutated
from webviz.api.declared import Topic
from webviz.data.messages import encode, type_hash
from webviz.sources import Subscription
from webviz.sources.zenoh.address import zenoh_address
from webviz.sources.zenoh.source import ZenohSource

STRING = "std_msgs/msg/String"
HONEST_S = 15.0
"""Time in seconds within which a message of an honest topic must arrive."""
DDS = ("std_msgs::msg::dds_::String_", "a::msg::dds_::B_", "String", "x" * 3000, "<b>", "a::b::c")
NAMES = ("%words", "%tf", "%clock", "%", "%a%%b", "words", "%" + "x" * 300, "<img>", "%\u202e", "§")
KINDS = ("NN", "MP", "MS", "SS", "SC", "AS", "XX", "")
QOS = ("::,:,:,:,,", "2:1:,1:,:,:,,", "9::,:,:,:,,", ":::", "::,-1:,:,:,,", "1" * 400, ":" * 300)
NUMBERS = ("0", "-1", "9" * 400, "a", "")


def draw(random: Random) -> Case:
    """Return tokens and messages, some of which are nearly right."""
    batches = [[_token(random), *_message(random)] for _ in range(random.randrange(1, 30))]
    return Case("a.zenoh", json.dumps(batches).encode())


def _token(random: Random) -> str:
    pick = random.choice
    hash = pick((type_hash(STRING), "TypeHashNotSupported", "h" * 200, "<b>"))
    if random.random() < 0.3:
        tail = f"{pick(KINDS)}/{pick(NAMES).replace('%', '§')}/{pick(DDS).replace('::', '§')}"
        token = f"@/{pick(NUMBERS)}/@ros2_lv/{tail}/{pick(QOS)}"
    else:
        head = f"{pick(('0', *NUMBERS))}/zid/{pick(NUMBERS)}/{random.randrange(9)}/{pick(KINDS)}"
        node = f"{pick(NAMES)}/{pick(NAMES)}/{pick(('node', *NAMES))}"
        token = f"@ros2_lv/{head}/{node}/{pick(NAMES)}/{pick(DDS)}/{hash}/{pick(QOS)}"
    if random.random() < 0.2:
        token = mutated(random, token.encode()).decode(errors="replace")
    return token


def _message(random: Random) -> tuple[str, str, str]:
    topic = random.choice(("words", "tf", "clock"))
    cdr = encode(STRING, {"data": "x" * random.choice((1, 100_000))})
    attachment = robot_attachment(1, random.choice((0, -1, 2**62)), bytes(16))
    if random.random() < 0.7:
        cdr, attachment = mutated(random, cdr), mutated(random, attachment)
    key = f"0/{topic}/std_msgs::msg::dds_::String_/{type_hash(STRING)}"
    return key, base64.b64encode(cdr).decode(), base64.b64encode(attachment).decode()


def read_network(path: Path) -> None:
    """Read from a network with the tokens and messages of a file, and one honest robot."""
    with ExitStack() as stack:
        router = ZenohRouter()
        stack.callback(router.close)
        liar = zenoh.open(config("client", router.endpoint))
        stack.callback(liar.close)
        remaining: list[Any] = []
        messages = json.loads(path.read_bytes())
        for token, *_ in messages:
            try:
                remaining.append(liar.liveliness().declare_token(token))
            except zenoh.ZError:  # the engine itself refuses it
                continue
        robot = ZenohRobot(router.endpoint, "/honest_robot")
        stack.callback(robot.close)
        publish = robot.publisher("/honest", STRING)
        source = ZenohSource(zenoh_address(router.endpoint, {}))
        stack.callback(source.close)
        end = time.monotonic() + HONEST_S
        while time.monotonic() < end:
            offers = source.offers()
            source.want(
                {
                    topic: Subscription(offer.publishers[0].type, Topic(topic))
                    for topic, offer in offers.items()
                    if offer.publishers
                }
            )
            for _, key, data, attachment in messages:
                payload, sequence = map(base64.b64decode, (data, attachment))
                liar.put(key, payload, attachment=sequence)
            publish({"data": "honest"})
            _ = [str(remark) for bridge in source.bridges for remark in bridge.remarks]
            if source.inbox.drain().get("/honest"):
                return
            time.sleep(0.02)
        raise AssertionError("an honest topic of the network never arrives")
