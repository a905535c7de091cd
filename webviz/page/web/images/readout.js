// The text of a pane: the newest message of a topic, and how old it is.

import { rosNow, watchTime } from "webviz/clock.js";
import { el, setText } from "webviz/dom.js";
import { messageRows } from "webviz/panels/message_rows.js";
import { spanText } from "webviz/panels/units.js";
import { watch } from "webviz/stores.js";
import { hertz } from "webviz/words.js";

/** @import {PictureHeader} from "webviz/messages.js" */

const AGE_MS = 500;
const OLD_S = 1; // until then, an age says nothing that the rate does not say

/**
 * Fills `place` with the readout of a display: `{take(header, data), facts(), close()}`.
 *
 * @param {HTMLElement} place
 * @param {string} id
 */
export function makeReadout(place, id) {
  const about = el("div", { class: "wv-readout-about wv-quiet wv-ellipsis" });
  const rows = messageRows({ label: "Message", topic: () => last?.topic ?? "" });
  place.append(el("div", { class: "wv-readout" }, about, rows.element));
  /** @type {PictureHeader | null} */
  let last = null;
  let rate = "";
  let age = "";
  const ends = [
    watch(`rate:${id}`, (values) => {
      const hz = values.get("hz");
      rate = hz === undefined ? "" : hertz(hz, values.get("is_latched"));
    }),
    watchTime(AGE_MS, (clock) => {
      const received = clock.has("pace") ? last?.received : undefined;
      const old = received === undefined ? 0 : rosNow(clock) - received;
      age = old > OLD_S ? `${spanText(old)} ago` : "";
    }),
  ];
  return {
    /**
     * @param {PictureHeader} header
     * @param {Uint8Array<ArrayBuffer>} data
     */
    take(header, data) {
      last = header;
      setText(about, [header.topic, header.type].filter(Boolean).join(" · "));
      rows.show(JSON.parse(new TextDecoder().decode(data)));
    },
    facts: () => [rate, age].filter(Boolean).join(" · "),
    close() {
      for (const end of ends) end();
      rows.close();
    },
  };
}
