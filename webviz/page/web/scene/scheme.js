// Colours of the scene that follow the theme of this page: what is behind it if the config says nothing,
// and texts and grids without a colour of their own. The scene is shared, and others may have another
// theme.

import constants from "webviz/constants.js";
import * as viser from "webviz/viser_page.js";

/** @import {Color} from "three" */

/** "background", "text" and "grid", each red, green and blue from 0 to 255. */
export const scheme = () => constants.SCHEMES[document.documentElement.dataset.wvTheme ?? "dark"];

export function install() {
  const apply = () => {
    const [red, green, blue] = scheme().background;
    viser.gl().setClearColor((red << 16) | (green << 8) | blue, 1);
    viser.requestRender();
  };
  new MutationObserver(apply).observe(document.documentElement, {
    attributeFilter: ["data-wv-theme"],
  });
  apply();
}

/**
 * Gives a colour of three.js these bytes: red, green and blue.
 *
 * @param {Color} color
 * @param {number[]} bytes
 */
export const paint = (color, bytes) => {
  const [red, green, blue] = bytes;
  return color.setRGB(red / 255, green / 255, blue / 255, "srgb");
};
