"""Time that has not begun, stands still or goes back, and transforms that contradict each other."""

from __future__ import annotations

import pytest
from bench import Bench, Benches
from dots import POSE, SECOND, PoseDot, T, dots, show_dot

from webviz.commands import DuplicateDisplay, Pause, Reset
from webviz.engine.pipeline.listener import BACK_MESSAGES, BACK_S
from webviz.sources import Offer, Publisher


@pytest.fixture
def b(bench: Benches) -> Bench:
    """A viewer of a dot."""
    return bench(PoseDot(name="Dot", count=0, seconds=3.0))


def statuses(b: Bench) -> dict[str, tuple[str, str]]:
    """Level and sentence by key of the viewer as a whole, a second later."""
    b.clock += 1.1
    b.statuses()
    return {key: (s.level.name, s.text) for key, s in b.states[-1].statuses.items()}


def publishes(b: Bench, topic: str, *nodes: str) -> None:
    b.source.topics[topic] = Offer(tuple(Publisher(n, "", "reliable", "volatile") for n in nodes))


def test_before_the_first_clock_message_the_wait_is_a_status(b: Bench) -> None:
    b.source.now = 0
    level, text = statuses(b)["Time"]
    assert level == "WARN"
    assert "Waiting for /clock: use_sim_time is set, but it has no publisher" in text
    publishes(b, "/clock", "/gazebo")
    assert "nothing has arrived from /gazebo" in statuses(b)["Time"][1]
    b.clock += 20.0
    b.source.now = T
    assert "Time" not in statuses(b)


def test_paused_time_is_reported_and_nothing_fades(b: Bench) -> None:
    publishes(b, "/clock", "/gazebo")
    show_dot(b, 1.0)
    b.clock += 0.3
    assert "Time" not in statuses(b)
    assert statuses(b)["Time"] == (
        "OK",
        "Simulated time has stopped at 100.0 s: /gazebo is paused.",
    )
    assert dots(b) == [1.0]
    assert b.statuses()["Transform"] == ("OK", "Transform OK")
    publishes(b, "/clock")
    assert statuses(b)["Time"][0] == "WARN"
    b.source.now += SECOND
    assert "Time" not in statuses(b)


def test_a_jump_back_of_the_clock_starts_over_but_keeps_static_transforms(b: Bench) -> None:
    b.transform("base", "laser", T, 10.0, static=True)
    b.transform("map", "base", T)
    b.pose("/pose", "laser", T, 1.0)
    b.turn()
    assert dots(b) == [11.0]
    b.source.now -= 50 * SECOND
    b.turn()
    assert dots(b) == []
    assert statuses(b)["Time"] == ("OK", "Time went back by 50 s: everything was reset.")
    b.transform("map", "base", T - 50 * SECOND)
    b.pose("/pose", "laser", T - 50 * SECOND, 2.0)
    b.turn()
    assert dots(b) == [12.0]
    b.clock += 20.0
    b.source.now += 20
    assert "Time" not in statuses(b)


def test_a_clock_that_jumps_at_each_message_is_logged_once_a_minute(
    b: Bench, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    now = [1000.0]
    monkeypatch.setattr("webviz.engine.pipeline.ros_time.time.monotonic", lambda: now[0])
    caplog.set_level("WARNING", "webviz")
    for _ in range(50):
        b.source.now += 10 * SECOND
        b.turn()
        b.source.now -= 10 * SECOND
        b.turn()
    assert statuses(b)["Time"][1].startswith("Time went back by 10")
    lines = [each.message for each in caplog.records if "Time went back" in each.message]
    assert len(lines) == 1
    now[0] += 61.0
    b.source.now -= 5 * SECOND
    b.turn()
    lines = [each.message for each in caplog.records if "Time went back" in each.message]
    assert lines[1:] == [
        "Time went back by 5.0 s: everything was reset. (49 similar lines omitted)"
    ]


def elapsed_s(b: Bench) -> float:
    b.clock += 1.1
    b.statuses()
    return b.states[-1].clock.ros_elapsed_ns / SECOND


def test_elapsed_time_restarts_when_time_goes_back(b: Bench) -> None:
    assert elapsed_s(b) == 0.0
    b.source.now -= SECOND // 20
    assert elapsed_s(b) == 0.0, "too little for a reset"
    b.source.now += 20 * SECOND
    assert elapsed_s(b) == 20.0
    b.source.now -= 50 * SECOND
    assert elapsed_s(b) == 0.0
    b.source.now += 5 * SECOND
    assert elapsed_s(b) == 5.0
    b.do(Pause(True))
    b.source.now -= 50 * SECOND
    b.turn()
    b.do(Pause(False))
    assert elapsed_s(b) == 0.0
    b.source.now += 5 * SECOND
    b.do(Reset())
    assert elapsed_s(b) == 0.0


def test_messages_dropped_while_paused_give_no_warning(b: Bench) -> None:
    show_dot(b, 1.0)
    b.do(Pause(True))
    b.turn()
    for _ in range(1005):
        b.pose("/pose", "base", T, 2.0)
    assert statuses(b)["Time"] == ("OK", "5 messages dropped while paused; the newest are kept.")
    b.do(Pause(False))
    b.turn()
    assert dots(b)[-1] == 2.0
    assert "Message" not in b.statuses()
    b.source.now += SECOND
    assert "Time" not in statuses(b)


def test_the_end_of_a_loop_that_comes_with_the_jump_does_not_spoil_the_next(b: Bench) -> None:
    b.transform("map", "base", T)
    b.turn()
    b.transform("map", "base", T + SECOND)
    b.source.now -= 50 * SECOND
    b.turn()
    b.transform("map", "base", T - 50 * SECOND)
    b.pose("/pose", "base", T - 50 * SECOND, 2.0)
    b.turn()
    assert dots(b) == [2.0]


def test_a_clock_that_is_set_right_by_a_little_resets_nothing(b: Bench) -> None:
    show_dot(b, 1.0)
    b.source.now -= SECOND // 20
    b.turn()
    assert dots(b) == [1.0]


def test_a_reset_requests_latched_messages_again(b: Bench) -> None:
    policies = ("reliable", "transient_local")
    b.source.topics["/pose"] = Offer((Publisher("/map_server", POSE, *policies),), policies)
    show_dot(b, 1.0)
    requests = {
        topic: subscription.resubscriptions
        for topic, subscription in b.source.subscriptions.items()
    }
    b.source.now -= 50 * SECOND
    b.turn()
    again = {
        topic: subscription.resubscriptions
        for topic, subscription in b.source.subscriptions.items()
    }
    assert again["/pose"] > requests["/pose"]
    assert again["/tf_static"] > requests["/tf_static"]
    b.pose("/pose", "base", T, 1.0)
    b.turn()
    assert dots(b) == [1.0]


def loop(b: Bench, first: int, last: int, *frames: str) -> None:
    """Half-second steps of a bag without /clock: wall time goes on, the stamps are the bag's."""
    for half in range(2 * first, 2 * last):
        for frame in frames:
            b.transform("map", frame, half * SECOND // 2, half / 2)
        b.pose("/pose", frames[0], half * SECOND // 2)
        b.clock += 0.1
        b.source.now += SECOND // 10
        b.turn()


def test_a_bag_that_loops_without_a_clock_is_noticed_and_its_new_loop_is_shown(b: Bench) -> None:
    loop(b, 10, 40, "base")
    assert dots(b)[-1] == 39.5
    loop(b, 10, 13, "base")
    assert b.viewer.buffer.tree.caches["base"].newest_stamp == 39.5 * SECOND
    text = statuses(b)["Transforms"][1]
    assert 'transforms of "base" were refused' in text
    assert "If a bag was restarted, press Reset" in text
    loop(b, 13, 24, "base")
    assert dots(b)[-1] == 23.5
    assert statuses(b)["Time"][1].startswith("The transforms started over in the past")
    assert "Transforms" not in statuses(b)


def test_too_many_frames_are_a_status_while_they_arrive(
    b: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz.data.transforms.buffer.MAX_FRAMES", 3)
    loop(b, 10, 13, "base", "arm", "tool")
    assert statuses(b)["Transforms"][1].startswith('6 transforms, the last of "tool", were ignored')
    loop(b, 13, 60, "base", "arm")
    assert "Transforms" not in statuses(b)


def test_many_old_transforms_at_once_are_not_a_loop_of_the_bag(b: Bench) -> None:
    loop(b, 10, 40, "base")
    for half in range(20, 60):
        b.transform("map", "base", half * SECOND // 2)
        b.turn()
    assert b.viewer.buffer.tree.caches["base"].newest_stamp == 39.5 * SECOND


def test_a_few_old_transforms_in_a_long_time_are_not_a_loop_of_the_bag(b: Bench) -> None:
    loop(b, 10, 40, "base")
    for half in range(20, 20 + BACK_MESSAGES - 1):
        b.transform("map", "base", half * SECOND // 2)
        b.clock += BACK_S
        b.turn()
    assert b.viewer.buffer.tree.caches["base"].newest_stamp == 39.5 * SECOND


def test_one_frame_that_goes_back_while_others_go_on_resets_nothing(b: Bench) -> None:
    loop(b, 10, 40, "base", "arm")
    for half in range(80, 140):
        b.transform("map", "base", half * SECOND // 2)
        b.transform("map", "arm", (half - 60) * SECOND // 2, (half - 60) / 2)
        b.clock += 0.1
        b.source.now += SECOND // 10
        b.turn()
    assert b.viewer.buffer.tree.caches["base"].newest_stamp == 69.5 * SECOND
    text = statuses(b)["Transforms"][1]
    assert 'transforms of "arm" were refused' in text
    assert "TF_OLD" not in text
    b.source.now += 6 * SECOND
    b.clock += 6.0
    assert "Transforms" not in statuses(b)


@pytest.mark.parametrize(("count", "end"), [(1, "Fix the publisher."), (5, "And 2 more.")])
def test_refused_transforms_are_a_few_sentences(b: Bench, count: int, end: str) -> None:
    for number in range(count):
        b.transform("map", f"arm{number}", T, float("nan"))
    b.turn()
    text = statuses(b)["Transforms"][1]
    assert text.count("were refused") == min(count, 3)
    assert text.endswith(end)


def test_a_machine_whose_clock_is_ahead_is_named_with_its_offset(b: Bench) -> None:
    b.transform("map", "odom", T)
    b.transform("map", "odom", T + 1)
    b.transform("odom", "camera", T + 2 * SECOND)
    assert "Clocks" not in statuses(b)  # a single one may be a repeated old one
    b.transform("odom", "camera", T + 2 * SECOND + 1)
    level, text = statuses(b)["Clocks"]
    assert level == "WARN"
    assert (
        'The transforms of "camera" are stamped 2.0 s ahead of the clock of this computer' in text
    )
    b.source.now += 20 * SECOND
    b.clock += 20.0
    assert "Clocks" not in statuses(b)


def test_a_second_static_publisher_is_found_by_asking_again(b: Bench) -> None:
    publishes(b, "/tf_static", "/first", "/second")
    b.turn()
    for _ in range(2):
        requests = b.source.subscriptions["/tf_static"].resubscriptions
        b.transform("base", "laser", T, static=True)
        b.transform("camera", "laser", T, static=True)
        b.clock += 5.0
        b.turn()
        b.turn()
        if "Transforms" in statuses(b):
            break
        assert b.source.subscriptions["/tf_static"].resubscriptions > requests
    level, text = statuses(b)["Transforms"]
    assert level == "WARN"
    assert '"laser" has two parents in static transforms, "base" and "camera"' in text
    assert "/tf_static: /first, /second" in text
    publishes(b, "/tf_static", "/second")
    b.turn()
    b.transform("camera", "laser", T, static=True)
    b.clock += 5.0
    assert "Transforms" not in statuses(b)


def test_a_static_publisher_that_restarts_with_another_pose_is_not_a_conflict(b: Bench) -> None:
    for x in (1.0, 2.0):
        b.transform("base", "laser", T, x, static=True)
        b.clock += 5.0
        b.turn()
    b.transform("base", "laser", T, 2.0, static=True)
    b.clock += 5.0
    assert "Transforms" not in statuses(b)
    requests = b.source.subscriptions["/tf_static"].resubscriptions
    b.clock += 60.0
    b.turn()
    b.turn()
    assert b.source.subscriptions["/tf_static"].resubscriptions == requests


def test_a_second_display_of_a_topic_requests_its_latched_message(
    bench: Benches,
) -> None:
    b = bench(PoseDot(name="One"))
    first = b.source.subscriptions["/pose"].resubscriptions
    b.turn()
    assert b.source.subscriptions["/pose"].resubscriptions == first
    b.do(DuplicateDisplay("display1"))
    assert b.source.subscriptions["/pose"].resubscriptions > first
