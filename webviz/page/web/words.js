// Words: of a search, for rates and of names.

/**
 * The words of a text, in lower case.
 *
 * @param {string} text
 */
export const wordsOf = (text) => text.toLowerCase().split(/\s+/).filter(Boolean);

/**
 * A rate that is rounded already, in Hz; a topic whose last message is repeated needs none.
 *
 * @param {number} hz
 * @param {boolean} [isLatched]
 */
export const hertz = (hz, isLatched) => (hz === 0 && isLatched ? "latched" : `${hz} Hz`);

/**
 * True for names of topics that ROS's own tools hide, such as those of actions.
 *
 * @param {string} topic
 */
export const isHiddenTopic = (topic) => topic.includes("/_");
