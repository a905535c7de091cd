import assert from "node:assert/strict";
import { test } from "node:test";

import { bytesText, rateText, sizeText, spanText } from "../../webviz/page/web/panels/units.js";
import { sanitized } from "../../webviz/page/web/sanitize.js";
import { duration, timeOfDay } from "../../webviz/page/web/time_text.js";
import { fixed } from "../../webviz/page/web/numbers.js";
import { yaml } from "../../webviz/page/web/tools/yaml.js";
import { wordsOf } from "../../webviz/page/web/words.js";

test("a duration is hours, minutes and seconds, cut and not rounded", () => {
  assert.equal(duration(3723.49), "1:02:03.4");
  assert.equal(duration(59.99), "0:00:59.9");
  assert.equal(duration(4.35, 2), "0:00:04.35", "4.35 × 100 is less than 435");
  assert.equal(duration(360_000, 0), "100:00:00");
  assert.equal(duration(-61), "−0:01:01.0");
  assert.equal(duration(-0.04), "0:00:00.0", "zero has no sign");
});

test("a time of day is a date here, and of a simulation the time since its start", () => {
  const here = new Date(2024, 0, 2, 3, 4, 5, 67).getTime() / 1000;
  assert.equal(timeOfDay(here), "2024-01-02 03:04:05");
  assert.equal(timeOfDay(here, true), "2024-01-02 03:04:05.067");
  assert.equal(timeOfDay(3661.25, true), "1:01:01.250");
  assert.equal(timeOfDay(1e300), "1e+300 s", "no date");
});

test("untrusted text is one line that reads from left to right", () => {
  assert.equal(sanitized("a\nb\u202ec\u0000d\u2028e"), "a b c d e");
  assert.equal(sanitized("Grüße, 世界 🤖"), "Grüße, 世界 🤖");
  assert.equal(sanitized("half \ud83e"), "half  ");
  assert.equal(sanitized(""), "");
});

test("a long text is cut, and half a pair at the cut is left out", () => {
  assert.equal(sanitized("abcdef", 6), "abcdef");
  assert.equal(sanitized("abcdefg", 6), "abcde…");
  assert.equal(sanitized("abcd🤖fg", 6), "abcd …");
  assert.equal(sanitized("x".repeat(1e6)).length, 300);
});

test("words of a search are in lower case and never empty", () => {
  assert.deepEqual(wordsOf("  Front\tLASER\n é "), ["front", "laser", "é"]);
  assert.deepEqual(wordsOf(" \n"), []);
});

test("rates and amounts have few digits", () => {
  assert.equal(rateText(undefined), "");
  assert.equal(rateText(9.96), "10.0 Hz");
  assert.equal(rateText(99.94), "99.9 Hz");
  assert.equal(rateText(1234.5), "1235 Hz");
  assert.equal(bytesText(undefined), "");
  assert.equal(bytesText(999), "999 B/s");
  assert.equal(bytesText(1500), "1.5 kB/s");
  assert.equal(bytesText(250e6), "250 MB/s");
  assert.equal(sizeText(5e13), "50000 GB");
});

test("a span has the unit that suits it", () => {
  assert.equal(spanText(null), "");
  assert.equal(spanText(undefined), "");
  const texts = [0, 0.012, 0.9996, 9.96, 119, 121, 7200, 172_800, -3.44].map(spanText);
  assert.deepEqual(texts, [
    "0 ms",
    "12 ms",
    "1.0 s",
    "10 s",
    "119 s",
    "2 min",
    "2 h",
    "2 d",
    "−3.4 s",
  ]);
});

test("values rounded to zero have no sign", () => {
  assert.equal(fixed(-0.0004, 3), "0.000");
  assert.equal(fixed(-0.4, 0), "0");
  assert.equal(fixed(-0.0006, 3), "-0.001");
});

test("a message is YAML with names as they are and all else as JSON", () => {
  const header = { stamp: { sec: -1 }, frame_id: "map" };
  assert.equal(
    yaml({ header, empty: {}, on: true, points: [1.5, -2] }),
    [
      "header:",
      "  stamp:",
      "    sec: -1",
      "  frame_id: map",
      "empty: {}",
      "on: true",
      "points: [1.5, -2]",
      "",
    ].join("\n"),
  );
  assert.equal(yaml({}), "");
});

test("texts that YAML would read as something else are quoted", () => {
  for (const text of [
    "",
    "yes",
    "NULL",
    "n",
    "1.5",
    "a b",
    "a: b",
    "- a",
    "#a",
    'a"b',
    "a\nb",
    "é",
  ]) {
    assert.equal(yaml({ text }), `text: ${JSON.stringify(text)}\n`);
  }
  for (const text of ["/robot_1/base.link-2", "yesterday"])
    assert.equal(yaml({ text }), `text: ${text}\n`);
});

test("numbers with an exponent have a point, without which YAML 1.1 reads them as texts", () => {
  const pose = { position: { x: 1e-7, y: 1.5e300 } };
  assert.equal(yaml(pose), "position:\n  x: 1.0e-7\n  y: 1.5e+300\n");
  assert.equal(yaml({ poses: [{ x: -1e21, id: "1e-7" }] }), 'poses: [{x: -1.0e+21, id: "1e-7"}]\n');
});
