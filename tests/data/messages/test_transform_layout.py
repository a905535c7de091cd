"""Messages with the frames of one before are read as the decoder reads them, or not at all."""

from __future__ import annotations

import random
from typing import Any

from webviz.data.messages import TFMessage, decode, encode
from webviz.data.messages.transform_layout import MAX_SIZES, MIN_TRANSFORMS, SAME_SIZE, Layouts
from webviz.shell.testing.messages import header

TYPE = "tf2_msgs/msg/TFMessage"


def message(names: list[tuple[str, str]], seed: int = 0) -> bytes:
    dice = random.Random(seed)

    def numbers(keys: str) -> dict[str, float]:
        return {key: dice.uniform(-9.0, 9.0) for key in keys}

    def stamped(parent: str, child: str) -> dict[str, Any]:
        transform = {"translation": numbers("xyz"), "rotation": numbers("xyzw")}
        stamp_ns = dice.randrange(2**31 * 10**9)
        return {
            "header": header(parent, stamp_ns),
            "child_frame_id": child,
            "transform": transform,
        }

    return encode(TYPE, {"transforms": [stamped(*each) for each in names]})


NAMES = [("map", "link é" + "x" * i) for i in range(MIN_TRANSFORMS)]


def learnt(cdr: bytes) -> Layouts:
    layouts = Layouts()
    layouts.learn(cdr, decode(TYPE, cdr))
    return layouts


def test_a_message_with_the_same_frames_is_read_as_it_is_decoded() -> None:
    layouts = learnt(message(NAMES))
    for seed in range(1, 20):
        cdr = message(NAMES, seed)
        decoded: TFMessage = decode(TYPE, cdr)
        layout = layouts.of(cdr)
        assert layout is not None
        batch = layout.read(cdr)
        assert batch.names == [(t.parent, t.child) for t in decoded.transforms]
        assert batch.stamps_ns == [t.stamp_ns for t in decoded.transforms]
        assert batch.poses.tolist() == [[*t.translation, *t.rotation] for t in decoded.transforms]


def test_other_frames_of_the_same_length_are_not_taken_for_the_same() -> None:
    layouts = learnt(message(NAMES))
    for place in range(len(NAMES)):
        names = list(NAMES)
        parent, child = names[place]
        names[place] = ("mop", child) if place % 2 else (parent, f"K{child[1:]}")
        assert layouts.of(message(names)) is None


def test_a_broken_message_is_left_to_the_decoder() -> None:
    cdr = message(NAMES)
    layouts = learnt(cdr)
    assert layouts.of(cdr[:-4]) is None
    assert layouts.of(cdr + b"\0\0\0\0") is None
    assert layouts.of(b"\0\0" + cdr[2:]) is None  # big-endian
    assert layouts.of(cdr[:4] + b"\xff" + cdr[5:]) is None  # another count
    assert layouts.of(b"") is None


def test_names_that_are_not_utf_8_are_read_as_they_are_decoded() -> None:
    cdr = message(NAMES).replace("é".encode(), b"\xff\xfe")
    layout = learnt(cdr).of(cdr)
    decoded: TFMessage = decode(TYPE, cdr)
    assert layout is None or layout.read(cdr).names == [
        (t.parent, t.child) for t in decoded.transforms
    ]


def test_robots_of_a_fleet_are_all_known_up_to_a_bound() -> None:
    fleet = [message([(f"{i}/{p}", f"{i}/{c}") for p, c in NAMES]) for i in range(SAME_SIZE + 1)]
    layouts = Layouts()
    for cdr in fleet:
        layouts.learn(cdr, decode(TYPE, cdr))
    assert [layouts.of(cdr) is not None for cdr in fleet] == [True] * SAME_SIZE + [False]


def test_messages_of_many_sizes_are_known_and_all_forgotten_if_there_are_too_many() -> None:
    sizes = [
        message([("map", f"{4 * i * 'x'}{child}") for _, child in NAMES])
        for i in range(MAX_SIZES + 1)
    ]
    layouts = Layouts()
    for cdr in sizes[:MAX_SIZES]:
        layouts.learn(cdr, decode(TYPE, cdr))
    assert all(layouts.of(cdr) for cdr in sizes[:MAX_SIZES])
    layouts.learn(sizes[MAX_SIZES], decode(TYPE, sizes[MAX_SIZES]))
    assert [layouts.of(cdr) is not None for cdr in sizes] == [False] * MAX_SIZES + [True]


def test_the_layout_of_small_messages_is_not_learnt() -> None:
    cdr = message(NAMES[1:])
    assert learnt(cdr).of(cdr) is None
