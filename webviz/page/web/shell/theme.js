// Dark or light: as the system has it, or as chosen in this browser.

import { recall, remember } from "webviz/remember.js";

const light = matchMedia("(prefers-color-scheme: light)");

export function install() {
  light.addEventListener("change", apply);
  apply();
}

/** "dark", "light", or "system". */
export const theme = () => recall("theme", "system");

/** @param {string} name */
export function setTheme(name) {
  remember("theme", name);
  apply();
}

function apply() {
  const name = theme() === "system" ? (light.matches ? "light" : "dark") : theme();
  document.documentElement.dataset.wvTheme = name;
}
