"""Texts that are typed into dropdowns.

viser's dropdown can be searched, but forgets a text that is not among its options. With this script
Enter, or leaving the field, tells the server what was typed; Escape, or a click on an option, does
not.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import msgspec

from webviz.edges.scene.adapter import Adapter, gui_input

SUBJECT = "webviz typed"
"""Marks the messages by which a page tells what was typed."""

TYPING_SCRIPT = """
(function () {
  if (window.webvizTyping) return;
  window.webvizTyping = true;
  let typed = null;
  let isPicking = false;

  function tell(input) {
    const text = input.value;
    if (typed !== input || !text.trim()) return;
    typed = null;
    window.__viserMutable.sendMessage({
      type: "LocalStorageGetItemResponseMessage",
      request_uuid: SUBJECT,
      value: JSON.stringify({ uuid: input.id, text: text.trim() }),
      error: null,
    });
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
})();
""".replace("SUBJECT", json.dumps(SUBJECT))


def on_typed(link: Adapter, listener: Callable[[Any, str], None]) -> None:
    """Call `listener` with an input widget and the text that a browser typed into it.

    It runs on viser's event loop; nobody vouches for either.
    """

    def hear(_: int, told: str) -> None:
        try:
            typed = msgspec.json.decode(told, type=dict[str, str])
            handle = gui_input(link.server, typed["uuid"])
            text = typed["text"]
        except (msgspec.DecodeError, KeyError, TypeError):
            return  # no page of ours says that
        if handle is not None:
            listener(handle, text)

    link.on_told(SUBJECT, hear)
    link.run_javascript(TYPING_SCRIPT)
