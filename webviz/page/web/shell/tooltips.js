// Tooltips: what `data-tip` or `title` says, after a moment under the mouse or a finger, and on focus.

import { listenToLongPresses } from "webviz/controls/long_press.js";
import { el } from "webviz/dom.js";
import { keyText } from "webviz/keys.js";
import { effect, owned, signal } from "webviz/signals.js";

const WAIT_MS = 500;
const GAP = 6;
const TIPPED = "[data-why], [data-tip], [title]";

const tip = el("div", { class: "wv-tip", role: "tooltip", id: "wv-tip", popover: "manual" });

/** The element whose tooltip is shown. */
const currentOwner = signal(/** @type {HTMLElement | null} */ (null));
/** The element whose tooltip is shown in a while. */
const due = signal(/** @type {{owner: HTMLElement, ms: number} | null} */ (null));

/**
 * The element around a target that has a tooltip.
 *
 * @param {EventTarget | null} target
 * @returns {HTMLElement | null}
 */
const ownerOf = (target) => (target instanceof Element ? target.closest(TIPPED) : null);

/** @param {HTMLElement} page */
export function install(page) {
  page.append(tip);
  effect(() => {
    if (!due.value) return;
    const { owner, ms } = due.value;
    const timer = setTimeout(() => show(owner), ms);
    owned(() => clearTimeout(timer));
  });
  effect(() => {
    if (currentOwner.value) place(currentOwner.value);
  });
  page.addEventListener("pointerover", ({ target, pointerType }) => {
    const owner = ownerOf(target);
    if (owner) adopt(owner);
    if (owner === currentOwner.value) return;
    hide();
    if (owner && pointerType !== "touch") due.value = { owner, ms: WAIT_MS };
  });
  page.addEventListener("pointerleave", ({ pointerType }) => {
    if (pointerType !== "touch") hide(); // that of a finger is read once it is lifted
  });
  listenToLongPresses(page, ({ target }) => {
    const owner = ownerOf(target);
    if (owner) show(owner);
    return owner !== null && owner === currentOwner.value;
  });
  page.addEventListener("focusin", ({ target }) => {
    const owner = ownerOf(target);
    const focused = /** @type {Element} */ (target);
    if (!owner || !focused.matches(":focus-visible") || focused.matches("input, textarea")) return;
    adopt(owner);
    due.value = { owner, ms: 0 }; // not while a dialog or a menu is just being opened
  });
  page.addEventListener("focusout", hide);
  for (const name of ["pointerdown", "keydown", "scroll"])
    window.addEventListener(name, hide, true);
}

/**
 * A `title` would show the browser's own tooltip beside this one.
 *
 * @param {HTMLElement} owner
 */
function adopt(owner) {
  const text = owner.getAttribute("title");
  if (!text) return;
  owner.removeAttribute("title");
  owner.dataset.tip = text;
  if (!owner.textContent.trim() && !owner.getAttribute("aria-label")) owner.ariaLabel = text;
}

/** @param {HTMLElement} owner */
function show(owner) {
  if (!owner.isConnected || !(owner.dataset.why || owner.dataset.tip)) return;
  hide();
  currentOwner.value = owner;
}

function hide() {
  due.value = null;
  currentOwner.value = null;
}

/**
 * Shows the tooltip of an element, until another one is shown.
 *
 * @param {HTMLElement} owner
 */
function place(owner) {
  // Why something is not allowed comes before what it would do.
  const { why, tip: about, key } = owner.dataset;
  const text = why || about || "";
  tip.replaceChildren(text, ...(key ? [el("kbd", {}, keyText(key))] : []));
  if (owner.ariaLabel !== text) owner.setAttribute("aria-describedby", "wv-tip");
  // In a dialog, only what is within it is read out.
  const home = owner.closest("dialog") ?? document.getElementById("webviz");
  if (tip.parentElement !== home) home?.append(tip);
  tip.showPopover();
  const box = owner.getBoundingClientRect();
  const { width, height } = tip.getBoundingClientRect();
  const left = box.left + box.width / 2 - width / 2;
  const below = box.bottom + GAP;
  const top = below + height > innerHeight ? box.top - GAP - height : below;
  tip.style.left = `${Math.max(GAP, Math.min(left, innerWidth - width - GAP))}px`;
  tip.style.top = `${Math.max(GAP, top)}px`;
  owned(() => {
    if (owner.getAttribute("aria-describedby") === "wv-tip")
      owner.removeAttribute("aria-describedby");
    if (tip.matches(":popover-open")) tip.hidePopover();
    tip.replaceChildren();
  });
}
