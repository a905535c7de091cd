// Video by the decoder of the browser (WebCodecs).

/** @import {PictureHeader} from "webviz/messages.js" */

// Codecs of the packets: baseline strings, since the streams carry their own parameters.
/** @type {Record<string, string>} */
const CODECS = {
  h264: "avc1.640033",
  h265: "hev1.1.6.L153.B0",
  vp9: "vp09.00.50.08",
  av1: "av01.0.12M.08",
};
/** @type {Record<string, string>} */
const NAMES = { h264: "H.264", h265: "H.265", vp9: "VP9", av1: "AV1" };
const MAX_QUEUED = 30;

/**
 * Calls `draw(frame)` with each picture, and `fail(sentence)` if the video is damaged. `take` fails
 * with a sentence if there is no decoder.
 *
 * @param {(frame: VideoFrame) => void} draw
 * @param {(sentence: string) => void} fail
 */
export function makeVideo(draw, fail) {
  /** @type {VideoDecoder | null} */
  let decoder = null;
  /** @type {string | null} */
  let codec = null;
  let time = 0;
  /** @type {DOMException | null} */
  let failure = null;
  /** @type {() => void} */
  let goOn = () => {}; // ends the wait for a decoder that is closed

  function close() {
    goOn();
    if (decoder && decoder.state !== "closed") decoder.close(); // an error closes it, too
    decoder = null;
  }

  /** @param {string} codecName */
  async function open(codecName) {
    close();
    failure = null;
    codec = codecName;
    const config = await configFor(codecName);
    decoder = new VideoDecoder({
      output: closing(draw),
      error(error) {
        failure = error;
        goOn();
        fail(`The video is damaged: ${error.message}`);
      },
    });
    decoder.configure(config);
  }

  return {
    /**
     * @param {PictureHeader} header
     * @param {Uint8Array<ArrayBuffer>} data
     * @returns {Promise<void>}
     */
    async take({ video = "", sizes = [], starts = false }, data) {
      if (failure && !starts) return; // until the next key frame
      if (video !== codec || (starts && (failure || !decoder))) await open(video);
      if (!decoder) throw new Error(noDecoder(video));
      let at = 0;
      for (const [index, size] of sizes.entries()) {
        const type = starts && index === 0 ? "key" : "delta";
        const packet = { type, timestamp: time++, data: data.subarray(at, (at += size)) };
        decoder.decode(new EncodedVideoChunk(/** @type {EncodedVideoChunkInit} */ (packet)));
      }
      // A decoder that falls behind makes the server wait, too.
      while (decoder?.state === "configured" && decoder.decodeQueueSize > MAX_QUEUED)
        await dequeued(decoder, (end) => (goOn = end));
    },
    close,
  };
}

/** @param {(frame: VideoFrame) => void} draw */
const closing = (draw) => (/** @type {VideoFrame} */ frame) => {
  draw(frame);
  frame.close();
};

/**
 * Resolves when a decoder has taken a packet from its queue, or when what `begin` gets is called.
 *
 * @param {VideoDecoder} decoder
 * @param {(end: () => void) => void} begin
 */
const dequeued = (decoder, begin) =>
  new Promise((resolve) => {
    const end = () => resolve(undefined);
    begin(end);
    decoder.addEventListener("dequeue", end, { once: true });
  });

/**
 * The settings of a decoder.
 *
 * @param {string} codec
 */
async function configFor(codec) {
  if (!window.VideoDecoder) {
    throw new Error("Browsers decode video on pages from localhost or by https only.");
  }
  const config = { codec: CODECS[codec], optimizeForLatency: true };
  const { supported } = await VideoDecoder.isConfigSupported(config);
  if (!supported) throw new Error(noDecoder(codec));
  return config;
}

/** @param {string} codec */
const noDecoder = (codec) => `This browser has no decoder for ${NAMES[codec]} video.`;
