import assert from "node:assert/strict";
import { test } from "node:test";

import { parse as parseColor } from "../../webviz/page/web/controls/color.js";
import { decode, encode } from "../../webviz/page/web/controls/lines.js";
import { bounds, format, parse, stepOf, within } from "../../webviz/page/web/controls/units.js";

/** @import {DeclaredProperty} from "webviz/contents.js" */

/** @typedef {Pick<DeclaredProperty, "kind" | "items">} Items */

test("numbers are typed with their unit or another of its kind", () => {
  const typed = {
    "5 cm": 0.05,
    "20mm": 0.02,
    " 3 m ": 3,
    ".5": 0.5,
    "5.": 5,
    "1e-3": 0.001,
    "+7": 7,
    "2 in": 0.0508,
    "−4": -4,
    "3 MM": 0.003,
    "1e308": 1e308,
    "1e-400": 0,
  };
  for (const [text, value] of Object.entries(typed)) assert.equal(parse(text, "m"), value, text);
  assert.equal(parse("180 °", "rad"), 3.14159265359);
  assert.equal(parse("8", ""), 8);
  assert.equal(parse("8 widgets", "widgets"), 8);
});

test("capital letters tell units apart only where they must", () => {
  assert.equal(parse("2 MHz", "Hz"), 2e6);
  assert.equal(parse("2 mHz", "Hz"), 0.002);
  assert.equal(parse("2 khz", "Hz"), 2000);
});

test("numbers that mean nothing are refused with the reason", () => {
  /** @type {[string, string, RegExp][]} */
  const refused = [
    ["much", "m", /“much” is not a number/],
    ["", "m", /“” is not a number/],
    ["NaN", "m", /not a number/],
    ["Infinity", "m", /not a number/],
    ["0x10", "m", /“x10” is not a valid unit/],
    ["1e999", "m", /too large/],
    ["1e308 km", "m", /too large/],
    ["5 kg", "m", /“kg” is not a valid unit here; use km, m/],
    ["5 constructor", "m", /“constructor” is not a valid unit here/],
    ["5 m", "", /without a unit/],
    ["5 m", "widgets", /use widgets/],
    ["y".repeat(1e5), "m", /^.{0,120}$/],
  ];
  for (const [text, unit, reason] of refused)
    assert.throws(() => parse(text, unit), { message: reason });
});

test("a field shows a number as short as it can be", () => {
  const texts = [0.1 + 0.2, -0, 2, 1e-7, 123456.7891234, 1e15, 1e308, NaN, Infinity].map(format);
  assert.deepEqual(texts, [
    "0.3",
    "0",
    "2",
    "1e-7",
    "123456.789123",
    "1000000000000000",
    "1e+308",
    "",
    "",
  ]);
});

test("a step suits the range, or else the size of the value", () => {
  assert.equal(stepOf({ kind: "int" }, 1e6), 1);
  assert.equal(stepOf({ kind: "float", low: 0, high: 1 }, 0.5), 0.01);
  assert.equal(stepOf({ kind: "float" }, 0), 0.1);
  assert.equal(stepOf({ kind: "float" }, -250), 10);
  assert.equal(stepOf({ kind: "float" }, 1e308), 1e307);
});

test("values stay within their bounds, also within open ones", () => {
  assert.equal(within({ kind: "float", low: 0, high: 1 }, 1.234, 0.1), 1);
  assert.equal(within({ kind: "float", low: 0, high: 1 }, -3, 0.1), 0);
  assert.equal(within({ kind: "float", above: 0 }, -1, 0.1), 0.1);
  assert.equal(within({ kind: "float", below: 2 }, 2, 0.5), 1.5);
  assert.equal(within({ kind: "int", above: 0 }, 0.2, 0.5), 1);
  assert.equal(within({ kind: "int", below: 9 }, 9, 0.5), 8);
  assert.equal(within({ kind: "float" }, 0.30000000000000004, 0.1), 0.3);
});

test("bounds are shown with their unit", () => {
  assert.equal(bounds({ low: 0, high: 1, unit: "m" }), "0 to 1 m");
  assert.equal(bounds({ above: 0, below: 5 }), "> 0, < 5");
  assert.equal(bounds({ low: -1 }), "≥ -1");
  assert.equal(bounds({ high: 3, unit: "s" }), "≤ 3 s");
  assert.equal(bounds({ unit: "m" }), "");
});

test("colours are typed as numbers, as RViz writes them, or as hexadecimal digits", () => {
  for (const text of [
    "255, 0, 10",
    "255; 0; 10",
    "255 0 10",
    " #FF000a",
    "ff000A",
    "rgb(255, 0, 10)",
  ]) {
    assert.deepEqual(parseColor(text), [255, 0, 10], text);
  }
  for (const text of [
    "",
    "red",
    "0, 0, 256",
    "-1, 0, 0",
    "0.5, 0, 0",
    "1, 2",
    "1, 2, 3, 4",
    "#fff",
    "NaN,0,0",
  ]) {
    assert.throws(() => parseColor(text), { message: /from 0 to 255/ }, text);
  }
});

test("lists and dictionaries are a line for each entry", () => {
  /** @type {Items} */
  const list = { kind: "list", items: "text" };
  assert.equal(encode(list, ["a", "b\r\nc"]), "a\nb c");
  assert.deepEqual(decode(list, " a \r\n\n b c\n"), ["a", "b c"]);
  assert.deepEqual(decode(list, ""), []);
  /** @type {Items} */
  const numbers = { kind: "list", items: "json" };
  assert.deepEqual(decode(numbers, encode(numbers, [1e308, -0.5])), [1e308, -0.5]);
});

test("names of a dictionary may have colons", () => {
  /** @type {Items} */
  const flags = { kind: "dict", items: "json" };
  const value = { base_link: true, "robot:arm": false };
  assert.equal(encode(flags, value), "base_link: true\nrobot:arm: false");
  assert.deepEqual(decode(flags, encode(flags, value)), value);
  assert.deepEqual(decode({ kind: "dict", items: "text" }, "a:"), { a: "" });
});

test("lines that mean nothing are refused with the reason", () => {
  /** @type {Items} */
  const flags = { kind: "dict", items: "json" };
  assert.throws(() => decode(flags, "base_link: yes"), { message: /“yes” is not valid/ });
  for (const text of ["base_link", ": true"]) {
    assert.throws(() => decode(flags, text), { message: /is not valid; enter name: value/ });
  }
  assert.throws(() => decode({ kind: "list", items: "json" }, "z".repeat(1e5)), {
    message: /^.{0,120}$/,
  });
});
