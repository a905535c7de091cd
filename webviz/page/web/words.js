// The words of a search.

/**
 * The words of a text, in lower case.
 *
 * @param {string} text
 */
export const wordsOf = (text) => text.toLowerCase().split(/\s+/).filter(Boolean);
