// Numbers in the last bits of a width or size, too small for what is drawn; see scene/drawn.py.

import constants from "webviz/constants.js";

/**
 * The number that a size carries, 0 for none: 255 times what an opacity lacks, and multiples of 256.
 *
 * @param {number} size
 */
export const markOf = (size) =>
  Math.round((size / (Math.fround(size) || 1) - 1) * 2 ** constants.OPACITY_BIT) || 0;
