// The values of pixels by their colours, in Node.js.

import assert from "node:assert/strict";
import test from "node:test";
import { pixelText } from "../../webviz/page/web/images/pixel_text.js";

/** @import {ColorRange} from "webviz/messages.js" */

/** @type {ColorRange["colors"]} */
const RAINBOW = [
  [48, 18, 59],
  [97, 252, 108],
  [122, 4, 2],
];

test("a colour of a legend is a measurement, also after it was compressed", () => {
  const legend = { low: 0.5, high: 4.5, unit: "m", colors: RAINBOW };
  assert.equal(pixelText([97, 252, 108], legend), "≈ 2.5 m");
  assert.equal(pixelText([110, 128, 55], legend), "≈ 3.5 m");
  assert.equal(pixelText([255, 0, 255], legend), "no measurement");
  /** @type {ColorRange} */
  const grey = {
    low: 0,
    high: 255,
    unit: "",
    colors: [
      [0, 0, 0],
      [255, 255, 255],
    ],
  };
  assert.equal(pixelText([51, 52, 50], grey), "≈ 51");
});

test("a colour without a legend is itself", () => {
  assert.equal(pixelText([1, 2, 3]), "rgb 1 2 3");
});
