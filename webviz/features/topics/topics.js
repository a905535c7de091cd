// The panel "Topics": all topics in a table, and the last message of the one that is chosen.

import { el, set, setText } from "../../dom.js";
import { icon } from "../../icons.js";
import { recall, remember } from "../../remember.js";
import { rowList, touchable } from "../../controls/rows.js";
import { searchField } from "../../controls/fields.js";
import { panel } from "../../panels/panels.js";
import { watch } from "../../stores.js";
import { inspector } from "./topics_inspector.js";
import { arranged, COLUMNS, makeHead, makeRow, updateRow } from "../../panels/topics_table.js";

/** @import {Panel, ValuesOf} from "../../types.js" */
/** @import {Sort} from "../../panels/topics_table.js" */

const WIDE_PX = 600;
const HEIGHTS = { wide: 26, narrow: 44 };
const NOTHING = "No topic is published. Start the robot, a simulator or a bag.";

export const install = () => panel(topics);

/** @type {Panel} */
const topics = {
  name: "topics",
  title: "Topics",
  order: 30,
  open(element) {
    /** @type {ValuesOf<"topics">} */
    let facts = new Map();
    /** @type {ValuesOf<"traffic">} */
    let traffic = new Map();
    /** @type {Sort} */
    let sort = recall("topics-sort", { column: "name", isUp: true });
    /** @type {ReturnType<typeof inspector> | null} */
    let inspected = null;

    const search = searchField("Filter topics", show);
    const head = makeHead(sortBy);
    const table = el("div", { class: "wv-topics-table" }, head.element);
    const list = rowList({
      host: table,
      label: "Topics",
      role: "grid",
      rowRole: "row",
      height: HEIGHTS.narrow,
      make: makeRow,
      update: updateRow,
      choose: ({ key }) => inspect(key),
    });
    table.append(list.element);
    const empty = el("div", { class: "wv-empty", role: "status", hidden: true });
    const place = el("div", { class: "wv-topics-message" });
    const panel = el(
      "div",
      { class: "wv-topics" },
      el("div", { class: "wv-search" }, icon("search"), search),
      table,
      empty,
      place,
    );
    element.append(panel);

    /** @param {string} column */
    function sortBy(column) {
      const isNumber = COLUMNS.find(({ id }) => id === column)?.isNumber ?? false;
      sort = { column, isUp: sort.column === column ? !sort.isUp : !isNumber };
      remember("topics-sort", sort);
      show();
    }

    function show() {
      head.update(sort);
      const all = [...facts].map(([key, topic]) => ({ key, ...topic, ...traffic.get(key) }));
      const found = arranged(all, search.value, sort);
      list.show(found);
      set(table, { "aria-rowcount": found.length + 1 });
      setText(empty, all.length ? "No matching topics." : NOTHING);
      set(empty, { hidden: found.length > 0 });
      const name = inspected?.name;
      inspected?.update(all.find(({ key }) => key === name));
    }

    /** @param {string} name */
    function inspect(name) {
      if (inspected?.name === name) return;
      inspected?.close();
      inspected = inspector(place, name, () => {
        inspected?.close();
        inspected = null;
        table.focus();
      });
      show();
    }

    const observer = new ResizeObserver(([{ contentRect }]) => {
      const isWide = contentRect.width >= WIDE_PX;
      panel.classList.toggle("wv-wide", isWide);
      list.resize(touchable(isWide ? HEIGHTS.wide : HEIGHTS.narrow));
    });
    observer.observe(panel);
    const ends = [
      watch("topics", (values) => {
        facts = values;
        show();
      }),
      watch("traffic", (values) => {
        traffic = values;
        if (facts.size) show();
      }),
    ];
    return () => {
      for (const end of ends) end();
      observer.disconnect();
      list.close();
      inspected?.close();
    };
  },
};
