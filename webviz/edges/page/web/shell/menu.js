// Menus: a list of actions over everything else, with arrow keys.

import { el } from "../dom.js";
import { icon } from "../icons.js";
import { keyText } from "./keys.js";

const GAP = 4;

/**
 * Opens a menu with its corner at (x, y), in pixels of the window, or beside that if it does not
 * fit.
 *
 * `items`: `{label, icon, key, run, disabled, danger, checked}`, or null for a line; `checked` is
 * true or false for an item that shows a choice. `run` is called when the menu is closed and the
 * focus is back where it was. Returns what closes the menu.
 */
export function openMenu(x, y, items) {
  const before = document.activeElement;
  const menu = el(
    "div",
    { class: "wv-menu", role: "menu", popover: "auto", tabindex: -1 },
    items.map((item) =>
      item ? entry(item) : el("div", { class: "wv-menu-line", role: "separator" }),
    ),
  );
  const entries = [...menu.querySelectorAll(".wv-menu-item:not([aria-disabled])")];

  function entry({ label, icon: name, key, run, disabled, danger, checked }) {
    const isChoice = checked !== undefined;
    return el(
      "div",
      {
        class: `wv-menu-item${danger ? " wv-danger" : ""}`,
        tabindex: -1,
        role: isChoice ? "menuitemradio" : "menuitem",
        "aria-checked": isChoice ? checked : null,
        "aria-disabled": disabled ? "true" : null,
        onclick: () => disabled || choose(run),
        onpointermove: (event) => event.currentTarget.focus({ preventScroll: true }),
      },
      el("span", { class: "wv-menu-icon" }, checked ? icon("check") : name ? icon(name) : null),
      el("span", { class: "wv-menu-label" }, label),
      key ? el("kbd", {}, keyText(key)) : null,
    );
  }

  function close() {
    if (menu.matches(":popover-open")) menu.hidePopover();
  }

  function choose(run) {
    close();
    run?.();
  }

  function onKey(event) {
    const at = entries.indexOf(document.activeElement);
    const step = { ArrowDown: at + 1, ArrowUp: at < 0 ? -1 : at - 1, Home: 0, End: -1 }[event.key];
    if (event.key === "Escape" || event.key === "Tab") close();
    else if (event.key === "Enter" || event.key === " ") entries[at]?.click();
    else if (step !== undefined) entries.at(step % entries.length)?.focus();
    else startingWith(event.key, at)?.focus();
    if (!event.ctrlKey && !event.metaKey) event.preventDefault();
    event.stopPropagation();
  }

  function startingWith(letter, at) {
    const starts = (entry) =>
      entry
        .querySelector(".wv-menu-label")
        .textContent.toLowerCase()
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
  // In a dialog, what is outside of it cannot be clicked.
  (before?.closest?.("dialog") ?? document.getElementById("webviz")).append(menu);
  menu.showPopover();
  const { width, height } = menu.getBoundingClientRect();
  menu.style.left = `${Math.max(GAP, Math.min(x, innerWidth - width - GAP))}px`;
  menu.style.top = `${Math.max(GAP, Math.min(y, innerHeight - height - GAP))}px`;
  // Who opened it by a key goes on by keys.
  (before?.matches?.(":focus-visible") && entries[0] ? entries[0] : menu).focus();
  return close;
}

/** Opens a menu below a button, or closes it if it is open. */
export function openMenuBelow(button, items) {
  const { left, bottom } = button.getBoundingClientRect();
  return openMenu(left, bottom + GAP, items);
}
