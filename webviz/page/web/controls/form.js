// The properties of something, one below the other, with those that belong together in sections.

import { el, set, setText } from "../dom.js";
import { icon } from "../icons.js";
import { recall, remember } from "../remember.js";
import { row } from "./property_row.js";

/** @import {DeclaredProperty, LiveTopic} from "../contents.js" */
/** @import {FormValues, Known, SendProperty} from "../types.js" */

/**
 * Rows for properties as `content/forms.py` declares them.
 *
 * `send(path, value)` sends what was entered and returns the promise of `act`. `name` is
 * what this browser remembers by which sections are folded. `marks`: whether what differs from the
 * default is marked. `command`: of the viewer, that `send` uses, if a role may not be allowed it. Returns `{element, update(values, changed), end()}`: values of a store with "value.",
 * "offered." and "topic." before the paths, and which are new.
 *
 * @param {DeclaredProperty[]} declared
 * @param {{send: SendProperty, name: string, marks?: boolean, command?: string}} options
 */
export function form(declared, { send, name, marks = true, command = "" }) {
  /** @type {Map<string, ReturnType<typeof row>>} */
  const rows = new Map();
  /** @type {{element: HTMLElement, when: [string, unknown[]][]}[]} */
  const parts = []; // what is hidden while it does not apply
  /** @type {Map<string, (known: LiveTopic) => void>} */
  const lives = new Map();
  /** @type {{key: string, made: ReturnType<typeof row>}[]} */
  const followers = [];
  let depth = 0;

  /**
   * @template T
   * @param {() => T} make
   */
  function deeper(make) {
    depth += 1;
    const made = make();
    depth -= 1;
    return made;
  }

  /** @param {DeclaredProperty} property */
  function add(property) {
    const element = build(property);
    element.style.setProperty("--wv-depth", String(depth));
    if (property.when) parts.push({ element, when: property.when });
    return element;
  }

  /**
   * @param {DeclaredProperty} property
   * @returns {HTMLElement}
   */
  function build(property) {
    if (property.kind === "topic") return topic(property);
    if (property.kind === "group") return section(property);
    const made = row(property, send, { marks, command });
    rows.set(property.path, made);
    if (property.otherwise) followers.push({ key: `value.${property.otherwise}`, made });
    return made.element;
  }

  /** @param {DeclaredProperty} property */
  function topic(property) {
    const [named, ...rest] = property.children ?? [];
    const { label, help, type } = property;
    const made = row({ ...named, kind: "topic", label, help, type }, send, { marks, command });
    rows.set(named.path, made);
    const qos = el("span");
    const note = el("div", { class: "wv-section-note" }, qos);
    lives.set(property.path, (known) => {
      made.live(known);
      setText(qos, known.qos);
    });
    const inner = deeper(() => rest.map(add));
    const fold = foldable(`${property.path}.qos`, "QoS", note, inner, false);
    return el("div", { class: "wv-topic-property" }, made.element, fold);
  }

  /**
   * As in RViz, a group may have a value of its own, which stands in its line.
   *
   * @param {DeclaredProperty} property
   */
  function section({ path, label, help, children = [] }) {
    const own = children.find((child) => child.path === `${path}.value`);
    const rest = children.filter((child) => child !== own);
    const made = own && row({ ...own, help: own.help || help }, send, { marks, command });
    if (made) rows.set(own.path, made);
    const inner = deeper(() => rest.map(add));
    return foldable(path, label, made ? made.element : null, inner, true, help);
  }

  /**
   * @param {string} path
   * @param {string} label
   * @param {HTMLElement | null} beside
   * @param {HTMLElement[]} children
   * @param {boolean} isOpenAtFirst
   * @param {string} [help]
   */
  function foldable(path, label, beside, children, isOpenAtFirst, help = "") {
    const key = `fold.${name}.${path}`;
    const inner = el(
      "div",
      { class: "wv-section-inner", role: "group", "aria-label": label },
      children,
    );
    const toggle = el(
      "button",
      {
        type: "button",
        class: "wv-section-fold",
        title: help || null,
        "aria-label": label,
        onclick: () => show(Boolean(inner.hidden)),
      },
      icon("chevron", 12),
      beside?.matches(".wv-property") ? null : label,
    );

    /** @param {boolean} isOpen */
    function show(isOpen) {
      inner.hidden = !isOpen;
      set(toggle, { "aria-expanded": String(isOpen) });
      remember(key, isOpen);
    }

    show(recall(key, isOpenAtFirst));
    return el(
      "div",
      { class: "wv-section" },
      el("div", { class: "wv-section-head" }, toggle, beside),
      inner,
    );
  }

  const element = el("div", { class: "wv-form" }, declared.map(add));
  return {
    element,
    /**
     * @param {FormValues} values
     * @param {Set<string>} changed
     */
    update(values, changed) {
      for (const key of changed) {
        const [kind, path] = split(key);
        if (!values.has(key)) continue;
        if (kind === "value") rows.get(path)?.update(values.get(key));
        if (kind === "offered") rows.get(path)?.live(/** @type {Known} */ (values.get(key)));
        if (kind === "topic") lives.get(path)?.(/** @type {LiveTopic} */ (values.get(key)));
      }
      for (const { key, made } of followers) if (changed.has(key)) made.follow(values.get(key));
      for (const part of parts) {
        const isShown = part.when.every(([path, wanted]) =>
          wanted.includes(values.get(`value.${path}`)),
        );
        if (part.element.hidden === isShown) part.element.hidden = !isShown;
      }
    },
    end() {
      for (const made of rows.values()) made.end();
    },
  };
}

/** @param {string} key */
function split(key) {
  const dot = key.indexOf(".");
  return [key.slice(0, dot), key.slice(dot + 1)];
}
