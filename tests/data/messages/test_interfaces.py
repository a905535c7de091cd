"""Services and actions as the messages they consist of."""

from __future__ import annotations

from concurrent.futures import Future

import pytest

from webviz.data.messages import DefinitionError, UnknownTypeError, decode, encode, message_class
from webviz.data.messages.interfaces import action, service, taker

COUNT = "test_msgs/srv/Count"
WALK = "test_msgs/action/Walk"


def test_a_service_is_a_request_and_a_response() -> None:
    parts = service(COUNT, "int32 of\n---\nint32 sum\nstring why\n")
    assert parts == (f"{COUNT}_Request", f"{COUNT}_Response")
    assert message_class(parts.request).__struct_fields__ == ("of",)
    answer = decode(parts.response, encode(parts.response, {"sum": 7, "why": "so"}))
    assert (answer.sum, answer.why) == (7, "so")
    assert message_class(COUNT).__struct_fields__ == (
        "request_message",
        "response_message",
        "event_message",
    )
    event = decode(f"{COUNT}_Event", encode(f"{COUNT}_Event", {"response": [{"sum": 3}]}))
    assert (len(event.request), event.response[0].sum) == (0, 3)


def test_a_part_without_fields_has_the_one_of_idl() -> None:
    name = service("std_srvs/srv/Trigger").request
    assert len(encode(name, {})) == 5


def test_an_action_is_two_services_and_a_message() -> None:
    parts = action(WALK, "float64 to\n---\nfloat64 at\n---\nfloat64 left\n")
    goal_id = {"uuid": list(range(16))}
    for name, values in (
        (parts.goal, {"to": 1.0}),
        (f"{parts.send_goal}_Request", {"goal_id": goal_id, "goal": {"to": 1.0}}),
        (f"{parts.send_goal}_Response", {"accepted": True, "stamp": {"sec": 3}}),
        (f"{parts.get_result}_Request", {"goal_id": goal_id}),
        (f"{parts.get_result}_Response", {"status": 4, "result": {"at": 1.0}}),
        (parts.feedback, {"goal_id": goal_id, "feedback": {"left": 0.5}}),
    ):
        assert message_class(name).__struct_fields__ == tuple(values)
        assert decode(name, encode(name, values)) is not None
    assert message_class(parts.send_goal).__struct_fields__[0] == "request_message"
    assert action(WALK) == parts


def test_types_that_are_unknown_or_cut_off_are_refused() -> None:
    for declare in (service, action):
        with pytest.raises(UnknownTypeError, match="No definition of test_msgs/srv/Nothing"):
            declare("test_msgs/srv/Nothing")
    with pytest.raises(DefinitionError, match="has 1 parts separated by ---, expected 2"):
        service("test_msgs/srv/Half", "int32 of\n")
    with pytest.raises(DefinitionError, match="has 2 parts separated by ---, expected 3"):
        action("test_msgs/action/Half", "int32 of\n---\n")
    with pytest.raises(DefinitionError, match="is not valid"):
        service("test_msgs/srv/Odd", "int32 = (\n---\n")


def test_each_outcome_of_a_call_is_handled_or_reported() -> None:
    name = "std_msgs/msg/String"
    results: list[str] = []

    def outcome(response: Future[bytes]) -> str:
        taker("/save", name, lambda answer: results.append(answer.data), results.append)(response)
        return results.pop()

    good: Future[bytes] = Future()
    good.set_result(encode(name, {"data": "done"}))
    assert outcome(good) == "done"
    ended: Future[bytes] = Future()
    ended.cancel()
    assert outcome(ended) == "The viewer has ended."
    for error, sentence in (
        (ValueError("It is full."), "It is full."),
        (KeyError(), "/save: KeyError."),
    ):
        failed: Future[bytes] = Future()
        failed.set_exception(error)
        assert outcome(failed) == sentence
