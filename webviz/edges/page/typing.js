// Texts that are typed into dropdowns.
//
// viser's dropdown can be searched, but forgets a text that is not among its options. Here Enter, or
// leaving the field, tells the server what was typed; Escape, or a click on an option, does not.

import * as channel from "./channel.js";

export function install() {
  let typed = null;
  let isPicking = false;

  function tell(input) {
    const text = input.value;
    if (typed !== input || !text.trim()) return;
    typed = null;
    channel.send({ type: "Typed", uuid: input.id, text: text.trim() });
  }

  const isDropdown = (target) =>
    target instanceof HTMLInputElement && target.getAttribute("aria-haspopup") === "listbox";
  const on = (name, act) => document.addEventListener(name, act, true);

  on("input", (event) => {
    if (!isDropdown(event.target)) return;
    typed = event.target;
    isPicking = false;
  });
  on("click", (event) => {
    if (event.target.closest("[data-combobox-option]")) typed = null;
  });
  on("keydown", (event) => {
    if (event.target !== typed) return;
    if (event.key === "Escape") typed = null;
    if (event.key === "ArrowDown" || event.key === "ArrowUp") isPicking = true;
    if (event.key !== "Enter") return;
    if (isPicking) {
      typed = null;
      return;
    }
    event.preventDefault();
    event.stopPropagation();
    event.target.blur();  // which tells it
  });
  on("focusout", (event) => tell(event.target));
}
