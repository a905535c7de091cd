// Records what the scene shows as a video file of the browser.

import { el, set, setText } from "webviz/dom.js";
import { icon } from "webviz/icons.js";
import { listeners } from "webviz/listeners.js";
import { canvas } from "webviz/viser_page.js";
import { duration } from "webviz/time_text.js";
import { toast } from "webviz/toasts.js";

const TYPES = ["video/mp4;codecs=avc1.42E01F", "video/mp4", "video/webm;codecs=vp9", "video/webm"]; // by preference
const FPS = 30;
const PART_MS = 1000;
const MAX_BYTES = 1 << 30;
const MAX_S = 3600;

/** @type {{recorder: MediaRecorder, parts: Blob[], bytes: number, began: number} | null} */
let running = null;
const changes = listeners();

/** While a video is recorded: for how long and how much, and a button that stops it. */
export function videoButton() {
  const label = el("span", { class: "wv-number" });
  const button = el(
    "button",
    {
      type: "button",
      class: "wv-button wv-record wv-video",
      "data-recording": true,
      onclick: toggle,
    },
    icon("record", 12),
    label,
  );
  const show = () => {
    button.hidden = running === null;
    const text = running ? `Recording a video: ${sizeText(running)}` : "";
    setText(label, text);
    set(button, {
      "aria-label": "Stop recording the video",
      "data-tip": "Stop and save the video",
    });
  };
  changes.on(show);
  show();
  return button;
}

/** @param {{began: number, bytes: number}} of */
function sizeText({ began, bytes }) {
  const seconds = (performance.now() - began) / 1000;
  const size = bytes < 1e6 ? `${Math.ceil(bytes / 1e3)} kB` : `${(bytes / 1e6).toFixed(1)} MB`;
  return `${duration(seconds, 0)} · ${size}`;
}

/** Starts a video, or stops and saves it. */
export function toggle() {
  if (running) running.recorder.stop();
  else start();
}

function start() {
  const type =
    globalThis.MediaRecorder && TYPES.find((each) => MediaRecorder.isTypeSupported(each));
  if (!type)
    return toast("This browser cannot record videos. Use another one.", { level: "error" });
  const stream = canvas().captureStream(FPS);
  const recorder = new MediaRecorder(stream, { mimeType: type, videoBitsPerSecond: 8_000_000 });
  const made = { recorder, parts: /** @type {Blob[]} */ ([]), bytes: 0, began: performance.now() };
  recorder.addEventListener("dataavailable", ({ data }) => {
    made.parts.push(data);
    made.bytes += data.size;
    const isLong = made.bytes > MAX_BYTES || performance.now() - made.began > MAX_S * 1000;
    if (isLong && recorder.state === "recording") recorder.stop();
    changes.tell();
  });
  recorder.addEventListener("error", () =>
    toast("The browser has stopped recording the video.", { level: "error" }),
  );
  const ticking = setInterval(changes.tell, PART_MS); // a scene at rest gives no data
  recorder.addEventListener("stop", () => {
    clearInterval(ticking);
    for (const track of stream.getTracks()) track.stop();
    running = null;
    changes.tell();
    save(new Blob(made.parts, { type }), type);
  });
  running = made;
  recorder.start(PART_MS);
  toast("Recording the scene without panels. Stop to save the video.");
  changes.tell();
}

/**
 * @param {Blob} video
 * @param {string} type
 */
function save(video, type) {
  if (!video.size) return toast("Nothing was recorded. Record for longer.", { level: "warn" });
  const ending = type.startsWith("video/mp4") ? "mp4" : "webm";
  const link = el("a", {
    download: `webviz ${new Date().toISOString().slice(0, 19).replaceAll(":", ".").replace("T", " ")}.${ending}`,
    href: URL.createObjectURL(video),
  });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
  toast(`Saved a video of ${(video.size / 1e6).toFixed(1)} MB.`);
}
