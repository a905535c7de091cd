// Prints what Foxglove's reader finds in an MCAP file, as JSON.
//
//     node read_mcap.js FOLDER_OF_NODE_MODULES FILE

import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { zstdDecompressSync } from "node:zlib";

const [folder, file] = process.argv.slice(2);
const { McapIndexedReader } = createRequire(`${folder}/`)("@mcap/core");
const data = readFileSync(file);
const readable = {
  size: async () => BigInt(data.length),
  read: async (/** @type {bigint} */ at, /** @type {bigint} */ length) =>
    new Uint8Array(data.subarray(Number(at), Number(at + length))),
};
const decompressHandlers = {
  zstd: (/** @type {Uint8Array} */ packed) => new Uint8Array(zstdDecompressSync(packed)),
};
const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
const messages = [];
for await (const { channelId, logTime, data: bytes } of reader.readMessages()) {
  const { topic } = reader.channelsById.get(channelId);
  messages.push([topic, String(logTime), Buffer.from(bytes).toString("base64")]);
}
const channels = [...reader.channelsById.values()].map((channel) => {
  const { name, encoding } = reader.schemasById.get(channel.schemaId);
  const qos = channel.metadata.get("offered_qos_profiles");
  return [channel.topic, channel.messageEncoding, name, encoding, qos];
});
console.log(JSON.stringify({ profile: reader.header.profile, channels, messages }));
