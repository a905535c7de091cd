// The frame of a panel that is not in the tabs: its head, and what it shows.

import { el, set, setText } from "../dom.js";
import { iconButton } from "../icons.js";
import { root } from "../signals.js";

/** @import {End, Panel} from "../types.js" */

/**
 * Opens a panel in an element; returns what ends it, with all effects that it has made.
 *
 * @param {Panel} panel
 * @param {HTMLElement} element
 * @returns {End}
 */
export const openIn = (panel, element) =>
  root((end) => {
    const close = panel.open(element);
    return () => {
      close?.();
      end();
    };
  });

/**
 * @param {Panel} panel
 * @param {{menu(button: HTMLElement): void, full(): void, close(): void}} acts
 */
export function makeFrame(panel, { menu, full, close }) {
  const title = el("b", {}, panel.title);
  const more = iconButton("dots", "More for this panel", () => menu(more));
  const whole = iconButton("fullscreen", "Full screen", full);
  const back = iconButton("close", "Back to the tabs", close);
  const head = el(
    "header",
    { class: "wv-docked-head", ondblclick: full },
    title,
    whole,
    more,
    back,
  );
  const body = el("div", { class: "wv-panel" });
  const element = el(
    "section",
    { class: "wv-docked", "aria-label": panel.title, "data-panel": panel.name },
    head,
    body,
  );
  const end = openIn(panel, body);
  return {
    element,
    head,
    close() {
      end();
      element.remove();
    },
    /** @param {string} text */
    setTitle(text) {
      setText(title, text);
      set(element, { "aria-label": text });
    },
    /** @param {boolean} isFull @param {boolean} isAlone */
    setFull(isFull, isAlone) {
      element.classList.toggle("wv-docked-full", isFull);
      const label = isFull ? "Leave full screen (Escape)" : "Full screen";
      set(whole, { "aria-pressed": String(isFull), "aria-label": label, "data-tip": label });
      for (const each of [whole, more, back]) set(each, { hidden: isAlone });
    },
  };
}
