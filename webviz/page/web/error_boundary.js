// Functions of plug-ins: what one throws is reported, and the page goes on.

/**
 * A function of a plug-in, or an object with functions, each of which reports what it throws and
 * then returns nothing. So do functions in what they return; other values stay as they are.
 *
 * @template T
 * @param {T} value
 * @param {(error: unknown) => void} report
 * @param {unknown} [owner] of which it is a method
 * @returns {T}
 */
export function withErrorBoundary(value, report, owner) {
  /** @type {any} */
  const target = value;
  if (typeof target === "function")
    return /** @type {any} */ (
      (/** @type {unknown[]} */ ...args) => {
        try {
          return withErrorBoundary(Reflect.apply(target, owner, args), report);
        } catch (error) {
          report(error);
        }
      }
    );
  if (Object.getPrototypeOf(target ?? 0) !== Object.prototype) return value;
  return /** @type {any} */ (
    Object.fromEntries(
      Object.entries(target).map(([key, each]) => [key, withErrorBoundary(each, report, target)]),
    )
  );
}

/**
 * Text of what was thrown, which may be any value.
 *
 * @param {unknown} error
 */
export function textOf(error) {
  try {
    return String(error).slice(0, 300);
  } catch {
    return "an error without a text";
  }
}
