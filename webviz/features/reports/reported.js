// Selects what was selected when the bug report that is shown was made.

import { described } from "webviz/scene/picking/pick.js";
import { things } from "webviz/scene/picking/things.js";
import { watch } from "webviz/stores.js";
import * as selection from "webviz/tools/selection.js";
import * as viser from "webviz/viser_page.js";

/** @import {Picked} from "webviz/types.js" */
/** @import {ReportedThing} from "webviz/contents.js" */

const TRY_MS = 500;
const TRIES = 60; // the displays are drawn within half a minute
const NEAR = 1e-4; // in metres, as single precision has it

/** Lets this page select it once it is drawn. */
export function restore() {
  let isDone = false;
  watch("reported", (values) => {
    const targets = values.get("things") ?? [];
    if (isDone || !targets.length) return;
    isDone = true;
    attempt(targets, TRIES);
  });
}

/**
 * @param {readonly ReportedThing[]} targets
 * @param {number} left
 */
function attempt(targets, left) {
  if (selection.all().size) return; // the user was faster
  const candidates = things();
  const picks = targets.map((each) => pickOf(each, candidates)).filter((each) => each !== null);
  if (picks.length === targets.length || (left === 0 && picks.length))
    selection.change("replace", picks);
  else if (left > 0) setTimeout(() => attempt(targets, left - 1), TRY_MS);
}

/**
 * @param {ReportedThing} wanted
 * @param {ReturnType<typeof things>} candidates
 * @returns {Picked | null}
 */
function pickOf({ display, key, number, at }, candidates) {
  for (const thing of candidates) {
    const { group, key: own, path, first } = thing.node;
    if (group.split("/", 1)[0] !== display || own !== key) continue;
    if (number === null) {
      const whole = viser.node(path) ?? (thing.object.isText ? null : thing.object);
      if (!whole) continue;
      const point = viser.camera().position.clone().fromArray(at).applyMatrix4(whole.matrixWorld);
      return described({ ...thing, number, point });
    }
    const pick = described({ ...thing, number: number - first });
    if (pick.at.every((value, axis) => Math.abs(value - at[axis]) < NEAR)) return pick;
  }
  return null;
}
