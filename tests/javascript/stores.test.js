import assert from "node:assert/strict";
import { test } from "node:test";

import * as channel from "../../webviz/page/web/channel.js";
import { computed, effect } from "../../webviz/page/web/signals.js";
import { once, store, watch } from "../../webviz/page/web/stores.js";

/** @import {End} from "webviz/types.js" */

/** @typedef {Parameters<typeof channel.open>[0]} Socket */

/** What the page sends, and a function by which the server sends values of a store. */
function server() {
  /** @type {{type: string, [field: string]: unknown}[]} */
  const sent = [];
  /** @type {Socket} */
  const socket = {
    binaryType: "blob",
    readyState: WebSocket.OPEN,
    send: (text) => sent.push(JSON.parse(String(text))),
    close() {},
    onopen: null,
    onmessage: null,
    onclose: null,
  };
  channel.open(socket, "key");
  socket.onopen?.(new Event("open"));
  return {
    sent,
    /**
     * @param {string} store
     * @param {Record<string, unknown>} set
     * @param {{all?: boolean, gone?: string[]}} [more]
     */
    values(store, set, { all = false, gone = [] } = {}) {
      const data = JSON.stringify({ type: "Values", store, all, set, gone });
      socket.onmessage?.(new MessageEvent("message", { data }));
    },
  };
}

/**
 * An effect that keeps what it reads.
 *
 * @template T
 * @param {() => T} read
 */
function follow(read) {
  /** @type {T[]} */
  const seen = [];
  const end = effect(() => void seen.push(read()));
  return { seen, end };
}

const later = () => new Promise((resolve) => queueMicrotask(() => resolve(null)));

test("a store is watched while something reads it, and read by key", async () => {
  const { sent, values } = server();
  const speeds = store("speeds");
  assert.equal(speeds.get("a"), undefined);
  const [a, b] = [follow(() => speeds.get("a")), follow(() => speeds.get("b"))];
  assert.deepEqual(sent.slice(1), [{ type: "Watch", store: "speeds" }]);
  values("speeds", { a: 1, b: 2 }, { all: true });
  values("speeds", { a: 3 });
  assert.deepEqual(
    [a.seen, b.seen],
    [
      [undefined, 1, 3],
      [undefined, 2],
    ],
  );
  a.end();
  await later();
  assert.equal(sent.length, 2);
  b.end();
  await later();
  assert.deepEqual(sent.slice(2), [{ type: "Unwatch", store: "speeds" }]);
  assert.equal(speeds.get("b"), undefined, "what is not watched any more is old");
});

test("an effect runs once for a message, and where a key goes", () => {
  const { values } = server();
  const reader = store("pairs");
  const { seen, end } = follow(() => [reader.get("x"), reader.get("y"), reader.has("z")]);
  values("pairs", { x: 1, y: 1, z: 1 }, { all: true });
  values("pairs", {}, { gone: ["z"] });
  values("pairs", { y: 2 }, { all: true });
  assert.deepEqual(seen.slice(1), [
    [1, 1, true],
    [1, 1, false],
    [undefined, 2, false],
  ]);
  end();
});

test("all values are read as one, and a computed value notices that a key went meanwhile", () => {
  const { values } = server();
  const reader = store("names");
  const first = computed(() => reader.get("a"));
  const all = follow(() => [...reader.all().keys()].join());
  values("names", { a: 1, b: 2 }, { all: true });
  assert.equal(first.value, 1);
  values("names", {}, { gone: ["a"] });
  assert.equal(first.value, undefined);
  values("names", { a: 5 });
  assert.deepEqual([first.value, all.seen], [5, ["", "a,b", "b", "b,a"]]);
  all.end();
});

test("a store read again at once is not requested again, and is on a new connection", async () => {
  const { sent } = server();
  const reader = store("places");
  const { end } = follow(() => reader.get("a"));
  end();
  const { end: endAgain } = follow(() => reader.get("a"));
  await later();
  assert.equal(sent.length, 2);
  assert.deepEqual(server().sent.slice(1), [{ type: "Watch", store: "places" }]);
  endAgain();
});

test("a listener gets all values, then changes, and adds no dependency", () => {
  const { values } = server();
  /** @type {string[][][]} */
  const calls = [];
  /** @type {End[]} */
  const ends = [];
  let runs = 0;
  effect(() => {
    runs += 1;
    ends.push(watch("rows", (all, changed) => calls.push([[...all.keys()], [...changed]])));
    ends.push(watch("rows", (all) => void all.get("a")));
  });
  values("rows", { a: 1 }, { all: true });
  values("rows", { b: 2 });
  assert.deepEqual(
    [calls, runs],
    [
      [
        [["a"], ["a"]],
        [["a", "b"], ["b"]],
      ],
      1,
    ],
  );
  for (const end of [...ends, ...ends]) end();
});

test("a change that is still under way when a store is watched again is not its first values", async () => {
  const { sent, values } = server();
  const end = watch("panel", () => {});
  values("panel", { id: "plot", title: "Plot" }, { all: true });
  end();
  await later();
  values("panel", { title: "Curves" });
  const id = once("panel", (all) => all.get("id"));
  assert.deepEqual(
    sent.slice(1).map(({ type }) => type),
    ["Watch", "Unwatch", "Watch"],
  );
  values("panel", { title: "Curve" });
  values("panel", { id: "plot", title: "Curve" }, { all: true });
  assert.equal(await id, "plot");
});

test("values that come when nothing watches a store any more are not kept", async () => {
  const { values } = server();
  watch("old", () => {})();
  await later();
  values("old", { a: 1 }, { all: true });
  /** @type {unknown[]} */
  const seen = [];
  const end = watch("old", (all) => seen.push(all.get("a")));
  values("old", { a: 2 }, { all: true });
  assert.deepEqual(seen, [2]);
  end();
});
