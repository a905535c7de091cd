// The tools of the viewer: this page follows their gestures, the server acts on what they became.

import { why } from "webviz/access.js";
import { onAnswer } from "webviz/act.js";
import * as channel from "webviz/channel.js";
import { panel } from "webviz/panels/panels.js";
import { cards } from "webviz/shell/tool_buttons.js";
import { canvas } from "webviz/viser_page.js";
import { showHint, showLiveHint } from "webviz/tools/hint.js";
import { gesture, gestureOf, onGesture } from "webviz/tools/gestures.js";
import * as history from "webviz/features/tools/history.js";
import { active, provide, select } from "webviz/tools/registry.js";
import * as preview from "webviz/tools/preview.js";
import { toolsPanel } from "webviz/features/tools/panel.js";
import * as waypoints from "webviz/features/tools/waypoints.js";

/** @import {GestureParts, MadeGesture, SceneEvent, Tool, ToolFacts, ViewerTool} from "webviz/types.js" */

const FIRST = 10; // of the places in the toolbar; those before are of tools of the page
const LIFTS = matchMedia("(pointer: coarse)").matches ? "A second finger" : "Ctrl";
const POSE = `drag towards the heading. ${LIFTS} lifts. Esc cancels.`;
const SEVERAL = `${LIFTS} lifts, Shift collects waypoints.`;
/** @type {Record<string, [string, string]>} */
const HINTS = {
  point: ["Click on the ground. Esc cancels.", "Click on a surface. Esc cancels."],
  pose: [`Press on the ground and ${POSE}`, `Press on a surface and ${POSE}`],
};

export function install() {
  history.install();
  cards.prepend(waypoints.install());
  panel(toolsPanel);
  gesture("point", pointerTool);
  gesture("pose", pointerTool);
  /** @type {ViewerTool[]} */
  let viewerTools = [];
  const offer = () => provide("viewer", viewerTools.map(toolOf));
  onGesture(offer);
  channel.on("Tools", ({ tools }) => {
    viewerTools = tools;
    offer();
  });
  onAnswer("UseTool", ({ number, level, text }) => {
    history.setOutcome(number, level, text);
    showHint(level, text);
  });
  channel.on("Published", ({ number, topic, message_type, values }) =>
    history.published(number, { topic, type: message_type, values }),
  );
}

/**
 * @param {ViewerTool} tool
 * @param {number} index
 * @returns {Tool}
 */
function toolOf(tool, index) {
  const make = gestureOf(tool.gesture);
  const refusal =
    why(tool.gesture === "drive" ? "Drive" : "UseTool") ||
    tool.refusal ||
    (make ? "" : `The gesture "${tool.gesture}" is unknown. Add it in the module of the tool.`);
  const definition = { ...tool, refusal, order: FIRST + index, icon: tool.icon || tool.gesture };
  return {
    ...definition,
    ...make?.(definition, (result) => take(definition, { yaw: 0, keys: [], ...result })),
  };
}

/**
 * Waits to be sent if the tool asks, as a gesture of the page does.
 *
 * @param {ToolFacts} tool
 * @param {MadeGesture} result
 */
function take(tool, result) {
  if (tool.asks)
    preview.propose(tool, result, {
      onEnd: (/** @type {MadeGesture} */ final) => finish(tool, final),
      live: showLiveHint,
    });
  else finish(tool, result);
}

/**
 * @param {ToolFacts} tool
 * @param {MadeGesture} result
 */
function finish(tool, result) {
  if (!active()?.stays) select(null); // as it is now: it may have changed meanwhile
  history.send(tool, result);
}

/**
 * @param {ViewerTool} tool
 * @returns {GestureParts}
 */
const pointerTool = (tool) => ({
  hint: hintOf(tool),
  cursor: "crosshair",
  leave: preview.cancel,
  pointer: (event) => follow(event, tool),
});

/** @param {ViewerTool} tool */
function hintOf({ gesture, surface, several }) {
  const hint = HINTS[gesture][Number(surface)];
  return several?.length ? hint.replace(`${LIFTS} lifts.`, SEVERAL) : hint;
}

/**
 * Waypoints are sent by a button anyway.
 *
 * @param {PointerEvent} event
 */
const asks = ({ shiftKey }) => {
  const tool = active();
  return tool?.asks === true && !waypoints.collects(tool, shiftKey);
};

/**
 * While a gesture goes on, the camera stays where it is.
 *
 * @param {SceneEvent} event
 * @param {ViewerTool} tool
 * @returns {boolean}
 */
function follow(event, tool) {
  if ("deltaY" in event) {
    if (preview.isGoing()) event.preventDefault();
    return preview.isGoing();
  }
  if (preview.isGoing()) {
    if (!preview.follows(event)) {
      preview.followSecond(event);
      return true;
    }
    if (event.type === "pointermove") preview.follow(event);
    if (event.type === "pointerup") preview.end(event, asks(event));
    if (event.type === "pointercancel") preview.cancel();
    return true;
  }
  if (event.type !== "pointerdown" || event.target !== canvas() || event.button !== 0) return false;
  event.preventDefault();
  /** @param {MadeGesture} result */
  const onEnd = (result) => {
    if (!waypoints.collect(tool, result)) finish(tool, result);
  };
  if (!preview.begin(event, tool, { onEnd, live: showLiveHint })) {
    const surface = "Nothing is there. Press on a surface.";
    showHint("warn", tool.surface ? surface : "No ground here. Press below the horizon.");
  }
  return true;
}
