// The channel to the server: JSON objects whose `type` says what they are, and bytes from there.

/** @import {FromPage, ToPage} from "webviz/messages.js" */

import { signal, untracked } from "webviz/signals.js";

const MAX_UNSENT = 100;

/**
 * The part of a WebSocket that is used here.
 *
 * @typedef {{
 *   readyState: number, binaryType: string, send(text: string): void, close(): void,
 *   onopen: ((event: any) => void) | null, onclose: ((event: any) => void) | null,
 *   onmessage: ((event: any) => void) | null,
 * }} Socket
 */

/** @type {Map<string, ((message: any) => void)[]>} */
const listeners = new Map();
/** @type {(() => void)[]} */
const openers = [];
/** @type {((buffer: ArrayBuffer) => void)[]} */
const byteListeners = [];
/** @type {(() => void)[]} */
const closers = [];
const socket = signal(/** @type {Socket | null} */ (null));
/** @type {FromPage[]} */
const unsent = [];

/**
 * Calls `listener` with each message of a type.
 *
 * @template {ToPage["type"]} T
 * @param {T} type
 * @param {(message: Extract<ToPage, {type: T}>) => void} listener
 */
export function on(type, listener) {
  listeners.set(type, [...(listeners.get(type) ?? []), listener]);
}

/**
 * Calls `act` whenever the channel has been opened, before anything else is sent.
 *
 * @param {() => void} act
 */
export function onOpen(act) {
  openers.push(act);
}

/**
 * Calls `listener(buffer)` with whatever is not JSON.
 *
 * @param {(buffer: ArrayBuffer) => void} listener
 */
export function onBytes(listener) {
  byteListeners.push(listener);
}

/**
 * Calls `act` whenever the channel has ended.
 *
 * @param {() => void} act
 */
export function onClose(act) {
  closers.push(act);
}

const current = () => untracked(() => socket.value);

export const isOpen = () => current()?.readyState === WebSocket.OPEN;

/**
 * Sends a message to the server, as soon as it can be reached.
 *
 * @param {FromPage} message
 */
export function send(message) {
  if (isOpen()) current()?.send(JSON.stringify(message));
  else if (unsent.length < MAX_UNSENT) unsent.push(message);
}

/**
 * Opens the channel; to be called when everybody listens who will.
 *
 * @param {Socket} connected that is about to open
 * @param {string} key
 */
export function open(connected, key) {
  current()?.close();
  socket.value = connected;
  connected.onopen = () => {
    connected.send(JSON.stringify({ type: "Hello", key }));
    for (const act of openers) act();
    unsent.splice(0).forEach(send);
  };
  connected.onclose = () => {
    if (current() === connected) for (const act of closers) act();
  };
  // When it ends, the server ends viser's connection too: that is made anew, and brings a new key.
  connected.binaryType = "arraybuffer";
  connected.onmessage = ({ data }) => {
    if (typeof data !== "string") return byteListeners.forEach((take) => take(data));
    const message = JSON.parse(data);
    for (const listener of listeners.get(message.type) ?? []) listener(message);
  };
}
