// Windows of a viewer that show one panel, or a layout of their own, as their addresses say.

const parameters = new URLSearchParams(location.search);
/** The panel that is all that this window shows, "" for none. */
export const alone = parameters.get("panel") ?? "";
/** The saved layout of this window, "" for the one that browsers share. */
export const layoutName = parameters.get("layout") ?? "";

/**
 * Opens another window of this viewer.
 *
 * @param {"panel" | "layout"} key
 * @param {string} name
 */
export function openWindow(key, name) {
  const address = new URL(location.href);
  address.search = "";
  address.searchParams.set(key, name);
  window.open(address, "_blank", "popup,width=900,height=640");
}
