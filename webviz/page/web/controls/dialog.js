// Dialogs over everything else: they have the focus until they are closed.

import { textField } from "webviz/controls/fields.js";
import { el, newId } from "webviz/dom.js";
import { iconButton } from "webviz/icons.js";

/** @import {Child} from "webviz/types.js" */

/**
 * @typedef {{label: string | (() => string), value: unknown, primary?: boolean, danger?: boolean, focused?: boolean,
 *   accept?: () => unknown}} DialogButton
 * @typedef {(value?: unknown) => void} Close
 * @typedef {{title: string, content: Child | Child[] | ((close: Close) => Child | Child[]),
 *   buttons?: DialogButton[], isLight?: boolean, className?: string}} DialogOptions
 */

/**
 * Opens a dialog; resolves with the value of the button that was chosen, null on Escape.
 *
 * `content`: a string, an element or several, or a function that makes them from what closes the
 * dialog: `(close) => element`, to be called with a value. `buttons`: `{label, value, primary,
 * danger, focused, accept}`; Enter in a field is the primary one. `accept()`, which may be
 * asynchronous, is asked first: unless it returns true the dialog stays. `isLight`: a click beside
 * it closes it, too.
 *
 * @param {DialogOptions} options
 * @returns {Promise<any>}
 */
export function openDialog({ title, content, buttons = [], isLight = false, className = "" }) {
  const id = newId("dialog");
  /** @type {unknown} */
  let answer = null;
  let isBusy = false;

  /** @param {unknown} [value] */
  function close(value = null) {
    if (!dialog.open) return;
    answer = value;
    dialog.close();
    // At once, so that no key goes to what had the focus in it.
    dialog.remove();
  }

  /** @param {DialogButton} button */
  async function choose({ value, accept }) {
    if (isBusy) return;
    isBusy = true;
    try {
      if (!accept || (await accept()) === true) close(value);
    } finally {
      isBusy = false;
    }
  }

  const primary = buttons.find((button) => button.primary);
  const children = typeof content === "function" ? content(close) : content;
  const dialog = el(
    "dialog",
    { class: `wv-dialog ${className}`, "aria-labelledby": id },
    el(
      "form",
      {
        method: "dialog",
        novalidate: true,
        onsubmit: (event) => {
          event.preventDefault();
          if (primary) choose(primary);
        },
      },
      header(id, title, close),
      el("div", { class: "wv-dialog-content", tabindex: -1 }, children),
      footer(buttons, choose),
    ),
  );
  endBy(dialog, isLight, close);
  /** @type {HTMLElement} */ (document.getElementById("webviz")).append(dialog);
  dialog.showModal();
  focusFirst(dialog);
  return new Promise((resolve) => {
    dialog.addEventListener("close", () => {
      dialog.remove();
      resolve(answer);
    });
  });
}

/**
 * @param {string} id
 * @param {string} title
 * @param {Close} close
 */
const header = (id, title, close) =>
  el(
    "header",
    { class: "wv-dialog-head" },
    el("h2", { id }, title),
    iconButton("close", "Close", () => close(), { tip: null }),
  );

/**
 * @param {DialogButton[]} buttons
 * @param {(button: DialogButton) => unknown} choose
 */
function footer(buttons, choose) {
  if (!buttons.length) return null;
  const all = buttons.map((button) =>
    el(
      "button",
      {
        type: button.primary ? "submit" : "button",
        autofocus: button.focused,
        class: classOf(button),
        onclick: button.primary ? null : () => choose(button),
      },
      button.label,
    ),
  );
  return el("footer", { class: "wv-dialog-buttons" }, all);
}

/**
 * Closes a dialog on Escape, and a light one on a click beside it.
 *
 * @param {HTMLElement} dialog
 * @param {boolean} isLight
 * @param {Close} close
 */
function endBy(dialog, isLight, close) {
  // viser's page and the commands have keys that are letters.
  dialog.addEventListener("keydown", (event) => {
    event.stopPropagation();
    if (event.key !== "Escape" || event.defaultPrevented) return;
    event.preventDefault();
    close();
  });
  if (!isLight) return;
  dialog.addEventListener("pointerdown", (event) => {
    if (event.target === dialog) close();
  });
}

/**
 * Not the button that closes it, which the browser takes.
 *
 * @param {HTMLElement} dialog
 */
function focusFirst(dialog) {
  const body = /** @type {HTMLElement} */ (dialog.querySelector(".wv-dialog-content"));
  /** @type {HTMLElement | null} */
  const first = body.querySelector("input:not([hidden]), textarea, select, button:not(:disabled)");
  /** @type {HTMLElement | null} */
  const chosen = dialog.querySelector("[autofocus]");
  (chosen ?? first ?? body).focus();
}

/** @param {DialogButton} button */
const classOf = ({ primary, danger }) =>
  ["wv-button", primary && "wv-primary", danger && "wv-danger"].filter(Boolean).join(" ");

/**
 * Asks a question; resolves with true if it was confirmed. The focus is on Cancel.
 *
 * @param {string} text
 * @param {{confirm?: string, title?: string, danger?: boolean}} [options]
 */
export async function ask(text, { confirm = "OK", title = "Are you sure?", danger = false } = {}) {
  const buttons = [
    { label: "Cancel", value: false, focused: true },
    { label: confirm, value: true, primary: !danger, danger },
  ];
  return (await openDialog({ title, content: el("p", {}, text), buttons })) === true;
}

/**
 * Asks for a name; resolves with it, or with null if the dialog is cancelled.
 *
 * @param {string} noun what has the name, such as "layout"
 * @param {{
 *   title: string, confirm: string, usedNames: string[], value?: string,
 *   accept?: (name: string) => unknown,
 * }} options `value` is there at first, by default one that is not `taken`; the name is taken only
 *   once `accept` says true
 * @returns {Promise<string | null>}
 */
export async function askName(noun, { title, confirm, usedNames, value, accept }) {
  const stem = noun[0].toUpperCase() + noun.slice(1);
  let number = 1;
  while (usedNames.includes(`${stem} ${number}`)) number += 1;
  const field = textField(`Name of the ${noun}`, {
    value: value ?? `${stem} ${number}`,
    autofocus: true,
    onfocus: (/** @type {FocusEvent & {target: HTMLInputElement}} */ { target }) => target.select(),
  });
  const buttons = [
    { label: "Cancel", value: false },
    {
      label: confirm,
      value: true,
      primary: true,
      accept: accept && (() => accept(field.value.trim())),
    },
  ];
  return (await openDialog({ title, content: field, buttons })) ? field.value.trim() : null;
}
