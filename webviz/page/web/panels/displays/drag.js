// Dragging displays to another place: by mouse, or by a finger that has rested on one.

import { why } from "webviz/access.js";
import { takeKeysFirst } from "webviz/keys.js";
import { swallowClick, swallowClickOfRelease } from "webviz/controls/long_press.js";
import { el } from "webviz/dom.js";
import { sanitized } from "webviz/sanitize.js";
import { toast } from "webviz/toasts.js";
import { move } from "webviz/panels/displays/actions.js";
import { createMark } from "webviz/panels/displays/drop_mark.js";
import { isOpen } from "webviz/panels/displays/folding.js";
import { GLOBAL, isWithin, topmost } from "webviz/panels/displays/model.js";
import { below, inside } from "webviz/panels/displays/places.js";
import * as selection from "webviz/panels/displays/selection.js";

/** @import {Item, Place, Tree} from "webviz/panels/displays/types.js" */

/**
 * @typedef {{
 *   item: Item, pointerId: number, kind: keyof typeof START, x: number, y: number,
 *   isReady: boolean, timer: number,
 * }} Press
 * @typedef {{
 *   ids: Set<string>, moved: Item[], x: number, y: number, place: Place | null, over: Item | null,
 *   since: number,
 * }} Drag
 */

const START = { mouse: 4, touch: 10 }; // pixels
const HOLD_MS = 450;
const UNFOLD_MS = 700;
const EDGE = 32;
const FASTEST = 14; // pixels a frame
const INDENT = 16;
const INTO = [0.25, 0.75]; // of the height of a group

/** @param {Event} event */
const partOf = ({ target }) => /** @type {Element} */ (target).closest("[data-part]");

/**
 * Lets rows of a tree be dragged; a finger that rests and does not move opens the menu.
 *
 * @param {HTMLElement} canvas
 * @param {Tree} tree
 */
export function listenToDrags(canvas, tree) {
  const mark = createMark(tree);
  const ghost = el("div", { class: "wv-tree-ghost wv-card", "aria-hidden": "true" });
  /** @type {Press | null} */
  let press = null;
  /** @type {Drag | null} */
  let drag = null;
  let frame = 0;

  /** @param {PointerEvent} event */
  function onDown(event) {
    const item = tree.itemAt(event.target);
    if (press || event.button !== 0 || !item || partOf(event)) return;
    const { pointerId, clientX: x, clientY: y } = event;
    const kind = event.pointerType === "touch" ? "touch" : "mouse";
    const timer = kind === "touch" ? setTimeout(hold, HOLD_MS) : 0;
    press = { item, pointerId, kind, x, y, isReady: kind === "mouse", timer };
  }

  function hold() {
    if (!press) return;
    press.isReady = true;
    tree.list.row(press.item.id)?.element.classList.add("wv-tree-held");
    navigator.vibrate?.(10);
  }

  /**
   * @param {PointerEvent} event
   * @returns {void}
   */
  function onMove(event) {
    if (event.pointerId !== press?.pointerId) return;
    const { clientX: x, clientY: y } = event;
    if (drag) {
      drag.x = x;
      drag.y = y;
      return aim(press, drag);
    }
    if (Math.hypot(x - press.x, y - press.y) < START[press.kind]) return;
    if (!press.isReady || press.item.id === GLOBAL) return end(); // the list is scrolled
    const reason = why("MoveDisplay");
    if (!reason) return start(press, x, y);
    end();
    toast(reason, { level: "warn", topic: "access" });
  }

  /**
   * @param {Press} press
   * @param {number} x
   * @param {number} y
   */
  function start(press, x, y) {
    const { item } = press;
    const ids = new Set(selection.isSelected(item.id) ? selection.ids() : [item.id]);
    ids.delete(GLOBAL);
    const moved = topmost(tree.model(), ids);
    drag = { ids, moved, x, y, place: null, over: null, since: 0 };
    selection.activate(item.id); // keeps its row in the page
    canvas.setPointerCapture(press.pointerId);
    canvas.classList.add("wv-tree-dragging");
    ghost.textContent = moved.length === 1 ? sanitized(item.name, 60) : `${moved.length} displays`;
    document.getElementById("webviz")?.append(ghost);
    aim(press, drag);
    frame = requestAnimationFrame(turn);
  }

  /**
   * Looks where the pointer is: at a gap between rows, or at a group.
   *
   * @param {Press} press
   * @param {Drag} drag
   * @returns {void}
   */
  function aim(press, drag) {
    ghost.style.translate = `${drag.x + 12}px ${drag.y + 10}px`;
    const rows = tree.rows();
    const y = drag.y - canvas.getBoundingClientRect().top;
    const index = tree.list.at(y);
    const item = rows[index];
    if (!item) return; // a config without displays was loaded meanwhile
    const { top, height } = tree.list.span(index);
    const share = (y - top) / height;
    const isInto = item.isGroup && share > INTO[0] && share < INTO[1] && !isWithin(item, drag.ids);
    watchGroup(drag, isInto && !isOpen(item) ? item : null);
    if (isInto) {
      drag.place = inside(item);
      return mark.around(index);
    }
    const above = share < 0.5 && item.id !== GLOBAL ? index - 1 : index;
    const depth = press.item.depth + Math.round((drag.x - press.x) / INDENT);
    const place = below(tree.model(), rows, above, depth, drag.ids, isOpen);
    drag.place = place;
    mark.below(above, place.depth);
  }

  /**
   * @param {Drag} drag
   * @param {Item | null} item
   */
  function watchGroup(drag, item) {
    if (item?.id !== drag.over?.id) drag.since = performance.now();
    drag.over = item;
  }

  /** @param {number} now */
  function turn(now) {
    if (!press || !drag) return;
    const { top, bottom } = tree.element.getBoundingClientRect();
    /** @param {number} depth */
    const speed = (depth) => Math.ceil(Math.min(1, depth / EDGE) * FASTEST);
    const before = tree.element.scrollTop;
    if (drag.y < top + EDGE) tree.element.scrollTop -= speed(top + EDGE - drag.y);
    else if (drag.y > bottom - EDGE) tree.element.scrollTop += speed(drag.y - bottom + EDGE);
    if (tree.element.scrollTop !== before) aim(press, drag);
    if (drag.over && now - drag.since > UNFOLD_MS) {
      tree.setOpen(drag.over, true);
      aim(press, drag);
    }
    frame = requestAnimationFrame(turn);
  }

  /** @param {PointerEvent} event */
  function onUp(event) {
    if (event.pointerId !== press?.pointerId) return;
    const { item, isReady, kind } = press;
    const done = drag;
    if (done || (kind === "touch" && isReady)) swallowClick();
    end();
    if (done) {
      move(tree.model(), done.ids, done.place);
      if (!selection.isSelected(item.id)) selection.choose(item.id);
      tree.showActive();
    } else if (kind === "touch" && isReady) {
      // A menu that opens now would be closed by the end of this touch.
      const { clientX: x, clientY: y } = event;
      setTimeout(() => tree.openMenu(item.id, x, y));
    }
  }

  function end() {
    clearTimeout(press?.timer);
    cancelAnimationFrame(frame);
    tree.list.row(press?.item.id)?.element.classList.remove("wv-tree-held");
    canvas.classList.remove("wv-tree-dragging");
    ghost.remove();
    mark.hide();
    press = drag = null;
  }

  const endKeys = takeKeysFirst((event) => {
    if (event.key !== "Escape" || !drag) return false;
    swallowClickOfRelease();
    end();
    return true;
  });

  /** @param {TouchEvent} event */
  const keepStill = (event) => press?.isReady && event.cancelable && event.preventDefault();
  canvas.addEventListener("pointerdown", onDown);
  canvas.addEventListener("pointermove", onMove);
  canvas.addEventListener("pointerup", onUp);
  canvas.addEventListener("pointercancel", end);
  canvas.addEventListener("touchmove", keepStill, { passive: false });
  return () => {
    if (press) end();
    endKeys();
  };
}
