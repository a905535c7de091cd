"""What the page does to save what it shows: a script that every browser runs when it joins."""

from __future__ import annotations

IMAGE_SCRIPT = """
window.webvizImage = {
  save: (name) => {
    const pad = (number) => String(number).padStart(2, "0");
    const now = new Date();
    const day = [now.getFullYear(), pad(now.getMonth() + 1), pad(now.getDate())].join("-");
    const time = [now.getHours(), now.getMinutes(), now.getSeconds()].map(pad).join(".");
    window.__viserMutable.canvas.toBlob((blob) => {
      const link = document.createElement("a");
      link.href = URL.createObjectURL(blob);
      link.download = name || `webviz ${day} ${time}.png`;
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 60000);
    }, "image/png");
  },
};
"""
