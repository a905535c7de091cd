// Popovers: what belongs to a button, below it and over everything else, until one clicks elsewhere.

import { el } from "webviz/dom.js";
import { iconButton } from "webviz/icons.js";
import { root, signal } from "webviz/signals.js";

/** @import {Attribute, Children} from "webviz/types.js" */

const GAP = 4;

/**
 * A button with an icon that opens a popover, or closes it if it is open. `make(close)` makes what is
 * in it, anew each time, with effects that end when it is closed.
 *
 * @param {string} icon
 * @param {string} label of both
 * @param {(close: () => void) => Children} make
 * @param {Record<string, Attribute>} [attributes] of the button
 */
export function popoverButton(icon, label, make, attributes = {}) {
  const open = signal(/** @type {HTMLElement | null} */ (null));
  const button = iconButton(
    icon,
    label,
    () => {
      if (open.value) return open.value.hidePopover();
      open.value = show(button, label, make, () => (open.value = null));
    },
    {
      "aria-haspopup": "dialog",
      "aria-expanded": () => String(open.value !== null),
      "aria-pressed": () => String(open.value !== null),
      ...attributes,
    },
  );
  return button;
}

/**
 * @param {HTMLElement} button
 * @param {string} label
 * @param {(close: () => void) => Children} make
 * @param {() => void} closed
 */
function show(button, label, make, closed) {
  return root((end) => {
    const close = () => popover.hidePopover();
    /** @type {HTMLElement} */
    const popover = el(
      "div",
      { class: "wv-popover", role: "dialog", "aria-label": label, popover: "manual", tabindex: -1 },
      make(close),
    );
    const place = () => placeBelow(popover, button);
    const sizes = new ResizeObserver(place);
    /** @param {PointerEvent} event */
    const outside = (event) => {
      const path = event.composedPath();
      if (!path.includes(popover) && !path.includes(button)) close();
    };
    popover.addEventListener("keydown", (event) => {
      event.stopPropagation(); // viser's page and the commands have keys that are letters
      if (event.key !== "Escape" || event.defaultPrevented) return;
      event.preventDefault();
      close();
    });
    popover.addEventListener("toggle", ({ newState }) => {
      if (newState === "open") return;
      removeEventListener("pointerdown", outside, true);
      removeEventListener("resize", place);
      sizes.disconnect();
      if (popover.contains(document.activeElement)) button.focus();
      popover.remove();
      end();
      closed();
    });
    document.getElementById("webviz")?.append(popover);
    popover.showPopover();
    addEventListener("pointerdown", outside, true);
    addEventListener("resize", place);
    sizes.observe(popover);
    place();
    /** @type {HTMLElement | null} */
    const first = popover.querySelector("input:not([hidden]), textarea, select");
    (first ?? popover).focus();
    return popover;
  });
}

/**
 * @param {HTMLElement} popover
 * @param {HTMLElement} button
 */
function placeBelow(popover, button) {
  if (!button.isConnected) return popover.hidePopover();
  const { right, top, bottom } = button.getBoundingClientRect();
  const { offsetWidth: width, offsetHeight: height } = popover;
  const below = bottom + GAP;
  const isAbove = below + height > innerHeight - GAP && top - GAP - height > 0;
  const y = isAbove ? top - GAP - height : Math.min(below, innerHeight - height - GAP);
  popover.style.left = `${Math.max(GAP, Math.min(right - width, innerWidth - width - GAP))}px`;
  popover.style.top = `${Math.max(GAP, y)}px`;
}
