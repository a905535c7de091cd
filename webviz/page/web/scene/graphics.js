// The graphics of this browser: what draws, and when it has drawn.

import * as viser from "webviz/viser_page.js";

const LOOK_MS = 2;

/** @type {WeakMap<object, string>} */
const names = new WeakMap(); // by context

/** Returns true if this browser can draw a scene at all. */
export const hasWebGL = () => Boolean(document.createElement("canvas").getContext("webgl2"));

/** The name of what draws, as the browser tells it. */
export function renderer() {
  const context = viser.gl().getContext();
  const cachedName = names.get(context);
  if (cachedName) return cachedName;
  const info = context.getExtension("WEBGL_debug_renderer_info");
  const name = context.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : context.RENDERER);
  names.set(context, String(name));
  return String(name);
}

/** Returns true if the processor draws instead of a graphics card. */
export const isSoftware = () =>
  /swiftshader|llvmpipe|softpipe|software|basic render/i.test(renderer());

/**
 * Calls `done(true)` when the graphics card has drawn what it was told, not when it was told;
 * `done(false)` if it has lost all.
 *
 * @param {(isDrawn: boolean) => void} report
 */
export function whenDrawn(report) {
  const context = /** @type {WebGL2RenderingContext} */ (viser.gl().getContext());
  const fence = context.fenceSync(context.SYNC_GPU_COMMANDS_COMPLETE, 0);
  if (!fence) return report(false);
  context.flush();
  (function poll() {
    if (context.isContextLost()) return report(false);
    if (context.getSyncParameter(fence, context.SYNC_STATUS) !== context.SIGNALED) {
      return setTimeout(poll, LOOK_MS);
    }
    context.deleteSync(fence);
    report(true);
  })();
}
