// What is in an MCAP file, as others read it: prints it as one JSON object.
// Usage: node messages.mjs FILE
import { readFile } from 'node:fs/promises';
import { parse } from '@foxglove/rosmsg';
import { MessageReader } from '@foxglove/rosmsg2-serialization';
import { McapIndexedReader, McapStreamReader } from '@mcap/core';

const bytes = await readFile(process.argv[2]);

// All records from the first to the last, with every checksum.
const stream = new McapStreamReader({ validateCrcs: true, includeChunks: false });
stream.append(bytes);
let inOrder = 0;
for (let record = stream.nextRecord(); record; record = stream.nextRecord()) if (record.type === 'Message') inOrder++;
if (!stream.done()) throw new Error('the file does not end where it should');

// Through the summary and the indexes.
const reader = await McapIndexedReader.Initialize({
  readable: {
    size: async () => BigInt(bytes.byteLength),
    read: async (offset, size) => new Uint8Array(bytes.buffer, bytes.byteOffset + Number(offset), Number(size)),
  },
});
const readers = new Map();
for (const [id, channel] of reader.channelsById) {
  const schema = reader.schemasById.get(channel.schemaId);
  if (channel.messageEncoding !== 'cdr' || schema.encoding !== 'ros2msg') throw new Error(`${channel.topic} is no CDR`);
  readers.set(id, new MessageReader(parse(new TextDecoder().decode(schema.data), { ros2: true })));
}
const plain = (_, value) =>
  typeof value === 'bigint'
    ? value.toString()
    : ArrayBuffer.isView(value)
      ? Buffer.from(value.buffer, value.byteOffset, value.byteLength).toString('base64')
      : Number.isNaN(value)
        ? 'nan'
        : value;
const topics = {};
for await (const message of reader.readMessages()) {
  const { topic } = reader.channelsById.get(message.channelId);
  topics[topic] ??= [];
  topics[topic].push({
    sequence: message.sequence,
    log: message.logTime,
    publish: message.publishTime,
    message: readers.get(message.channelId).readMessage(message.data),
  });
}
const metadata = {};
for await (const entry of reader.readMetadata()) metadata[entry.name] = Object.fromEntries(entry.metadata);
const schemas = Object.fromEntries([...reader.channelsById.values()].map((c) => [c.topic, reader.schemasById.get(c.schemaId).name]));
const { statistics, header } = reader;
console.log(
  JSON.stringify({ inOrder, profile: header.profile, chunks: reader.chunkIndexes.length, statistics, schemas, metadata, topics },
    (key, value) => (value instanceof Map ? Object.fromEntries(value) : plain(key, value))),
);
