"""What the page does when the server falls silent: a script that every browser runs when it joins.

The server says something at least every second (`Adapter.keep_in_contact`). A browser learns from
its websocket alone neither that a server hangs nor that a radio link broke.
"""

from __future__ import annotations

import json

BEAT = "webviz beat"
"""Marks the messages that only say that the server is there."""

_CONSTANTS = {
    "BEAT": BEAT,
    "TICK_MS": 500,
    "LOST_TICKS": 8,
}

CONTACT_SCRIPT = (
    "(function install() {"
    + "".join(f"const {key} = {json.dumps(value)};" for key, value in _CONSTANTS.items())
    + """
  const mutable = window.__viserMutable;
  if (!mutable || !mutable.canvas) return requestAnimationFrame(install);
  if (window.webvizContact) return;
  const queue = mutable.messageQueue;
  const push = queue.push;

  // Not a clock: of a page that was busy or asleep itself, the time does not count.
  let ticks = 0;
  let heard = Date.now();
  queue.push = function (...messages) {
    [ticks, heard] = [0, Date.now()];
    hide();
    return push.apply(this, messages.filter(({ uuid }) => uuid !== BEAT));
  };

  // viser's page looks for its server only while it has the focus; on a second screen it has not.
  document.hasFocus = () => true;

  const banner = document.createElement("div");
  banner.id = "webviz-contact";
  banner.setAttribute("role", "alert");
  banner.style.cssText =
    "position: fixed; inset: 0 0 auto; z-index: 10000; pointer-events: none; padding: 0.5em 1em;" +
    "text-align: center; font: 600 14px/1.4 sans-serif; color: #fff; background: #b3261e";

  function age() {
    const seconds = Math.round((Date.now() - heard) / 1000);
    if (seconds < 120) return `${seconds} s`;
    return seconds < 7200 ? `${Math.round(seconds / 60)} min` : `${Math.round(seconds / 3600)} h`;
  }

  function hide() {
    if (!banner.isConnected) return;
    banner.remove();
    mutable.canvas.style.filter = "";
  }

  function tick() {
    ticks += 1;
    if (ticks < LOST_TICKS) return;
    banner.textContent =
      `Connection to webviz lost. The picture is ${age()} old. ` +
      "Check that webviz is running; this page reconnects by itself.";
    if (banner.isConnected) return;
    document.body.append(banner);
    mutable.canvas.style.filter = "grayscale(1)";
  }

  window.webvizContact = setInterval(tick, TICK_MS);
})();
"""
)
