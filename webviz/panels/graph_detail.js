// The details of the box that was chosen in the panel Graph.

import { el } from "webviz/dom.js";
import { iconButton } from "webviz/icons.js";

/** @import {Box, Link} from "./graph_layout.js" */

const MOST = 100; // lines of a list

/**
 * The elements about a box: its bar, and what is linked with it.
 *
 * @param {Box} box
 * @param {{links: Link[], folds: [string, string][], toggle: (namespace: string) => void, close: () => void}} options
 */
export function about(box, { links, folds, toggle, close }) {
  /** @param {string} title @param {string[]} lines */
  const part = (title, lines) => {
    if (!lines.length) return [];
    const items = lines.slice(0, MOST).map((line) => el("li", {}, line));
    return [el("div", { class: "wv-quiet" }, title), el("ul", {}, items)];
  };
  const mine = links.filter(({ from, to }) => from === box || to === box);
  const into = mine.flatMap(({ from, to }) => (to === box ? from.name : []));
  const out = mine.flatMap(({ to }) => (to === box ? [] : to.name));
  const buttons = folds.map(([text, namespace]) =>
    el("button", { type: "button", class: "wv-link", onclick: () => toggle(namespace) }, text),
  );
  const isTopic = box.kind === "topic";
  return [
    el(
      "div",
      { class: "wv-plugin-bar" },
      el("b", { class: "wv-ellipsis" }, box.name),
      ...buttons,
      iconButton("close", "Close", close),
    ),
    el("div", { class: "wv-quiet" }, box.about),
    ...part(
      "Does not arrive",
      mine.flatMap(({ why }) => why || []),
    ),
    ...part(isTopic ? "Published by" : "Reads", into),
    ...part(isTopic ? "Read by" : "Publishes", out),
  ];
}
