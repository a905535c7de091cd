// Controls for each kind of property.
//
// A control is made by `(property, options)`: a property as `content/forms.py` declares it, and
// `ControlOptions`. It follows the value that the viewer has, unless it is being edited.

import { checkbox, choice, text } from "./simple.js";
import { color } from "./color.js";
import { frame } from "./frame.js";
import { lines } from "./lines.js";
import { number } from "./number.js";
import { slider } from "./slider.js";
import { switches } from "./switches.js";
import { topic } from "./topic.js";
import { vector } from "./vector.js";

/** @import {Control, ControlOptions} from "../types.js" */
/** @import {DeclaredProperty} from "../contents.js" */

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
