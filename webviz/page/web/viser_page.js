// The only module that touches viser's page: its objects, its three.js scene, its messages.
//
// Written for the version in `VISER`. tests/scene/test_viser_page.py holds what is accessed here:
// another version of viser fails there, and says which access it lacks and what needs it.

export const VISER = "1.1.1";
/** Messages to viser's worker that concern a server. */
const IGNORED = ["retry", "send"];

const page = () => window.__viserMutable;

// Required parts of viser's page, and their uses. A path of a function ends with ().

/** @import {Material, PerspectiveCamera, Raycaster as Caster, Scene} from "three" */
/** @import {WebGLRenderer, WebGLRenderTarget} from "three" */
/** @import {SceneObject, Vec3, ViserMessage} from "webviz/types.js" */
const NEEDS = {
  "scene.onBeforeRender()": "everything that is adjusted before a frame is drawn",
  "scene.onAfterRender()": "measuring how many points the page holds",
  "scene.__r3f.root.getState()": "everything of three.js",
  "scene.__r3f.root.getState().gl.renderBufferDirect()": "surfaces that are transparent",
  "scene.__r3f.root.getState().raycaster.setFromCamera()": "picking what is under the mouse",
  "scene.__r3f.root.getState().gl.getPixelRatio()": "picking points, which are as large as drawn",
  "scene.__r3f.root.getState().internal.subscribe()": "views that follow a frame",
  "scene.__r3f.root.getState().gl.setViewport()": "drawing the scene over the images of cameras",
  "camera.projectionMatrix.makePerspective()": "drawing the scene over the images of cameras",
  "canvas.clientHeight": "views without perspective",
  "camera.projectionMatrix.makeOrthographic()": "views without perspective",
  "cameraControl.setLookAt()": "views",
  "cameraControl.getPosition()": "views",
  "cameraControl.getTarget()": "views",
  "cameraControl.moveTo()": "views",
  "cameraControl.rotateTo()": "the axes that turn the view",
  "cameraControl.normalizeRotations()": "the axes that turn the view",
  "cameraControl.dollyTo()": "zooming",
  "cameraControl.mouseButtons.left": "the mouse",
  "cameraControl.touches.two": "fingers",
  "cameraControl.truck()": "fingers",
  "cameraControl.constructor.ACTION.TRUCK": "the mouse",
  configuredMaxOrbitDistance: "views from far away",
  "scene.__r3f.root.getState().gl.setClearColor()": "the background of the theme",
  "backgroundMaterial.uniforms": "the background of views that follow a frame",
  nodeRefFromName: "nodes of the scene by their names",
  nodePoseData: "texts: picking them, and hiding them in the images of cameras",
  "messageQueue.push()": "controls that go, and noticing that the server is silent",
  firstMessageBatch: "poses and data in one step",
  "drainMessageQueue()": "poses and data in one step",
  "requestRender()": "drawing what has changed",
  "sendCamera()": "telling the server where a camera is",
};

/** Sentences on what is accessed here and missing on this page; none if it is viser's of `VISER`. */
export function missing() {
  const lacks = [];
  for (const [path, use] of Object.entries(NEEDS)) {
    let owner = null;
    let value = page();
    for (const part of path.split(".")) {
      owner = value;
      value = value?.[part.replace("()", "")];
      if (part === "getState()") value = value?.call(owner);
    }
    const isThere = path.endsWith("()")
      ? value !== undefined && value !== null
      : value !== undefined;
    if (!isThere) lacks.push(`viser's page has no ${path}, which is needed for ${use}.`);
  }
  return lacks;
}

/**
 * Makes viser connect to the folder of the page, whose last slash it drops, and leave the address
 * bar as it is. To be called before viser's own script.
 */
export function connectToFolder() {
  const server = new URL(".", location.href).href.replace(/^http/, "ws");
  const { postMessage } = Worker.prototype;
  /** @type {(this: Worker, message: any, ...rest: any[]) => void} */
  Worker.prototype.postMessage = function (message, ...rest) {
    const isServer = message?.type === "set_server";
    Reflect.apply(postMessage, this, [isServer ? { ...message, server } : message, ...rest]);
  };
  const { replaceState } = history;
  history.replaceState = function (state, title, ...rest) {
    if (title !== "Viser") replaceState.call(this, state, title, ...rest);
  };
}

/**
 * Keeps viser from connecting to a server. To be called before viser's own script. Resolves with what
 * passes messages to it as if they came from there: the function resolves once they are applied.
 *
 * @returns {Promise<(messages: ViserMessage[]) => Promise<void>>}
 */
export async function connectToNothing() {
  const { postMessage } = Worker.prototype;
  /** @type {Worker | null} */
  let worker = null;
  /** @type {(this: Worker, message: any, ...rest: any[]) => void} */
  Worker.prototype.postMessage = function (message, ...rest) {
    if (message?.type === "set_server") worker = this;
    else if (!IGNORED.includes(message?.type)) {
      Reflect.apply(postMessage, this, [message, ...rest]);
    }
  };
  /** @param {object} data */
  const come = (data) => worker?.onmessage?.(new MessageEvent("message", { data }));
  await until(() => worker?.onmessage && hasScene());
  come({ type: "connected" });
  return (messages) => {
    come({ type: "message_batch", messages });
    return until(() => !hasMessages());
  };
}

/** Shows viser's page, which is hidden until it is ours. */
export function reveal() {
  document.documentElement.dataset.wvShown = "";
  if (hasScene()) requestRender();
}

/** Draws only what is seen: without a graphics card, a frame takes a processor as long as a picture. */
export function drawOnceShown() {
  const { dataset } = document.documentElement;
  const renderer = gl();
  const { render } = renderer;
  renderer.render = function (object, ...rest) {
    // Others than the scene are drawn into textures.
    if (object !== scene() || "wvShown" in dataset) render.call(this, object, ...rest);
  };
}

/**
 * Resolves when a condition holds, which is looked at before each frame.
 *
 * @param {() => unknown} condition
 */
export function until(condition) {
  return /** @type {Promise<void>} */ (
    new Promise((resolve) => {
      (function poll() {
        if (condition()) resolve();
        else requestAnimationFrame(poll);
      })();
    })
  );
}

export const hasScene = () => Boolean(page()?.scene?.__r3f?.root && page().canvas);
export const hasCamera = () => Boolean(page()?.cameraControl && page().camera);

/** @type {() => SceneObject & Scene & {__r3f: any}} */
export const scene = () => page().scene;
/** @type {() => HTMLCanvasElement & {parentElement: HTMLElement}} */
export const canvas = () => page().canvas;
/** @type {() => PerspectiveCamera} */
export const camera = () => page().camera;
export const controls = () => page().cameraControl;
export const actions = () => page().cameraControl.constructor.ACTION;
/** @type {() => WebGLRenderer} */
export const gl = () => three().gl;
/** @type {() => typeof Caster} */
export const Raycaster = () => three().raycaster.constructor;
export const backgroundMaterial = () => page().backgroundMaterial;

/**
 * All nodes of the scene by their names; some may be undefined.
 *
 * @type {() => Record<string, SceneObject>}
 */
export const nodes = () => page().nodeRefFromName;
/**
 * @param {string} name
 * @returns {SceneObject | undefined}
 */
export const node = (name) => page().nodeRefFromName[name];

/**
 * Return the position of a node in its parent. Labels have one as well, but are not objects.
 *
 * @param {string} name
 * @returns {Vec3 | undefined}
 */
export const positionOf = (name) => page().nodePoseData[name]?.position;

export const requestRender = () => page().requestRender();

/** Draws a frame now, as viser does on its own; whether that asked for another one. */
export function advance() {
  const { requestRender } = page();
  let isAsked = false;
  page().requestRender = () => {
    isAsked = true;
    requestRender();
  };
  three().advance(performance.now());
  page().requestRender = requestRender;
  return isAsked;
}

export const hasMessages = () => page().messageQueue.length > 0;
export const sendCamera = () => page().sendCamera();
/** @param {number} meters */
export const setMaxOrbitDistance = (meters) => (page().configuredMaxOrbitDistance = meters);

/** True until the messages that make the scene after connecting are handled. */
export const isFirstBatch = () => page().firstMessageBatch;

/** Handles the messages that have come, as viser does when it draws a frame. */
export function takeMessages() {
  if (page().messageQueue.length && page().drainMessageQueue) page().drainMessageQueue();
}

/**
 * Passes messages as they come to `pass`, with those that wait; what it returns is handled.
 *
 * @param {(messages: ViserMessage[], queue: ViserMessage[]) => ViserMessage[]} pass
 */
export function filterMessages(pass) {
  const queue = page().messageQueue;
  const { push } = queue;
  /** @param {...ViserMessage} messages */
  queue.push = function (...messages) {
    return push.apply(this, pass(messages, queue));
  };
}

/**
 * Calls `act(gl, scene, camera, target)` each time before the scene is drawn, with any camera.
 *
 * @param {(gl: WebGLRenderer, scene: SceneObject, camera: PerspectiveCamera, target: WebGLRenderTarget | null) => unknown} act
 */
export function beforeEveryRender(act) {
  const before = scene().onBeforeRender;
  /** @type {(this: SceneObject, ...args: any) => void} */
  scene().onBeforeRender = function (...args) {
    Reflect.apply(before, this, args);
    act(.../** @type {Parameters<typeof act>} */ (args));
  };
}

/**
 * The same, only with the camera of the page.
 *
 * @param {(gl: WebGLRenderer, scene: SceneObject, camera: PerspectiveCamera, target: WebGLRenderTarget | null) => unknown} act
 */
export function beforeRender(act) {
  beforeEveryRender((...args) => args[2] === camera() && act(...args));
}

/**
 * Calls `act` each time after the scene was drawn with the camera of the page.
 *
 * @param {() => unknown} act
 */
export function afterRender(act) {
  const before = scene().onAfterRender;
  /** @type {(this: SceneObject, ...args: any) => void} */
  scene().onAfterRender = function (...args) {
    Reflect.apply(before, this, args);
    if (args[2] === camera()) act();
  };
}

/**
 * Calls `act` in each frame, until the function is called that this returns; viser places nodes at
 * -1000 and labels at 0.
 *
 * @param {number} priority
 * @param {() => unknown} act
 * @returns {() => void}
 */
export function eachFrame(priority, act) {
  const { root } = scene().__r3f;
  return root.getState().internal.subscribe({ current: act }, priority, root);
}

/**
 * Calls `act(material)` before anything is drawn with it.
 *
 * @param {(material: Material) => unknown} act
 */
export function beforeDraw(act) {
  const renderer = gl();
  const draw = renderer.renderBufferDirect;
  renderer.renderBufferDirect = function (camera, fog, geometry, material, ...rest) {
    act(material);
    draw.call(this, camera, fog, geometry, material, ...rest);
  };
}

const three = () => scene().__r3f.root.getState();
