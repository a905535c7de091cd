// The bookmarks of a recording: a menu to go to them, to add and to remove them.

import { act } from "../act.js";
import { el } from "../dom.js";
import { icon } from "../icons.js";
import { openDialog } from "../shell/dialog.js";
import { openMenu } from "../shell/menu.js";
import { duration } from "../shell/time_text.js";

/** @import {Seeks} from "./seeks.js" */

/** @typedef {ReturnType<typeof bookmarks>} Bookmarks */

/**
 * Returns `{element, show(all), add()}`; `all` are pairs of name and time, `position()` is the time.
 *
 * @param {Seeks} seek
 * @param {() => number} position
 */
export function bookmarks(seek, position) {
  /** @type {[string, number][]} */
  let all = [];
  const button = el(
    "button",
    {
      type: "button",
      class: "wv-icon",
      "aria-label": "Bookmarks",
      "data-tip": "Bookmarks: moments with names",
      onclick: open,
    },
    icon("flag"),
  );

  function open() {
    const { left, top } = button.getBoundingClientRect();
    /**
     * @param {[string, number]} bookmark
     * @param {() => void} run
     */
    const entry = ([name, at], run) => ({ label: `${name} · ${duration(at)}`, run });
    /** @type {Parameters<typeof openMenu>[2]} */
    const items = [
      { label: "Add bookmark…", icon: "plus", key: "b", needs: "SaveBookmark", run: add },
      ...(all.length ? [null] : []),
      ...all.map((one) => ({ ...entry(one, () => seek.to(one[1])), icon: "flag", needs: "Seek" })),
    ];
    if (all.length) {
      const removals = all.map((one) => entry(one, () => act("RemoveBookmark", { name: one[0] })));
      items.push(null, {
        label: "Remove",
        icon: "trash",
        needs: "RemoveBookmark",
        items: removals,
      });
    }
    openMenu(left, top, items);
  }

  async function add() {
    const at = position();
    const taken = new Set(all.map(([name]) => name));
    let number = 1;
    while (taken.has(`Bookmark ${number}`)) number += 1;
    const field = el("input", {
      class: "wv-field",
      type: "text",
      "aria-label": "Name of the bookmark",
      value: `Bookmark ${number}`,
      autofocus: true,
      onfocus: (/** @type {FocusEvent & {target: HTMLInputElement}} */ { target }) =>
        target.select(),
    });
    const answer = await openDialog({
      title: `Bookmark at ${duration(at)}`,
      content: field,
      buttons: [
        { label: "Cancel", value: null },
        { label: "Add", value: true, primary: true },
      ],
    });
    if (answer) act("SaveBookmark", { name: field.value.trim(), at_s: at });
  }

  return {
    element: button,
    /** @param {[string, number][]} next */
    show: (next) => (all = next),
    add,
  };
}
