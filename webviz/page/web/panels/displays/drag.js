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
 * Lets rows of a tree be dragged; a finger that rests and does not move opens the menu. Returns what
 * ends that.
 *
 * @param {HTMLElement} canvas
 * @param {Tree} tree
 */
export function listenToDrags(canvas, tree) {
  const dragging = new Dragging(canvas, tree);
  canvas.addEventListener("pointerdown", (event) => dragging.press(event));
  canvas.addEventListener("pointermove", (event) => dragging.move(event));
  canvas.addEventListener("pointerup", (event) => dragging.release(event));
  canvas.addEventListener("pointercancel", () => dragging.end());
  canvas.addEventListener("touchmove", (event) => dragging.keepStill(event), { passive: false });
  const endKeys = takeKeysFirst((event) => event.key === "Escape" && dragging.giveUp());
  return () => {
    dragging.end();
    endKeys();
  };
}

class Dragging {
  #canvas;
  #tree;
  #mark;
  #ghost = el("div", { class: "wv-tree-ghost wv-card", "aria-hidden": "true" });
  /** @type {Press | null} */
  #press = null;
  /** @type {Drag | null} */
  #drag = null;
  #frame = 0;

  /**
   * @param {HTMLElement} canvas
   * @param {Tree} tree
   */
  constructor(canvas, tree) {
    this.#canvas = canvas;
    this.#tree = tree;
    this.#mark = createMark(tree);
  }

  /** @param {PointerEvent} event */
  press(event) {
    const item = this.#tree.itemAt(event.target);
    if (this.#press || event.button !== 0 || !item || partOf(event)) return;
    const { pointerId, clientX: x, clientY: y } = event;
    const kind = event.pointerType === "touch" ? "touch" : "mouse";
    const timer = kind === "touch" ? setTimeout(() => this.#hold(), HOLD_MS) : 0;
    this.#press = { item, pointerId, kind, x, y, isReady: kind === "mouse", timer };
  }

  #hold() {
    if (!this.#press) return;
    this.#press.isReady = true;
    this.#tree.list.row(this.#press.item.id)?.element.classList.add("wv-tree-held");
    navigator.vibrate?.(10);
  }

  /**
   * @param {PointerEvent} event
   * @returns {void}
   */
  move(event) {
    if (event.pointerId !== this.#press?.pointerId) return;
    const { clientX: x, clientY: y } = event;
    if (this.#drag) {
      this.#drag.x = x;
      this.#drag.y = y;
      return this.#aim(this.#press, this.#drag);
    }
    if (Math.hypot(x - this.#press.x, y - this.#press.y) < START[this.#press.kind]) return;
    if (!this.#press.isReady || this.#press.item.id === GLOBAL) return this.end(); // the list is scrolled
    const reason = why("MoveDisplay");
    if (!reason) return this.#start(this.#press, x, y);
    this.end();
    toast(reason, { level: "warn", topic: "access" });
  }

  /**
   * @param {Press} press
   * @param {number} x
   * @param {number} y
   */
  #start(press, x, y) {
    const { item } = press;
    const ids = new Set(selection.isSelected(item.id) ? selection.ids() : [item.id]);
    ids.delete(GLOBAL);
    const moved = topmost(this.#tree.model(), ids);
    this.#drag = { ids, moved, x, y, place: null, over: null, since: 0 };
    selection.activate(item.id); // keeps its row in the page
    this.#canvas.setPointerCapture(press.pointerId);
    this.#canvas.classList.add("wv-tree-dragging");
    this.#ghost.textContent =
      moved.length === 1 ? sanitized(item.name, 60) : `${moved.length} displays`;
    document.getElementById("webviz")?.append(this.#ghost);
    this.#aim(press, this.#drag);
    this.#frame = requestAnimationFrame((now) => this.#turn(now));
  }

  /**
   * Looks where the pointer is: at a gap between rows, or at a group.
   *
   * @param {Press} press
   * @param {Drag} drag
   * @returns {void}
   */
  #aim(press, drag) {
    this.#ghost.style.translate = `${drag.x + 12}px ${drag.y + 10}px`;
    const rows = this.#tree.rows();
    const y = drag.y - this.#canvas.getBoundingClientRect().top;
    const index = this.#tree.list.at(y);
    const item = rows[index];
    if (!item) return; // a config without displays was loaded meanwhile
    const { top, height } = this.#tree.list.span(index);
    const share = (y - top) / height;
    const isInto = item.isGroup && share > INTO[0] && share < INTO[1] && !isWithin(item, drag.ids);
    this.#watchGroup(drag, isInto && !isOpen(item) ? item : null);
    if (isInto) {
      drag.place = inside(item);
      return this.#mark.around(index);
    }
    const above = share < 0.5 && item.id !== GLOBAL ? index - 1 : index;
    const depth = press.item.depth + Math.round((drag.x - press.x) / INDENT);
    const place = below(this.#tree.model(), rows, above, depth, drag.ids, isOpen);
    drag.place = place;
    this.#mark.below(above, place.depth);
  }

  /**
   * @param {Drag} drag
   * @param {Item | null} item
   */
  #watchGroup(drag, item) {
    if (item?.id !== drag.over?.id) drag.since = performance.now();
    drag.over = item;
  }

  /** @param {number} now */
  #turn(now) {
    if (!this.#press || !this.#drag) return;
    const { top, bottom } = this.#tree.element.getBoundingClientRect();
    /** @param {number} depth */
    const speed = (depth) => Math.ceil(Math.min(1, depth / EDGE) * FASTEST);
    const before = this.#tree.element.scrollTop;
    if (this.#drag.y < top + EDGE) this.#tree.element.scrollTop -= speed(top + EDGE - this.#drag.y);
    else if (this.#drag.y > bottom - EDGE)
      this.#tree.element.scrollTop += speed(this.#drag.y - bottom + EDGE);
    if (this.#tree.element.scrollTop !== before) this.#aim(this.#press, this.#drag);
    if (this.#drag.over && now - this.#drag.since > UNFOLD_MS) {
      this.#tree.setOpen(this.#drag.over, true);
      this.#aim(this.#press, this.#drag);
    }
    this.#frame = requestAnimationFrame((now) => this.#turn(now));
  }

  /** @param {PointerEvent} event */
  release(event) {
    if (event.pointerId !== this.#press?.pointerId) return;
    const { item, isReady, kind } = this.#press;
    const drag = this.#drag;
    if (drag || (kind === "touch" && isReady)) swallowClick();
    this.end();
    if (drag) {
      move(this.#tree.model(), drag.ids, drag.place);
      if (!selection.isSelected(item.id)) selection.choose(item.id);
      this.#tree.showActive();
    } else if (kind === "touch" && isReady) {
      // A menu that opens now would be closed by the end of this touch.
      const { clientX: x, clientY: y } = event;
      setTimeout(() => this.#tree.openMenu(item.id, x, y));
    }
  }

  end() {
    clearTimeout(this.#press?.timer);
    cancelAnimationFrame(this.#frame);
    this.#tree.list.row(this.#press?.item.id)?.element.classList.remove("wv-tree-held");
    this.#canvas.classList.remove("wv-tree-dragging");
    this.#ghost.remove();
    this.#mark.hide();
    this.#press = this.#drag = null;
  }

  /** Ends a drag; whether there was one. */
  giveUp() {
    if (!this.#drag) return false;
    swallowClickOfRelease();
    this.end();
    return true;
  }

  /** @param {TouchEvent} event */
  keepStill(event) {
    if (this.#press?.isReady && event.cancelable) event.preventDefault();
  }
}
