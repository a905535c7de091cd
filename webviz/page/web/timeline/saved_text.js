// Names of recordings that rules made, for people.

/**
 * Time and cause by the name of the folder, which begins with the time.
 *
 * @param {string} name
 */
export function savedText(name) {
  const found = /^(\d{4}-\d\d-\d\d)_(\d\d)-(\d\d)-(\d\d)_(.*)$/.exec(name);
  if (!found) return name;
  const [, date, hours, minutes, seconds, cause] = found;
  return `${date} ${hours}:${minutes}:${seconds} · ${cause.replaceAll("_", " ")}`;
}
