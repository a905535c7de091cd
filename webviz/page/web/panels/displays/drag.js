// Dragging displays to another place: by mouse, or by a finger that has rested on one.

import { why } from "../../access.js";
import { el } from "../../dom.js";
import { plain } from "../../plain.js";
import { toast } from "../../shell/toasts.js";
import { move } from "./actions.js";
import { createMark } from "./drop_mark.js";
import { isOpen } from "./folding.js";
import { GLOBAL, isWithin, topmost } from "./model.js";
import { below, inside } from "./places.js";
import * as selection from "./selection.js";

const START = { mouse: 4, touch: 10 }; // pixels
const HOLD_MS = 450;
const UNFOLD_MS = 700;
const EDGE = 32;
const FASTEST = 14; // pixels a frame
const INDENT = 16;
const INTO = [0.25, 0.75]; // of the height of a group

/** Lets rows of a tree be dragged; a finger that rests and does not move opens the menu. */
export function listenToDrags(canvas, tree) {
  const mark = createMark(tree);
  const ghost = el("div", { class: "wv-tree-ghost wv-card", "aria-hidden": "true" });
  let press = null;
  let drag = null;
  let frame = 0;

  function onDown(event) {
    const item = tree.itemAt(event.target);
    if (press || event.button !== 0 || !item || event.target.closest("[data-part]")) return;
    const { pointerId, clientX: x, clientY: y } = event;
    const kind = event.pointerType === "touch" ? "touch" : "mouse";
    press = { item, pointerId, kind, x, y, isReady: kind === "mouse", timer: 0 };
    if (kind === "touch") press.timer = setTimeout(hold, HOLD_MS);
  }

  function hold() {
    press.isReady = true;
    tree.list.row(press.item.id)?.element.classList.add("wv-tree-held");
    navigator.vibrate?.(10);
  }

  function onMove(event) {
    if (event.pointerId !== press?.pointerId) return;
    const { clientX: x, clientY: y } = event;
    if (drag) {
      drag.x = x;
      drag.y = y;
      return aim();
    }
    if (Math.hypot(x - press.x, y - press.y) < START[press.kind]) return;
    if (!press.isReady || press.item.id === GLOBAL) return end(); // the list is scrolled
    const reason = why("MoveDisplay");
    if (!reason) return start(x, y);
    end();
    toast(reason, { level: "warn", topic: "access" });
  }

  function start(x, y) {
    const { item } = press;
    const ids = new Set(selection.isSelected(item.id) ? selection.ids() : [item.id]);
    ids.delete(GLOBAL);
    const moved = topmost(tree.model(), ids);
    drag = { ids, moved, x, y, place: null, over: null, since: 0 };
    selection.activate(item.id); // keeps its row in the page
    canvas.setPointerCapture(press.pointerId);
    canvas.classList.add("wv-tree-dragging");
    ghost.textContent = moved.length === 1 ? plain(item.name, 60) : `${moved.length} displays`;
    document.getElementById("webviz").append(ghost);
    aim();
    frame = requestAnimationFrame(turn);
  }

  // Looks where the pointer is: at a gap between rows, or at a group.
  function aim() {
    ghost.style.translate = `${drag.x + 12}px ${drag.y + 10}px`;
    const rows = tree.rows();
    const y = drag.y - canvas.getBoundingClientRect().top;
    const index = tree.list.at(y);
    const item = rows[index];
    const { top, height } = tree.list.span(index);
    const share = (y - top) / height;
    const isInto = item.isGroup && share > INTO[0] && share < INTO[1] && !isWithin(item, drag.ids);
    watchGroup(isInto && !isOpen(item) ? item : null);
    if (isInto) {
      drag.place = inside(item);
      return mark.around(index);
    }
    const above = share < 0.5 && item.id !== GLOBAL ? index - 1 : index;
    const depth = press.item.depth + Math.round((drag.x - press.x) / INDENT);
    drag.place = below(tree.model(), rows, above, depth, drag.ids, isOpen);
    mark.below(above, drag.place.depth);
  }

  function watchGroup(item) {
    if (item?.id !== drag.over?.id) drag.since = performance.now();
    drag.over = item;
  }

  function turn(now) {
    const { top, bottom } = tree.element.getBoundingClientRect();
    const speed = (depth) => Math.ceil(Math.min(1, depth / EDGE) * FASTEST);
    const before = tree.element.scrollTop;
    if (drag.y < top + EDGE) tree.element.scrollTop -= speed(top + EDGE - drag.y);
    else if (drag.y > bottom - EDGE) tree.element.scrollTop += speed(drag.y - bottom + EDGE);
    if (tree.element.scrollTop !== before) aim();
    if (drag.over && now - drag.since > UNFOLD_MS) {
      tree.setOpen(drag.over, true);
      aim();
    }
    frame = requestAnimationFrame(turn);
  }

  function onUp(event) {
    if (event.pointerId !== press?.pointerId) return;
    const { item, isReady, kind } = press;
    const { ids, place } = drag ?? {};
    const wasDragged = Boolean(drag);
    if (wasDragged || (kind === "touch" && isReady)) swallowClick();
    end();
    if (wasDragged) {
      move(tree.model(), ids, place);
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

  // The click at the end of a drag is none.
  function swallowClick() {
    const stop = (event) => {
      event.stopPropagation();
      event.preventDefault();
    };
    addEventListener("click", stop, { capture: true, once: true });
    setTimeout(() => removeEventListener("click", stop, { capture: true }), 50);
  }

  function onKey(event) {
    if (event.key !== "Escape" || !drag) return;
    event.stopImmediatePropagation();
    event.preventDefault();
    swallowClickOfRelease();
    end();
  }

  function swallowClickOfRelease() {
    addEventListener("pointerup", swallowClick, { capture: true, once: true });
  }

  const keepStill = (event) => press?.isReady && event.cancelable && event.preventDefault();
  canvas.addEventListener("pointerdown", onDown);
  canvas.addEventListener("pointermove", onMove);
  canvas.addEventListener("pointerup", onUp);
  canvas.addEventListener("pointercancel", end);
  canvas.addEventListener("touchmove", keepStill, { passive: false });
  addEventListener("keydown", onKey, { capture: true });
  return () => {
    if (press) end();
    removeEventListener("keydown", onKey, { capture: true });
  };
}
