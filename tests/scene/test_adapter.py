"""Contract of viser's private parts: they exist and do what we need."""

from __future__ import annotations

import gc
import hashlib
import inspect
import io
import time
import weakref
from typing import Any, get_type_hints

import numpy as np
import PIL.Image
import pytest
from several import Make
from viser import _messages as wire
from viser.infra._messages import wire_field_names
from viser_internals import (
    message_buffer,
    property_types,
    queue_message,
    state_of,
    window_loop,
)
from waiting import until

from webviz.scene import ViserScene
from webviz.scene.adapter.image import add_blank_image
from webviz.scene.adapter.link import MAX_TOMBSTONES
from webviz.scene.adapter.poses import OrientationMessage, PositionMessage


def test_viser_has_the_loop_that_we_replace() -> None:
    """If this fails, viser changed: compare `SceneSender` with its new loop."""
    assert hashlib.sha256(window_loop().encode()).hexdigest().startswith("622c10d1a9e84168")


@pytest.mark.parametrize(
    ("message", "fields"),
    [
        (wire.SetPositionMessage, ("name", "position", "owner")),
        (wire.SetOrientationMessage, ("name", "wxyz", "owner")),
        (wire.SceneNodeUpdateMessage, ("name", "updates", "owner")),
        (wire.RunJavascriptMessage, ("source",)),
    ],
)
def test_messages_that_we_queue_have_the_fields_that_we_fill(
    message: type[Any], fields: tuple[str, ...]
) -> None:
    assert wire_field_names(message) == fields


@pytest.mark.parametrize(
    ("props", "names"),
    [
        (wire.PointCloudProps, {"points", "colors", "point_size", "point_shape"}),
        (wire.LineSegmentsProps, {"points", "colors", "thickness", "thickness_units"}),
        (wire.ArrowProps, {"points", "colors", "shaft_radius", "head_radius", "head_length"}),
        (
            wire.BatchedGlbProps,
            {"glb_data", "batched_positions", "batched_wxyzs", "batched_scales"},
        ),
        (wire.MeshProps, {"vertices", "faces", "color", "opacity", "side"}),
        (wire.LabelProps, {"text", "font_scene_height"}),
        (wire.ImageProps, {"_data", "_format", "render_width", "render_height"}),
    ],
)
def test_nodes_have_the_properties_that_we_update(props: type[Any], names: set[str]) -> None:
    assert names <= set(inspect.signature(props).parameters)


@pytest.mark.parametrize(
    ("ours", "original"),
    [
        (PositionMessage("/a", (1.0, 2.0, 3.0)), wire.SetPositionMessage("/a", (1.0, 2.0, 3.0))),
        (
            OrientationMessage("/a", (0.6, 0.8, 0.0, 0.0)),
            wire.SetOrientationMessage("/a", (0.6, 0.8, 0.0, 0.0)),
        ),
    ],
)
def test_poses_are_packed_as_viser_packs_them(ours: Any, original: Any) -> None:
    assert ours.as_serializable_dict([]) == original.as_serializable_dict([])
    assert ours.redundancy_key() == original.redundancy_key()
    assert ours.entity_state_key() == original.entity_state_key()
    assert ours.lifecycle_phase == original.lifecycle_phase


def test_nodes_of_one_class_share_the_types_of_its_properties(scene: ViserScene) -> None:
    """viser evaluates them anew for each node, which takes half of the time to make one."""
    one, other = (scene.link.server.scene.add_frame(f"/{name}") for name in ("one", "other"))
    assert property_types(one) is property_types(other)
    assert property_types(one) == get_type_hints(wire.FrameProps)


def test_a_blank_image_is_added_as_viser_adds_one(scene: ViserScene) -> None:
    server = scene.link.server
    one = np.zeros((1, 1, 4), np.uint8)
    image = server.scene.add_image(
        "/image", one, 1.0, 1.0, format="png", cast_shadow=False, receive_shadow=False
    )
    ours = add_blank_image(server, "/image")
    first, second = (vars(state_of(handle).props) for handle in (image, ours))
    assert {**first, "_data": b""} == {**second, "_data": b""}
    for props in (first, second):
        with PIL.Image.open(io.BytesIO(props["_data"])) as picture:
            assert np.asarray(picture).tolist() == one.tolist()


def test_a_joining_browser_gets_only_the_last_of_many_moves(scene: ViserScene, call: Make) -> None:
    for x in range(1000):
        scene.link.set_position("/webviz/a", (float(x), 0.0, 0.0))
    moves = [m for m in call().replay() if m["type"] == "SetPositionMessage"]
    assert [m["position"] for m in moves if m["name"] == "/webviz/a"] == [[999.0, 0.0, 0.0]]


def test_batched_moves_equal_single_ones(scene: ViserScene) -> None:
    link, turned = scene.link, (0.6, 0.8, 0.0, 0.0)
    for _ in range(2):
        link.set_position("/webviz/a", (1.0, 0.0, 0.0))
        link.set_orientation("/webviz/a", turned)
        link.place([("/webviz/b", (1.0, 0.0, 0.0), turned)])
    link.place([("/webviz/b", None, turned), ("/webviz/b", (2.0, 0.0, 0.0), None)])
    buffer = message_buffer(link.server)
    for name in ("/webviz/a", "/webviz/b"):
        ids = buffer.ids_from_entity_state_key["scene", name]
        messages = [buffer.message_from_id[number] for number in sorted(ids)]
        assert {type(message) for message in messages} == {PositionMessage, OrientationMessage}
        assert len(messages) == 2
        keys = {buffer.id_from_redundancy_key[message.redundancy_key()] for message in messages}
        assert keys == ids
    assert list(buffer.message_from_id) == sorted(buffer.message_from_id)


def pretend_that_were_sent(scene: ViserScene, messages: int) -> None:
    """Lets message numbers go on from far above, as after so many messages."""
    buffer = message_buffer(scene.link.server)
    with buffer.buffer_lock:
        buffer.message_counter += messages


def test_joining_does_not_depend_on_how_much_was_ever_sent(scene: ViserScene, call: Make) -> None:
    """Walking the numbers one by one would take minutes."""
    before = len(call().replay())
    pretend_that_were_sent(scene, 10**9)
    scene.link.set_position("/webviz/a", (1.0, 0.0, 0.0))
    assert len(call().replay()) == before + 1


def test_a_connected_browser_goes_on_after_a_gap_in_the_numbers(
    scene: ViserScene, call: Make
) -> None:
    peer = call()
    peer.replay()
    pretend_that_were_sent(scene, 10**9)
    scene.link.set_position("/webviz/a", (1.0, 0.0, 0.0))
    assert [m["type"] for m in peer.receive()] == ["SetPositionMessage"]


def test_the_replay_comes_in_windows_and_in_order(scene: ViserScene, call: Make) -> None:
    for index in range(300):
        scene.link.set_position(f"/webviz/{index}", (0.0, 0.0, 0.0))
    peer = call()
    names = []
    while "/webviz/299" not in names:
        window = peer.receive()
        assert len(window) <= message_buffer(scene.link.server).max_window_size + 1
        names += [m["name"] for m in window if m["type"] == "SetPositionMessage"]
    assert names[-300:] == [f"/webviz/{index}" for index in range(300)]


def test_messages_queued_atomically_arrive_in_one_frame(scene: ViserScene, call: Make) -> None:
    peer = call()
    peer.replay()
    with scene.link.atomic():
        for index in range(500):
            scene.link.set_position(f"/webviz/{index}", (0.0, 0.0, 0.0))
    assert len(peer.receive()) == 500


def test_a_browser_that_does_not_read_costs_no_memory(scene: ViserScene, call: Make) -> None:
    call()  # reads nothing
    scene.link.update("/webviz/a", {"points": np.zeros(1)})
    live = scene.link.live_messages
    clouds = []
    for _ in range(100):
        cloud = np.zeros((100_000, 3), np.float32)
        clouds.append(weakref.ref(cloud))
        scene.link.update("/webviz/a", {"points": cloud})
        scene.link.flush()
        del cloud
    gc.collect()
    assert scene.link.live_messages == live
    assert sum(cloud() is not None for cloud in clouds) < 20


def test_a_browser_that_never_hears_of_removed_nodes_is_let_go(
    scene: ViserScene,
    call: Make,
) -> None:
    """Each removal waits for the slowest browser; the memory for that has a bound."""
    call()  # reads nothing
    cursors = message_buffer(scene.link.server).generator_cursors
    blob = np.zeros(20_000_000, np.uint8)
    positions = [-2]
    while len(positions) < 10 or len(set(positions[-10:])) > 1:  # it goes on, or has not begun
        scene.link.update("/webviz/a", {"points": blob})
        scene.link.flush()
        time.sleep(0.05)  # long enough to be sent, if the browser reads
        positions.append(min(cursors.values(), default=-len(positions)))
    for index in range(MAX_TOMBSTONES + 1000):
        queue_message(scene.link.server, wire.RemoveSceneNodeMessage(f"/webviz/{index}"))
        scene.link.count_removals(1)
    until(lambda: not cursors)
    scene.link.count_removals(1000)
    until(lambda: scene.link.live_messages < 200)


def test_acknowledging_without_browsers_returns_at_once(scene: ViserScene) -> None:
    scene.link.acknowledge(timeout=0.0)


def test_acknowledgement_waits_for_every_browser_and_leaves_nothing_behind(
    scene: ViserScene,
    call: Make,
) -> None:
    peer = call()
    peer.look()
    until(lambda: len(scene.link.server.get_clients()) == 1)
    live = scene.link.live_messages
    with pytest.raises(TimeoutError, match=r"did not answer within 0\.1 s"):
        scene.link.acknowledge(timeout=0.1)
    assert scene.link.live_messages == live
