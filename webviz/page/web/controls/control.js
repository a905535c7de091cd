// Controls for each kind of property.
//
// A control is made by `(property, options)`: a property as `content/forms.py` declares it, and
// `ControlOptions`. It follows the value that the viewer has, unless it is being edited.

import { checkbox, choice, text } from "webviz/controls/simple.js";
import { color } from "webviz/controls/color.js";
import { frame } from "webviz/controls/frame.js";
import { lines } from "webviz/controls/lines.js";
import { number } from "webviz/controls/number.js";
import { slider } from "webviz/controls/slider.js";
import { switches } from "webviz/controls/switches.js";
import { topic } from "webviz/controls/topic.js";
import { vector } from "webviz/controls/vector.js";

/** @import {Control, ControlOptions} from "webviz/types.js" */
/** @import {DeclaredProperty} from "webviz/contents.js" */

/**
 * @type {Partial<Record<DeclaredProperty["kind"], (property: DeclaredProperty, options: ControlOptions) => Control>>}
 */
const MAKERS = {
  bool: checkbox,
  choice,
  color,
  dict: lines,
  float: number,
  frame,
  int: number,
  list: lines,
  switches,
  text,
  topic,
  vector,
};

const WIDEST = 1000; // a slider over more than that hits nothing

/**
 * The control for a property.
 *
 * @param {DeclaredProperty} property
 * @param {ControlOptions} options
 * @returns {Control}
 */
export function control(property, options) {
  const { kind, low, high } = property;
  const isNumber = kind === "float" || kind === "int";
  const isSlider = isNumber && low !== undefined && high !== undefined && high - low <= WIDEST;
  if (isSlider) return slider({ ...property, low, high }, options);
  return (MAKERS[kind] ?? text)(property, options);
}
