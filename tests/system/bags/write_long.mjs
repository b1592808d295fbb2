// A long bag of clouds of 640 x 480 points.
// Usage: node write_long.mjs NODE_MODULES FILE FRAMES
import {createRequire} from 'node:module';
import * as fs from 'node:fs';
import * as path from 'node:path';

const [modules, name, frames] = process.argv.slice(2);
const require = createRequire(path.join(path.resolve(modules), 'x.js'));
const {McapWriter} = require('@mcap/core');
const {MessageWriter} = require('@foxglove/rosmsg2-serialization');
const {ros2galactic} = require('@foxglove/rosmsg-msgs-common');

const width = 640, height = 480, focal = 525;
const points = new Float32Array(4 * width * height);
for (let v = 0; v < height; v++)
  for (let u = 0; u < width; u++)
    points.set([(u - 319.5) * 0.8 / focal, (v - 239.5) * 0.8 / focal, 0.8, 0], 4 * (v * width + u));
const types = ['sensor_msgs/PointCloud2', 'sensor_msgs/PointField', 'std_msgs/Header', 'builtin_interfaces/Time'];
const cdr = new MessageWriter(types.map((type) => ({...ros2galactic[type], name: type})));
const fields = ['x', 'y', 'z'].map((field, i) => ({name: field, offset: 4 * i, datatype: 7, count: 1}));

const file = fs.openSync(name, 'w');
let at = 0n;
const writable = {
  position: () => at,
  write: async (buffer) => { fs.writeSync(file, buffer); at += BigInt(buffer.byteLength); },
};
const writer = new McapWriter({writable});
await writer.start({profile: 'ros2', library: ''});
const schemaId = await writer.registerSchema({name: 'sensor_msgs/msg/PointCloud2', encoding: 'ros2msg', data: new Uint8Array()});
const channelId = await writer.registerChannel({schemaId, topic: '/points', messageEncoding: 'cdr', metadata: new Map()});
for (let i = 0; i < Number(frames); i++) {
  const ns = BigInt(i) * 31250000n + 1700000000000000000n;
  const stamp = {sec: Number(ns / 1000000000n), nanosec: Number(ns % 1000000000n)};
  const data = cdr.writeMessage({header: {stamp, frame_id: 'optical'}, height, width, fields, is_bigendian: false,
                                 point_step: 16, row_step: 16 * width, data: new Uint8Array(points.buffer), is_dense: true});
  await writer.addMessage({channelId, sequence: i, logTime: ns, publishTime: ns, data});
}
await writer.end();
