// The title of the tab: the config, and before it what must not be overlooked.

let name = document.title;
let before = "";

function show() {
  const title = before + name;
  if (document.title !== title) document.title = title;
}

/**
 * Names what the page shows.
 *
 * @param {string} next
 */
export function setTitle(next) {
  name = next;
  show();
}

/**
 * Puts a text before the name, "" for none.
 *
 * @param {string} next
 */
export function setTitlePrefix(next) {
  before = next;
  show();
}
