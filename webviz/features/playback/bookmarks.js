// The bookmarks of a recording: a menu to go to them, to add and to remove them.

import { act } from "webviz/act.js";
import { iconButton } from "webviz/icons.js";
import { askName } from "webviz/controls/dialog.js";
import { openMenu } from "webviz/controls/menu.js";
import { store } from "webviz/stores.js";
import { duration } from "webviz/time_text.js";

/** @import {Seeks} from "webviz/features/playback/rewound.js" */

/** @typedef {ReturnType<typeof bookmarks>} Bookmarks */

const bookmarkStore = store("bookmarks");
/** Names and times; the timeline reads them while it is there. */
const pairs = () => bookmarkStore.get("all") ?? [];

/**
 * Returns `{element, add()}`; `position()` is the time, and `hidden()` is read in effects.
 *
 * @param {Seeks} seek
 * @param {() => number} position
 * @param {() => boolean} hidden
 */
export function bookmarks(seek, position, hidden) {
  const tip = "Bookmarks: moments with names";
  const button = iconButton("flag", "Bookmarks", open, { tip, hidden });

  function open() {
    const all = pairs();
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
    const name = await askName("bookmark", {
      title: `Bookmark at ${duration(at)}`,
      confirm: "Add",
      usedNames: pairs().map(([each]) => each),
    });
    if (name !== null) act("SaveBookmark", { name, at_s: at });
  }

  return { element: button, add };
}
