// Values of stores for tests.

/** @import {StoreName, ValuesOf} from "webviz/types.js" */

/**
 * The values of a store as they come from the server, as JSON, in which anything may be.
 *
 * @template {StoreName} N
 * @param {N} _name
 * @param {Record<string, unknown>} values
 * @returns {ValuesOf<N>}
 */
export const storeOf = (_name, values) =>
  JSON.parse(JSON.stringify(values), (key, value) =>
    key === "" ? new Map(Object.entries(value)) : value,
  );
