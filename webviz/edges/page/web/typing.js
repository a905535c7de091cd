// Texts that are typed into dropdowns.
//
// viser's dropdown can be searched, but forgets a text that is not among its options. Here Enter, or
// leaving the field, tells the server what was typed; Escape, or a click on an option, does not.

import * as channel from "./channel.js";

export function install() {
  // By id, because viser makes the field anew when its options change meanwhile.
  let typed = null;
  let isPicking = false;

  function tell(id) {
    const text = typed?.id === id ? typed.text.trim() : "";
    if (!text) return;
    typed = null;
    channel.send({ type: "Typed", uuid: id, text });
  }

  const isDropdown = (target) =>
    target instanceof HTMLInputElement && target.getAttribute("aria-haspopup") === "listbox";
  const on = (name, act) => document.addEventListener(name, act, true);

  on("input", (event) => {
    if (!isDropdown(event.target)) return;
    typed = { id: event.target.id, text: event.target.value };
    isPicking = false;
  });
  on("click", (event) => {
    if (event.target.closest("[data-combobox-option]")) typed = null;
  });
  on("keydown", (event) => {
    if (!typed || event.target.id !== typed.id) return;
    if (event.key === "Escape") typed = null;
    if (event.key === "ArrowDown" || event.key === "ArrowUp") isPicking = true;
    if (event.key !== "Enter") return;
    if (isPicking) {
      typed = null;
      return;
    }
    event.preventDefault();
    event.stopPropagation();
    event.target.blur(); // which tells it
  });
  on("focusout", (event) => tell(event.target.id));
}
