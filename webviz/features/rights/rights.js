// What others ask the owner to allow, over the scene; and what is allowed for this session.

import { onRole, why } from "webviz/access.js";
import { act } from "webviz/act.js";
import { provide } from "webviz/commands.js";
import { el } from "webviz/dom.js";
import { textButton } from "webviz/icons.js";
import { overlay } from "webviz/overlay/overlay.js";
import { computed, each } from "webviz/signals.js";
import { store } from "webviz/stores.js";

/** @import {PermissionRequest} from "webviz/contents.js" */
/** @import {Signal} from "webviz/signals.js" */

const MAX_SHOWN = 3;

export function install() {
  onRole(() => {
    if (why("Allow")) return;
    const values = store("permission_requests");
    overlay("cards", "rights", requests(values));
    provide(() =>
      (values.get("allowed") ?? []).map((name) => ({
        name: `Take back the right to use ${name}`,
        group: "Rights",
        run: () => act("Forbid", { name }),
      })),
    );
  });
}

/** @param {ReturnType<typeof store<"permission_requests">>} values */
function requests(values) {
  const waiting = computed(() => [...values.all()].filter(([name]) => name.startsWith("/")));
  const more = () => waiting.value.length - MAX_SHOWN;
  return el(
    "section",
    {
      class: "wv-card wv-requests",
      role: "status",
      "aria-label": "Requests",
      hidden: () => !waiting.value.length,
    },
    each(
      () => waiting.value.slice(0, MAX_SHOWN),
      ([name]) => name,
      (item, name) => request(item, name),
    ),
    el("p", { class: "wv-quiet", hidden: () => more() <= 0 }, () => `${more()} more wait.`),
  );
}

/**
 * @param {Signal<[string, PermissionRequest]>} item
 * @param {string} name
 */
function request(item, name) {
  const text = () => {
    const { who, use } = item.value[1];
    return `${who} asks to ${use}.`;
  };
  return el(
    "div",
    { class: "wv-request" },
    el("span", {}, text),
    textButton("Allow for this session", () => act("Allow", { name }), {
      class: "wv-button wv-primary",
    }),
    textButton("Not now", () => act("Decline", { name })),
  );
}
