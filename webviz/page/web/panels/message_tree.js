// A message as rows of a foldable tree, and as text.

/**
 * @typedef {{fields: Record<string, Tree>}} Fields
 * @typedef {{items: Tree[], length: number, type: string}} Items
 * @typedef {string | Fields | Items} Tree
 * @typedef {{key: string, depth: number, name: string, value: string, isOpen: boolean | null}} MessageRow
 */

const SHORT = 60; // characters of what a folded row says of its inside
const OPEN_DEPTH = 2;
/** A number with its name, "DISCHARGING (2)"; strings stand in quotation marks. */
export const NAMED = /^([A-Z]\w*) \((-?\d+)\)$/;

/**
 * @param {Tree} tree
 * @returns {tree is string}
 */
const isLeaf = (tree) => typeof tree === "string";
/**
 * @param {Fields | Items} tree
 * @returns {[string, Tree][]}
 */
const entries = (tree) =>
  "fields" in tree
    ? Object.entries(tree.fields)
    : tree.items.map((item, index) => [`[${index}]`, item]);

/**
 * The rows of a message that are not folded away: `{key, depth, name, value, isOpen}`; `isOpen` is null
 * where nothing can be unfolded. `folds` has what was folded or unfolded by hand, by key.
 *
 * @param {Fields | Items} tree
 * @param {Map<string, boolean>} folds
 * @param {number} [depth]
 * @param {string} [path]
 * @returns {MessageRow[]}
 */
export function rowsOf(tree, folds, depth = 0, path = "") {
  return entries(tree).flatMap(([name, inside]) => {
    const key = `${path}/${name}`;
    /** @type {MessageRow} */
    const row = { key, depth, name, value: brief(inside), isOpen: null };
    if (isLeaf(inside) || !entries(inside).length) return [row];
    // Messages are unfolded at first, and sequences, which may be long, are not.
    row.isOpen = folds.get(key) ?? ("fields" in inside && depth < OPEN_DEPTH);
    if (!row.isOpen) return [row];
    row.value = "fields" in inside ? "" : lengthOf(inside);
    const rows = [row, ...rowsOf(inside, folds, depth + 1, key)];
    const more = "fields" in inside ? 0 : inside.length - inside.items.length;
    if (more > 0) {
      const value = `… ${more} more`;
      rows.push({ key: `${key}/…`, depth: depth + 1, name: "", value, isOpen: null });
    }
    return rows;
  });
}

/**
 * The text of a row whose tree is folded.
 *
 * @param {Tree} tree
 * @returns {string}
 */
function brief(tree) {
  if (isLeaf(tree)) return tree;
  if ("fields" in tree) return cut(inline(tree));
  if (!tree.length) return "[]";
  const isPlain = tree.items.every(isLeaf);
  return isPlain ? `${cut(inline(tree))}  ${lengthOf(tree)}` : lengthOf(tree);
}

/** @param {Items} items */
const lengthOf = ({ length, type }) => (type ? `${length} × ${type}` : `${length} in all`);
/** @param {string} text */
const cut = (text) => (text.length > SHORT ? `${text.slice(0, SHORT)}…` : text);

/**
 * @param {Tree} tree
 * @returns {string}
 */
function inline(tree) {
  if (isLeaf(tree)) return tree;
  if ("fields" in tree) {
    return Object.entries(tree.fields)
      .map(([name, inside]) => `${name}: ${inline(inside)}`)
      .join(", ");
  }
  return `[${tree.items.map(inline).join(", ")}${tree.length > tree.items.length ? ", …" : ""}]`;
}

/**
 * The message as `ros2 topic echo` prints it, with what was left out marked.
 *
 * @param {Fields} tree
 * @param {string} [indent]
 * @returns {string}
 */
export function textOf(tree, indent = "") {
  return Object.entries(tree.fields)
    .map(([name, inside]) => field(name, inside, indent))
    .join("\n");
}

/**
 * @param {string} name
 * @param {Tree} tree
 * @param {string} indent
 * @returns {string}
 */
function field(name, tree, indent) {
  if (isLeaf(tree)) return `${indent}${name}: ${tree.replace(NAMED, "$2  # $1")}`;
  if ("fields" in tree) return `${indent}${name}:\n${textOf(tree, `${indent}  `)}`;
  if (tree.items.every(isLeaf)) {
    const note = tree.length > tree.items.length ? `  # ${lengthOf(tree)}` : "";
    return `${indent}${name}: ${inline(tree)}${note}`;
  }
  const items = tree.items.map((item) => {
    const isFields = !isLeaf(item) && "fields" in item;
    return `${indent}- ${isFields ? textOf(item, `${indent}  `).trimStart() : inline(item)}`;
  });
  if (tree.length > items.length) items.push(`${indent}# ${lengthOf(tree)}`);
  return [`${indent}${name}:`, ...items].join("\n");
}
