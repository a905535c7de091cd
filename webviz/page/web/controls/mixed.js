// A value that several displays do not share, while their properties are edited together.

/** @typedef {typeof MIXED} Mixed */

/** In place of a value, also of an element of a vector. */
export const MIXED = Symbol("mixed");

/** The text of a field with such a value. */
export const MIXED_TEXT = "Mixed";
