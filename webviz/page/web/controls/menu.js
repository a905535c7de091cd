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
  const menu = new Menu(items, outer);
  menu.open(x, y);
  return () => menu.close();
}

class Menu {
  #before = /** @type {HTMLElement | null} */ (document.activeElement);
  #outer;
  /** @type {{element: HTMLElement, close: () => void} | null} */
  #inner = null; // the entry whose submenu is open, and what closes that

  /**
   * @param {(MenuItem | null)[]} items
   * @param {HTMLElement | null} outer
   */
  constructor(items, outer) {
    this.#outer = outer;
    this.element = el(
      "div",
      {
        class: "wv-menu",
        role: "menu",
        popover: "auto",
        tabindex: -1,
        onkeydown: (/** @type {KeyboardEvent} */ event) => this.#press(event),
        oncontextmenu: (/** @type {Event} */ event) => event.preventDefault(),
        ontoggle: (/** @type {ToggleEvent} */ { newState }) => newState === "open" || this.#end(),
      },
      items.map((item) =>
        item ? this.#entry(item) : el("div", { class: "wv-menu-line", role: "separator" }),
      ),
    );
    this.entries = /** @type {HTMLElement[]} */ ([
      ...this.element.querySelectorAll(".wv-menu-item:not([aria-disabled])"),
    ]);
  }

  /**
   * @param {number} x
   * @param {number} y
   */
  open(x, y) {
    const before = this.#before;
    const menu = this.element;
    // In a dialog, what is outside of it cannot be clicked; a submenu leaves the outer one open.
    const home = before?.closest("dialog") ?? document.getElementById("webviz");
    (this.#outer ?? home)?.append(menu);
    menu.showPopover();
    const { width, height } = menu.getBoundingClientRect();
    menu.style.left = `${Math.max(GAP, Math.min(x, innerWidth - width - GAP))}px`;
    menu.style.top = `${Math.max(GAP, Math.min(y, innerHeight - height - GAP))}px`;
    // Who opened it by a key goes on by keys.
    const [first] = this.entries;
    (before?.matches?.(":focus-visible") && first ? first : menu).focus();
  }

  close() {
    if (this.element.matches(":popover-open")) this.element.hidePopover();
  }

  #end() {
    // The focus is nowhere when its entry is gone; it stays where a click has put it.
    const focused = document.activeElement;
    if (this.element.contains(focused) || focused === document.body) this.#before?.focus();
    this.element.remove();
  }

  /**
   * @param {MenuItem} item
   * @returns {HTMLElement}
   */
  #entry(item) {
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
        onclick: () => disabled || (below ? this.#hover(element, below) : this.#choose(run)),
        onpointermove: () => this.#hover(element, disabled ? null : below),
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
  #hover(element, below) {
    if (this.#inner?.element === element && this.element.querySelector(":popover-open")) return;
    element.focus({ preventScroll: true });
    this.#inner?.close();
    this.#inner = below ? { element, close: this.#openBeside(element, below) } : null;
  }

  /**
   * @param {HTMLElement} element
   * @param {(MenuItem | null)[]} below
   */
  #openBeside(element, below) {
    const { right, top } = element.getBoundingClientRect();
    const wrapped = below.map((item) => item && { ...item, run: () => this.#choose(item.run) });
    return openMenu(right, top, wrapped, this.element);
  }

  /** @param {MenuItem["run"]} [run] */
  #choose(run) {
    this.close();
    run?.();
  }

  /** @param {KeyboardEvent} event */
  #press(event) {
    const { entries } = this;
    const at = entries.findIndex((entry) => entry === document.activeElement);
    const step = { ArrowDown: at + 1, ArrowUp: at < 0 ? -1 : at - 1, Home: 0, End: -1 }[event.key];
    const isMore = document.activeElement?.getAttribute("aria-haspopup") === "menu";
    if (event.key === "Escape" || event.key === "Tab") this.close();
    else if (event.key === "ArrowLeft" && this.#outer) this.close();
    else if (event.key === "ArrowRight" && isMore) entries[at]?.click();
    else if (event.key === "Enter" || event.key === " ") entries[at]?.click();
    else if (step !== undefined) entries.at(step % entries.length)?.focus();
    else startingWith(event.key, [...entries.slice(at + 1), ...entries])?.focus();
    if (!event.ctrlKey && !event.metaKey) event.preventDefault();
    event.stopPropagation();
  }
}

/**
 * The first entry whose label starts with a letter.
 *
 * @param {string} letter
 * @param {HTMLElement[]} entries
 */
function startingWith(letter, entries) {
  /** @param {HTMLElement} entry */
  const starts = (entry) =>
    entry
      .querySelector(".wv-menu-label")
      ?.textContent.toLowerCase()
      .startsWith(letter.toLowerCase());
  return letter.length === 1 ? entries.find(starts) : undefined;
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
