"""The panel SLAM Toolbox: pauses mapping, saves and loads maps, and edits the pose graph."""

from __future__ import annotations

import functools
import time
from collections.abc import Callable, Mapping
from typing import Annotated, Any

from webviz.api.declared import Prop
from webviz.api.errors import Error
from webviz.api.panel import Panel, Send, Ui
from webviz.commands import CallService
from webviz.data.rotations import normalized, to_rpy
from webviz.panels.fields import finite, keep

NO_NUMBER = "Enter the pose, or use 2D Pose Estimate."

ASK_S = 2.0
"""Interval between requests for the state."""
SAVE_S = 60.0
"""Time in seconds for files to be written or read."""
PARAMETERS = ("paused_new_measurements", "interactive_mode")
"""Parameters of slam_toolbox, which say its state."""
INITIAL_POSE = "geometry_msgs/msg/PoseWithCovarianceStamped"
STARTS = {"At the first node": 1, "At the pose": 2, "Localize at the pose": 3}
"""Starts of a loaded pose graph, by `match_type` of DeserializePoseGraph."""
FIRST, AT_POSE, _ = STARTS
FAULTS = {
    "save_map": {1: "slam_toolbox has no map yet", 255: "the file was not written"},
    "serialize_map": {255: "the file was not written"},
}
"""Results other than 0, by service."""


class SlamToolbox(Panel):
    """Pauses mapping, saves and loads maps, and edits the pose graph of slam_toolbox."""

    title = "SLAM Toolbox"
    rviz = "slam_toolbox::SlamToolboxPlugin"
    opens = "side"
    icon = "map"

    node: Annotated[str, Prop(help="Full name of slam_toolbox's node.")] = "/slam_toolbox"
    initial_pose_topic: Annotated[
        str, Prop(help="Topic whose poses become those at which a pose graph is loaded.")
    ] = "/initialpose"

    def build(self, ui: Ui, send: Send) -> None:
        """Build the state, and buttons with their fields."""
        self.send = send
        self.asked_s = 0.0
        self.state: dict[str, bool] = {}
        self.why = ""
        self.start = FIRST
        self.status = ui.area()
        call = self._call

        def add(label: str, service: str, type: str, hint: str, width: float) -> None:
            ui.button(label, lambda browser: call(label, service, type, {}, browser), hint, width)

        self.pause = ui.button(
            "Pause new scans",
            lambda browser: call("Scans", "pause_new_measurements", "Pause", {}, browser),
            "Pause or resume the use of new scans.",
            width=0.5,
        )
        self.interact = ui.button(
            "Start editing",
            lambda browser: call(
                "Editing", "toggle_interactive_mode", "ToggleInteractive", {}, browser
            ),
            "Allow moving nodes of the graph by their interactive markers, or stop it.",
            width=0.5,
        )
        add("Clear changes", "clear_changes", "Clear", "Put moved nodes back.", 0.5)
        hint = "Optimise the graph with the moved nodes."
        add("Save changes", "manual_loop_closure", "LoopClosure", hint, 0.5)
        of_map = "File of the occupancy grid, without extension, on the machine of slam_toolbox."
        self.map = ui.field("Map", "", keep, of_map)
        ui.button("Save map", self._save_map, "Write the map as an image and a YAML file.")
        self.graph = ui.field(
            "Pose graph", "", keep, "File without extension, on the machine of slam_toolbox."
        )
        ui.button("Serialize", self._serialize, "Write the pose graph to the file.", width=0.5)
        ui.button("Deserialize", self._load, "Continue with the pose graph of the file.", width=0.5)
        choice = ui.choice("Start", self.start, self._choose, "Where the robot is in that graph.")
        choice.offer(list(STARTS), self.start)
        self.choice = choice
        hint = "Of the robot in the map; 2D Pose Estimate fills it in."
        self.pose = [ui.field(label, "", keep, hint) for label in ("x (m)", "y (m)", "yaw (rad)")]
        hint = "Discard scans that wait to be added to the map."
        add("Clear queue", "clear_queue", "ClearQueue", hint, 1.0)
        self.submap = ui.field("Submap", "", keep, "File of a pose graph to merge.")
        ui.button("Add submap", self._add_submap, "Load it, to be placed by hand.", width=0.5)
        add("Generate map", "merge_submaps", "MergeMaps", "Merge the submaps where they are.", 0.5)
        self.result = ui.area()

    @property
    def uses(self) -> tuple[str, ...]:
        """Its services, and that of its parameters."""
        names = (
            *("pause_new_measurements", "toggle_interactive_mode", "clear_changes"),
            *("manual_loop_closure", "save_map", "serialize_map", "deserialize_map"),
            *("clear_queue", "add_submap", "merge_submaps", "get_parameters"),
        )
        return tuple(map(self._full, names))

    def subscriptions(self) -> Mapping[str, str]:
        """Return the poses of 2D Pose Estimate."""
        return {self.initial_pose_topic: INITIAL_POSE} if self.initial_pose_topic else {}

    def take(self, topic: str, message: Any) -> None:
        """Fill in a pose."""
        position, turn = message.pose.pose.position, message.pose.pose.orientation
        (wxyz,), _ = normalized([turn.w, turn.x, turn.y, turn.z])
        w, x, y, z = wxyz.tolist()
        _, _, yaw = to_rpy((w, x, y, z))
        for field, value in zip(self.pose, (position.x, position.y, yaw), strict=True):
            field.show(f"{value:.2f}")
        if self.start == FIRST:
            self.start = AT_POSE
            self.choice.offer(list(STARTS), AT_POSE)

    def show(self) -> None:
        """Ask for the state now and then, and show it."""
        if time.monotonic() - self.asked_s > ASK_S:
            self._ask()
        is_paused, is_editing = (self.state.get(name) for name in PARAMETERS)
        self.status.table(
            [
                ("New scans", _state_text(is_paused, "paused", "used") or self.why or "unknown"),
                ("Editing", _state_text(is_editing, "on", "off") or "unknown"),
            ]
        )
        self.pause.label = "Use new scans" if is_paused else "Pause new scans"
        self.interact.label = "Stop editing" if is_editing else "Start editing"

    def _ask(self) -> None:
        self.asked_s = time.monotonic()
        self.send(
            CallService(
                self._full("get_parameters"),
                "rcl_interfaces/srv/GetParameters",
                {"names": list(PARAMETERS)},
                answered=self._know,
                failed=self._forget,
                timeout_s=2.0,
            )
        )

    def _know(self, response: Any) -> None:
        values = zip(PARAMETERS, response.values, strict=False)
        self.state = {name: value.bool_value for name, value in values}

    def _forget(self, reason: str) -> None:
        self.state, self.why = {}, reason

    def _choose(self, name: str, browser: int | None) -> None:
        self.start = name

    def _save_map(self, browser: int | None) -> None:
        request = {"name": {"data": _file(self.map.value, "the map")}}
        self._call("Map", "save_map", "SaveMap", request, browser)

    def _serialize(self, browser: int | None) -> None:
        request = {"filename": _file(self.graph.value, "the pose graph")}
        self._call("Pose graph", "serialize_map", "SerializePoseGraph", request, browser)

    def _load(self, browser: int | None) -> None:
        request: dict[str, Any] = {
            "filename": _file(self.graph.value, "the pose graph"),
            "match_type": STARTS[self.start],
        }
        if self.start != FIRST:
            x, y, yaw = (finite(field.value, NO_NUMBER) for field in self.pose)
            request["initial_pose"] = {"x": x, "y": y, "theta": yaw}
        self._call("Pose graph", "deserialize_map", "DeserializePoseGraph", request, browser)

    def _add_submap(self, browser: int | None) -> None:
        request = {"filename": _file(self.submap.value, "the submap")}
        self._call("Submap", "add_submap", "AddSubmap", request, browser)

    def _call(
        self, what: str, service: str, type: str, request: Mapping[str, Any], browser: int | None
    ) -> None:
        def answered(response: Any) -> None:
            self.asked_s = 0.0  # the state may be another now
            result = getattr(response, "result", 0)
            reason = FAULTS.get(service, {}).get(result, f"result {result}")
            failed = "slam_toolbox refused. See its log."
            refused = failed if getattr(response, "status", True) is False else ""
            self._say(what, f"Failed: {reason}." if result else refused or "Done.")

        say: Callable[[str], None] = functools.partial(self._say, what)
        say("Waiting ...")
        self.send(
            CallService(
                self._full(service),
                f"slam_toolbox/srv/{type}",
                request,
                answered=answered,
                failed=say,
                timeout_s=SAVE_S,
            ),
            browser,
        )

    def _say(self, what: str, text: str) -> None:
        self.result.table([(what, text)])

    def _full(self, name: str) -> str:
        return f"/{self.node.strip('/')}/{name}"


def _state_text(value: bool | None, true: str, false: str) -> str:
    """Return a word for a state, "" if it is not known."""
    return "" if value is None else true if value else false


def _file(text: str, what: str) -> str:
    if not text.strip():
        raise Error(f"No file for {what}. Enter its name, without extension.")
    return text.strip()
