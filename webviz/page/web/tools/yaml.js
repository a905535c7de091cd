// Messages as YAML, as `ros2 topic pub` reads them.

const PLAIN = /^[A-Za-z_/][A-Za-z0-9_/.-]*$/;
const WORDS = /^(true|false|null|yes|no|on|off|y|n)$/i;

/**
 * A message, given as objects, lists, texts and numbers, as YAML that ends with a new line.
 *
 * @param {object} values
 * @param {string} [indent]
 * @returns {string}
 */
export function yaml(values, indent = "") {
  return Object.entries(values)
    .map(([name, value]) => {
      const isNested = value !== null && typeof value === "object" && !Array.isArray(value);
      if (!isNested) return `${indent}${name}: ${inline(value)}\n`;
      if (!Object.keys(value).length) return `${indent}${name}: {}\n`;
      return `${indent}${name}:\n${yaml(value, `${indent}  `)}`;
    })
    .join("");
}

/**
 * JSON is YAML; names need no quotes, and YAML 1.1 takes 1e-7 for a text, but 1.0e-7 for a number.
 *
 * @param {unknown} value
 * @returns {string}
 */
function inline(value) {
  if (Array.isArray(value)) return `[${value.map(inline).join(", ")}]`;
  if (value !== null && typeof value === "object") {
    return `{${Object.entries(value)
      .map(([name, each]) => `${name}: ${inline(each)}`)
      .join(", ")}}`;
  }
  if (typeof value === "number") return String(value).replace(/^(-?\d+)e/, "$1.0e");
  const isPlain = typeof value === "string" && PLAIN.test(value) && !WORDS.test(value);
  return isPlain ? value : JSON.stringify(value);
}
