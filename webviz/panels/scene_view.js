// The widget "scene view": the scene as a camera of its own sees it, without some displays.

import { contextOf, el } from "webviz/dom.js";
import { openMenuBelow } from "webviz/controls/menu.js";
import { effect, owned, signal } from "webviz/signals.js";
import { once } from "webviz/stores.js";
import { frameNode } from "webviz/scene/projection.js";
import { drawBackground, drawSecond, eachPicture } from "webviz/scene/second_camera.js";
import { toThree } from "webviz/scene/fixed_frame.js";
import { gl, requestRender } from "webviz/viser_page.js";
import { listen } from "./scene_view_gestures.js";
import { sightOf, STANDARD } from "./scene_view_camera.js";

/** @import {Page} from "../page/web/extensions.js" */
/** @import {Signal} from "../page/web/signals.js" */
/** @import {Vec3} from "../page/web/types.js" */
/** @import {SceneCamera} from "./scene_view_camera.js" */

const MAX_SCENES = 4;
const REST_MS = 500; // without a move, after which the camera is kept
const NORTH_UP = -Math.PI / 2;
const LABELS = { Orbit: "Orbit", TopDownOrtho: "Top down" };
const TOO_MANY = `Only ${MAX_SCENES} scenes are drawn at a time. Close one of the others.`;
const HELP = "Left: turn · Middle or Shift: move · Right or wheel: zoom · Double click: look at";

/** Those in sight, oldest first. @type {Signal<readonly object[]>} */
const scenes = signal([]);

/** @param {Page} page */
export default function install(page) {
  page.widget("scene view", (_, send) => sceneView(send));
}

/** @param {(camera: SceneCamera) => unknown} send */
function sceneView(send) {
  const canvas = el("canvas", { role: "img", tabindex: 0, "aria-label": "3D scene", title: HELP });
  const hidden = signal(/** @type {string[]} */ ([]));
  const group = signal("");
  const camera = ownCamera(canvas, send);
  const own = {};
  scenes.value = [...scenes.value, own];
  owned(() => (scenes.value = scenes.value.filter((each) => each !== own)));
  const isTooMany = () => scenes.value.indexOf(own) >= MAX_SCENES;
  const context = contextOf(canvas);
  const draw = () => {
    if (isTooMany() || !fit(canvas)) return;
    const { width, height } = canvas;
    const sight = sightOf(camera.value.value, [width, height]);
    const position = /** @type {Vec3} */ (
      sight.position.map((at, i) => at + originOf(group.value)[i])
    );
    drawBackground(context);
    drawSecond(context, width, height, { ...sight, position, hidden: hidden.value });
  };
  owned(eachPicture(draw));
  effect(() => {
    for (const each of [camera.value, hidden, group, scenes]) void each.value;
    requestRender();
  });
  const sizes = new ResizeObserver(() => requestRender());
  sizes.observe(canvas);
  owned(() => sizes.disconnect());
  listen(canvas, camera.change);
  const problem = el("p", { class: "wv-empty", hidden: () => !isTooMany() }, TOO_MANY);
  return {
    element: el("div", { class: "wv-plugin-fill wv-scene-view" }, canvas, problem),
    head: head(camera, hidden),
    /** @param {{view?: SceneCamera, group?: string, hidden?: string[]}} values */
    update(values) {
      if (values.view) camera.take(values.view);
      group.value = values.group ?? "";
      hidden.value = values.hidden ?? [];
    },
  };
}

/**
 * The camera of a scene: moved here at once, and kept for all once it rests.
 *
 * @param {HTMLElement} canvas
 * @param {(camera: SceneCamera) => unknown} send
 */
function ownCamera(canvas, send) {
  const value = signal(STANDARD);
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;
  const keep = () => {
    timer = undefined;
    if (!canvas.closest(".wv-locked")) send(value.value); // a watcher's own is not kept
  };
  owned(() => {
    clearTimeout(timer);
    if (timer) keep();
  });
  return {
    value,
    /** @param {(camera: SceneCamera) => SceneCamera} how */
    change(how) {
      value.value = how(value.value);
      clearTimeout(timer);
      timer = setTimeout(keep, REST_MS);
    },
    /** @param {SceneCamera} camera as the server says it; not while it is moved here */
    take(camera) {
      if (timer === undefined) value.value = camera;
    },
  };
}

/**
 * The head of the panel: the type of view, and how many displays are left out.
 *
 * @param {ReturnType<typeof ownCamera>} camera
 * @param {Signal<string[]>} hidden
 */
function head({ value, change }, hidden) {
  /** @param {Partial<SceneCamera>} values */
  const set = (values) => change((camera) => ({ ...camera, ...values }));
  /** @param {SceneCamera["type"]} type @param {Partial<SceneCamera>} [values] */
  const item = (type, values) => ({
    label: LABELS[type],
    checked: value.value.type === type,
    run: () => set({ type, ...values }),
  });
  const menu = () => [
    item("Orbit"),
    item("TopDownOrtho", { yaw: NORTH_UP }),
    null,
    { label: "As the main scene", icon: "eye", run: async () => set(await mainCamera()) },
    { label: "Zero", icon: "reset", run: () => set({ ...STANDARD, type: value.value.type }) },
  ];
  /** @type {HTMLElement} */
  const button = el(
    "button",
    {
      type: "button",
      class: "wv-button wv-scene-view-type",
      "aria-haspopup": "menu",
      "data-tip": "View of this scene",
      onclick: () => openMenuBelow(button, menu()),
    },
    () => `${LABELS[value.value.type]} ▾`,
  );
  const count = () => hidden.value.length;
  return el(
    "span",
    { class: "wv-panel-tools" },
    el("span", { class: "wv-quiet", hidden: () => !count() }, () => `${count()} hidden`),
    button,
  );
}

/**
 * Values that the view of this page has in common with that of a scene.
 *
 * @returns {Promise<Partial<SceneCamera>>}
 */
const mainCamera = () =>
  once(`view:${window.webviz.browser}`, (view) => {
    const names = /** @type {const} */ ([
      "target_frame",
      "distance",
      "yaw",
      "pitch",
      "focal_point",
    ]);
    const values = names.map((name) => [name, view.get(`value.${name}`)]);
    return Object.fromEntries(values.filter(([, value]) => value !== undefined));
  });

/**
 * Gives a canvas as many pixels as the scene has there; false while it is not seen.
 *
 * @param {HTMLCanvasElement} canvas
 */
function fit(canvas) {
  const ratio = gl().getPixelRatio();
  const width = Math.round(canvas.clientWidth * ratio);
  const height = Math.round(canvas.clientHeight * ratio);
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
  return width > 0 && height > 0;
}

/**
 * The origin of the coordinates of a camera in the fixed frame.
 *
 * @param {string} group of the target frame, "" for the fixed one
 * @returns {Vec3}
 */
function originOf(group) {
  const node = group && frameNode(group);
  if (!node) return [0, 0, 0];
  const { elements } = toThree().clone().invert().multiply(node.matrixWorld);
  return [elements[12], elements[13], elements[14]];
}
