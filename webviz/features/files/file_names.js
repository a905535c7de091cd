// Names of config files.

/** The endings of a config's name. */
export const SUFFIXES = [".yaml", ".yml", ".rviz"];

/**
 * As of pathlib: a name that begins with its only dot has no suffix.
 *
 * @param {string} name
 */
export const hasSuffix = (name) =>
  SUFFIXES.some((suffix) => name.toLowerCase().endsWith(suffix) && name.length > suffix.length);

/**
 * The file name that was entered, or why it is invalid: `{name, problem}`.
 *
 * @param {string} entered
 * @returns {{name?: string, problem?: string}}
 */
export function checkedName(entered) {
  const name = entered.trim();
  if (!name || name === "." || name === "..")
    return { problem: "Enter a file name, such as lab.yaml." };
  if (/[/\\\0]/.test(name)) {
    return { problem: "Enter a name without folders; the file is saved in the folder above." };
  }
  return { name: hasSuffix(name) ? name : `${name}.yaml` };
}
