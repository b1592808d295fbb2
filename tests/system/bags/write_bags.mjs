// Bags of ROS 2 by the writers of others: @mcap/core, and messages in CDR by @foxglove/rosmsg2-serialization.
// Usage: node write_bags.mjs FOLDER: reads FOLDER/scene.json and its files, writes FOLDER/*.mcap and FOLDER/cdr/.
import {execFileSync} from 'node:child_process';
import {createRequire} from 'node:module';
import * as fs from 'node:fs';
import * as path from 'node:path';

const folder = process.argv[2];
const require = createRequire(path.join(process.cwd(), 'node_modules', 'x.js'));
const {McapWriter} = require('@mcap/core');
const {MessageWriter} = require('@foxglove/rosmsg2-serialization');
const {ros2galactic} = require('@foxglove/rosmsg-msgs-common');

const scene = JSON.parse(fs.readFileSync(path.join(folder, 'scene.json')));
const bytes = (name) => new Uint8Array(fs.readFileSync(path.join(folder, name)));

function definitions(type) {
  const all = new Map();
  const add = (name) => {
    if (all.has(name)) return;
    all.set(name, {...ros2galactic[name], name});
    for (const field of ros2galactic[name].definitions) if (field.isComplex) add(field.type);
  };
  add(type.replace('/msg/', '/'));  // the name that the definitions have
  return [...all.values()];
}

const writers = new Map();
function cdr(type, message) {
  if (!writers.has(type)) writers.set(type, new MessageWriter(definitions(type)));
  return writers.get(type).writeMessage(message);
}

const header = (message) => ({stamp: {sec: message.sec, nanosec: message.nanosec}, frame_id: message.frame_id});

// One message of scene.json as ROS 2 has it.
function encoded(message) {
  const value = {...message.value};
  if (message.data) value.data = bytes(message.data);
  if (message.stamped) value.header = header(message);
  return cdr(message.type, value);
}

class File {
  constructor(name) { this.file = fs.openSync(name, 'w'); this.at = 0n; }
  position() { return this.at; }
  async write(buffer) { fs.writeSync(this.file, buffer); this.at += BigInt(buffer.byteLength); }
}

const compressors = {
  '': undefined,
  lz4: (data) => ({compression: 'lz4', compressedData: new Uint8Array(
    execFileSync('lz4', ['-c', '-q'], {input: data, maxBuffer: 1 << 30}))}),
  zstd: (data) => ({compression: 'zstd', compressedData: new Uint8Array(
    execFileSync('zstd', ['-c', '-q'], {input: data, maxBuffer: 1 << 30}))}),
};

async function write(bag, messages) {
  const options = {writable: new File(path.join(folder, bag.name)), ...bag.options};
  if (bag.compression) options.compressChunk = compressors[bag.compression];
  const writer = new McapWriter(options);
  await writer.start({profile: 'ros2', library: ''});
  const channels = new Map();
  for (const [i, message] of messages.entries()) {
    if (!channels.has(message.topic)) {
      const schemaId = await writer.registerSchema({name: message.type, encoding: 'ros2msg', data: new Uint8Array()});
      channels.set(message.topic, await writer.registerChannel(
        {schemaId, topic: message.topic, messageEncoding: 'cdr', metadata: new Map()}));
    }
    const logTime = BigInt(message.log_ns);
    await writer.addMessage({channelId: channels.get(message.topic), sequence: i, logTime, publishTime: logTime,
                             data: message.encoded});
  }
  await writer.end();
}

fs.mkdirSync(path.join(folder, 'cdr'), {recursive: true});
for (const [i, message] of scene.messages.entries()) {
  message.encoded = encoded(message);
  fs.writeFileSync(path.join(folder, 'cdr', `${i}`), message.encoded);
}
for (const bag of scene.bags) await write(bag, scene.messages.filter((m) => bag.topics.includes(m.topic)));
