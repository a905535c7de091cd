// Records what the scene shows as a video file of the browser.

import { el } from "webviz/dom.js";
import { icon } from "webviz/icons.js";
import { signal } from "webviz/signals.js";
import { canvas } from "webviz/viser_page.js";
import { duration } from "webviz/time_text.js";
import { toast } from "webviz/toasts.js";

const TYPES = ["video/mp4;codecs=avc1.42E01F", "video/mp4", "video/webm;codecs=vp9", "video/webm"]; // by preference
const FPS = 30;
const PART_MS = 1000;
const MAX_BYTES = 1 << 30;
const MAX_S = 3600;

const running = signal(/** @type {MediaRecorder | null} */ (null));
/** Seconds and bytes that have been recorded. */
const size = signal({ seconds: 0, bytes: 0 });

/** While a video is recorded: for how long and how much, and a button that stops it. */
export const videoButton = () =>
  el(
    "button",
    {
      type: "button",
      class: "wv-button wv-record wv-video",
      hidden: () => !running.value,
      "data-recording": true,
      "aria-label": "Stop recording the video",
      "data-tip": "Stop and save the video",
      onclick: toggle,
    },
    icon("record", 12),
    el("span", { class: "wv-number" }, () =>
      running.value ? `Recording a video: ${sizeText(size.value)}` : "",
    ),
  );

/** @param {{seconds: number, bytes: number}} of */
function sizeText({ seconds, bytes }) {
  const size = bytes < 1e6 ? `${Math.ceil(bytes / 1e3)} kB` : `${(bytes / 1e6).toFixed(1)} MB`;
  return `${duration(seconds, 0)} · ${size}`;
}

/** Starts a video, or stops and saves it. */
export function toggle() {
  if (running.value) running.value.stop();
  else start();
}

function start() {
  const type =
    globalThis.MediaRecorder && TYPES.find((each) => MediaRecorder.isTypeSupported(each));
  if (!type)
    return toast("This browser cannot record videos. Use another one.", { level: "error" });
  const stream = canvas().captureStream(FPS);
  const recorder = new MediaRecorder(stream, { mimeType: type, videoBitsPerSecond: 8_000_000 });
  /** @type {Blob[]} */
  const parts = [];
  const began = performance.now();
  const measure = () => {
    const bytes = parts.reduce((sum, part) => sum + part.size, 0);
    size.value = { seconds: (performance.now() - began) / 1000, bytes };
  };
  recorder.addEventListener("dataavailable", ({ data }) => {
    parts.push(data);
    measure();
    const isLong = size.value.bytes > MAX_BYTES || size.value.seconds > MAX_S;
    if (isLong && recorder.state === "recording") recorder.stop();
  });
  recorder.addEventListener("error", () =>
    toast("The browser has stopped recording the video.", { level: "error" }),
  );
  const ticking = setInterval(measure, PART_MS); // a scene at rest gives no data
  recorder.addEventListener("stop", () => {
    clearInterval(ticking);
    for (const track of stream.getTracks()) track.stop();
    running.value = null;
    save(new Blob(parts, { type }), type);
  });
  measure();
  running.value = recorder;
  recorder.start(PART_MS);
  toast("Recording the scene without panels. Stop to save the video.");
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
