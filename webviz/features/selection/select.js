// The tool that selects: a click, or a box. Shift adds, Ctrl removes, and Alt leaves the mouse to the
// camera, as in RViz.

import { command } from "webviz/commands.js";
import { el } from "webviz/dom.js";
import { focus } from "webviz/scene/mouse.js";
import { outlineOf } from "webviz/scene/picking/outline.js";
import { pickAt, pickIn } from "webviz/scene/picking/pick.js";
import { finder } from "webviz/scene/picking/things.js";
import { openPanel } from "webviz/docks/layout.js";
import { computed, effect, owned, signal } from "webviz/signals.js";
import { store } from "webviz/stores.js";
import { canvas } from "webviz/viser_page.js";
import { install as installHighlight, middle } from "webviz/features/selection/highlight.js";
import { showHint } from "webviz/tools/hint.js";
import { makeLayer } from "webviz/tools/layer.js";
import { active, provide } from "webviz/tools/registry.js";
import * as selection from "webviz/tools/selection.js";

/** @import {Box, SceneEvent, SceneThing, Tool, Vec2} from "webviz/types.js" */

const CLICK_PX = 4;
const HINT = "Click or drag a box. Shift adds, Ctrl removes, Alt moves the camera.";

const picking = store("picking"); // displays that cannot be selected, by their ids
/** A gesture; `to` once it is a box. */
const drag = signal(/** @type {{pointer: number, from: Vec2, to: Vec2 | null} | null} */ (null));

/** @type {Tool} */
export const select = {
  id: "select",
  name: "Select",
  shortcut: "s",
  icon: "select",
  order: 2,
  isLean: true,
  hint: HINT,
  tooltip: "Select points, links, frames and cells to see their values.",
  cursor: "default",
  pointer: follow,
  leave: cancel,
};

export function install() {
  provide("selection", [select]);
  // As in RViz, F is about the selection while this tool is active.
  command({
    name: "Look at what is selected",
    key: "f",
    group: "Scene",
    isHidden: true,
    isThere: () => active() === select && selection.all().size > 0,
    run: lookAtSelection,
  });
  installHighlight();
  // Meanwhile the server knows for a moment what it has replaced.
  effect(() => {
    if (active() === select) picking.all();
  });
  const isBox = computed(() => Boolean(drag.value?.to));
  effect(() => {
    if (isBox.value) showBox();
  });
}

/** Shows the box of the gesture, until there is none. */
function showBox() {
  const element = el("div", { class: "wv-select-box" });
  const layer = makeLayer("select", element);
  owned(() => layer.element.remove());
  effect(() => {
    if (!drag.value?.to) return;
    layer.place();
    const { left, top, right, bottom } = boxBetween(drag.value.from, drag.value.to);
    const { left: x0, top: y0 } = canvas().getBoundingClientRect();
    element.style.cssText = `left: ${left - x0}px; top: ${top - y0}px; width: ${right - left}px; height: ${bottom - top}px`;
  });
}

/** Looks at the middle of what is selected. */
export function lookAtSelection() {
  const point = middle();
  if (point) focus(point);
}

/**
 * @param {SceneEvent} event
 * @returns {boolean}
 */
function follow(event) {
  if ("deltaY" in event) return false;
  const { type, pointerId, clientX, clientY } = event;
  if (type === "pointerdown") {
    const isOther = drag.value !== null;
    if (isOther || event.button !== 0 || event.altKey) return isOther;
    event.preventDefault();
    drag.value = { pointer: pointerId, from: [clientX, clientY], to: null };
    canvas().setPointerCapture(pointerId);
    return true;
  }
  if (drag.value === null) return false;
  if (pointerId !== drag.value.pointer) return true;
  if (type === "pointermove") move(clientX, clientY);
  else if (type === "pointerup") finish(event);
  else if (type === "pointercancel") cancel();
  return true;
}

/**
 * @param {number} x
 * @param {number} y
 */
function move(x, y) {
  if (!drag.value) return;
  const { from, to } = drag.value;
  if (to || Math.hypot(x - from[0], y - from[1]) >= CLICK_PX)
    drag.value = { ...drag.value, to: [x, y] };
}

/**
 * @param {Vec2} from
 * @param {Vec2} to
 * @returns {Box}
 */
function boxBetween([fromX, fromY], [x, y]) {
  return {
    left: Math.min(x, fromX),
    right: Math.max(x, fromX),
    top: Math.min(y, fromY),
    bottom: Math.max(y, fromY),
  };
}

/** @param {PointerEvent} event */
function finish({ clientX, clientY, shiftKey, ctrlKey, metaKey }) {
  /** @type {Vec2} */
  const at = [clientX, clientY];
  const hits = drag.value?.to
    ? pickIn(boxBetween(drag.value.from, at), selection.MAX_SELECTED, isSelectable)
    : picked(at);
  // At once: a moment later there may be another message.
  const find = finder();
  for (const pick of hits.picks) outlineOf(pick, find, false);
  cancel();
  const way = shiftKey ? "add" : ctrlKey || metaKey ? "remove" : "replace";
  if (hits.total === 0 && way !== "replace") return;
  if (hits.total > 0 && !document.body.classList.contains("wv-folded")) openPanel("selection");
  selection.change(way, hits.picks, hits.total).then(({ level, text }) => {
    if (level === "error") return showHint("warn", text);
    const [count, total] = [selection.all().size, selection.totalCount()];
    if (count < total) showHint("ok", `Selected the first ${count} of ${total}.`);
    else if (text) showHint("ok", text);
    else if (count) showHint("ok", `${count} selected.`);
    else showHint("ok", hits.total ? "Nothing is selected." : "Nothing is there.");
  });
}

/** @param {Vec2} xy */
function picked(xy) {
  const hit = pickAt(xy, isSelectable);
  return { picks: hit ? [hit] : [], total: hit ? 1 : 0 };
}

/**
 * The group of a node begins with the id of its display.
 *
 * @param {SceneThing} thing
 */
const isSelectable = ({ node }) => !picking.has(node.group.split("/", 1)[0]);

function cancel() {
  const pointer = drag.value?.pointer;
  if (pointer !== undefined && canvas().hasPointerCapture(pointer))
    canvas().releasePointerCapture(pointer);
  drag.value = null;
}
