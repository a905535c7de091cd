// A bar above the page that says why it does not show what it should.

/**
 * The bar with a text, not yet in the page.
 *
 * @param {string} [text]
 */
export function notice(text = "") {
  const bar = document.createElement("p");
  bar.className = "wv-contact";
  bar.setAttribute("role", "alert");
  bar.textContent = text;
  return bar;
}
