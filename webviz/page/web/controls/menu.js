// Menus: a list of actions over everything else, with arrow keys.

import { why } from "webviz/access.js";
import { el } from "webviz/dom.js";
import { icon } from "webviz/icons.js";
import { keyText } from "webviz/keys.js";

/**
 * @typedef {{
 *   label: string, icon?: string, key?: string, run?: () => unknown, disabled?: boolean,
 *   danger?: boolean, checked?: boolean, needs?: string, tip?: string, items?: (MenuItem | null)[],
 * }} MenuItem
 */

const GAP = 4;

/**
 * Opens a menu with its corner at (x, y), in pixels of the window, or beside that if it does not
 * fit.
 *
 * `items`: `{label, icon, key, run, disabled, danger, checked, needs, tip, items}`, or null for a
 * line; `checked` is true or false for an item that shows a choice, `needs` names the command of the
 * viewer that it sends, which a role may not be allowed, `tip` says more about it, and `items` are
 * those of its submenu. `run` is called when the menu is closed and the focus is back where it was.
 * Returns what closes the menu. `outer` is the menu that a submenu belongs to.
 *
 * @param {number} x
 * @param {number} y
 * @param {(MenuItem | null)[]} items
 * @param {HTMLElement | null} [outer]
 * @returns {() => void}
 */
export function openMenu(x, y, items, outer = null) {
  const before = /** @type {HTMLElement | null} */ (document.activeElement);
  const menu = el(
    "div",
    { class: "wv-menu", role: "menu", popover: "auto", tabindex: -1 },
    items.map((item) =>
      item ? entry(item) : el("div", { class: "wv-menu-line", role: "separator" }),
    ),
  );
  const entries = [
    .../** @type {NodeListOf<HTMLElement>} */ (
      menu.querySelectorAll(".wv-menu-item:not([aria-disabled])")
    ),
  ];
  /** @type {{element: HTMLElement, close: () => void} | null} */
  let inner = null; // the entry whose submenu is open, and what closes that

  /**
   * @param {MenuItem} item
   * @returns {HTMLElement}
   */
  function entry(item) {
    const { label, icon: name, key, run, danger, checked, needs, tip, items: below } = item;
    const reason = needs ? why(needs) : "";
    const disabled = item.disabled || reason !== "";
    const isChoice = checked !== undefined;
    /** @type {HTMLElement} */
    const element = el(
      "div",
      {
        class: `wv-menu-item${danger ? " wv-danger" : ""}`,
        tabindex: -1,
        role: isChoice ? "menuitemradio" : "menuitem",
        "aria-checked": isChoice ? checked : null,
        "aria-disabled": disabled ? "true" : null,
        "data-why": reason || null,
        "aria-haspopup": below ? "menu" : null,
        "data-tip": tip || null,
        onclick: () => disabled || (below ? hover(element, below) : choose(run)),
        onpointermove: () => hover(element, disabled ? null : below),
      },
      el("span", { class: "wv-menu-icon" }, checked ? icon("check") : name ? icon(name) : null),
      el("span", { class: "wv-menu-label" }, label),
      key ? el("kbd", {}, keyText(key)) : null,
      below ? el("span", { class: "wv-menu-more", "aria-hidden": "true" }, "▸") : null,
    );
    return element;
  }

  /**
   * @param {HTMLElement} element
   * @param {MenuItem["items"] | null} [below]
   */
  function hover(element, below) {
    if (inner?.element === element && menu.querySelector(":popover-open")) return;
    element.focus({ preventScroll: true });
    inner?.close();
    inner = null;
    if (below) openBeside(element, below);
  }

  /**
   * @param {HTMLElement} element
   * @param {(MenuItem | null)[]} below
   */
  function openBeside(element, below) {
    const { right, top } = element.getBoundingClientRect();
    element.focus({ preventScroll: true });
    const wrapped = below.map((item) => item && { ...item, run: () => choose(item.run) });
    inner = { element, close: openMenu(right, top, wrapped, menu) };
  }

  function close() {
    if (menu.matches(":popover-open")) menu.hidePopover();
  }

  /** @param {MenuItem["run"]} [run] */
  function choose(run) {
    close();
    run?.();
  }

  /** @param {KeyboardEvent} event */
  function onKey(event) {
    const at = entries.findIndex((entry) => entry === document.activeElement);
    const step = { ArrowDown: at + 1, ArrowUp: at < 0 ? -1 : at - 1, Home: 0, End: -1 }[event.key];
    const isMore = document.activeElement?.getAttribute("aria-haspopup") === "menu";
    if (event.key === "Escape" || event.key === "Tab") close();
    else if (event.key === "ArrowLeft" && outer) close();
    else if (event.key === "ArrowRight" && isMore) entries[at]?.click();
    else if (event.key === "Enter" || event.key === " ") entries[at]?.click();
    else if (step !== undefined) entries.at(step % entries.length)?.focus();
    else startingWith(event.key, at)?.focus();
    if (!event.ctrlKey && !event.metaKey) event.preventDefault();
    event.stopPropagation();
  }

  /**
   * @param {string} letter
   * @param {number} at
   */
  function startingWith(letter, at) {
    /** @param {HTMLElement} entry */
    const starts = (entry) =>
      entry
        .querySelector(".wv-menu-label")
        ?.textContent.toLowerCase()
        .startsWith(letter.toLowerCase());
    return letter.length === 1 ? [...entries.slice(at + 1), ...entries].find(starts) : undefined;
  }

  menu.addEventListener("keydown", onKey);
  menu.addEventListener("contextmenu", (event) => event.preventDefault());
  menu.addEventListener("toggle", ({ newState }) => {
    if (newState === "open") return;
    // The focus is nowhere when its entry is gone; it stays where a click has put it.
    if (menu.contains(document.activeElement) || document.activeElement === document.body)
      before?.focus();
    menu.remove();
  });
  // In a dialog, what is outside of it cannot be clicked; a submenu leaves the outer one open.
  (outer ?? before?.closest("dialog") ?? document.getElementById("webviz"))?.append(menu);
  menu.showPopover();
  const { width, height } = menu.getBoundingClientRect();
  menu.style.left = `${Math.max(GAP, Math.min(x, innerWidth - width - GAP))}px`;
  menu.style.top = `${Math.max(GAP, Math.min(y, innerHeight - height - GAP))}px`;
  // Who opened it by a key goes on by keys.
  (before?.matches?.(":focus-visible") && entries[0] ? entries[0] : menu).focus();
  return close;
}

/**
 * Opens a menu below a button, or closes it if it is open.
 *
 * @param {HTMLElement} button
 * @param {(MenuItem | null)[]} items
 */
export function openMenuBelow(button, items) {
  const { left, bottom } = button.getBoundingClientRect();
  return openMenu(left, bottom + GAP, items);
}
