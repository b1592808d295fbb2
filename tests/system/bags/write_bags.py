#!/usr/bin/python3
"""The same scene as bags, as PNG files and as PCD files, by the writers of others.

Usage: write_bags.py FOLDER: in the folder that has node_modules.

A waved surface that moves away, seen by a pinhole of 64 x 48 pixels, 32 frames a second, so that times are exact.
Bags of ROS 1 by rosbag, of ROS 2 by @mcap/core and SQLite, images by Pillow. PCD files have the numbers of the clouds.
"""
import json
import os
import pathlib
import shutil
import sqlite3
import struct
import subprocess
import sys

import genpy
import numpy as np
import rosbag
from PIL import Image as Picture
from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from sensor_msgs.msg import CameraInfo, CompressedImage, Image, PointCloud2, PointField
from std_msgs.msg import Float32, Header
from tf2_msgs.msg import TFMessage

WIDTH, HEIGHT, FOCAL, CENTRE = 64, 48, 50.0, (31.5, 23.5)
FRAMES, STEP_NS, START_S = 10, 31_250_000, 1_700_000_000
PARAMETERS = [-0.2, 0.05, 0.001, -0.0015, 0.01]  # plumb bob: k1, k2, p1, p2, k3

folder = pathlib.Path(sys.argv[1])
u, v = np.meshgrid(np.arange(WIDTH), np.arange(HEIGHT))


def depth_mm(frame):
    """Whole millimetres, so that every kind of image can have them; no measurement in one corner."""
    depth = np.rint(700 + 40 * np.sin(u / 9) * np.cos(v / 7) + 2 * frame).astype(np.uint16)
    depth[:5, :6] = 0
    return depth


def points(frame):
    """x, y, z in float32, as a driver sends them; NaN where nothing was measured."""
    z = np.where(depth_mm(frame) > 0, depth_mm(frame) / 1000, np.nan).astype(np.float32)
    x = ((u - np.float32(CENTRE[0])) * z / np.float32(FOCAL)).astype(np.float32)
    y = ((v - np.float32(CENTRE[1])) * z / np.float32(FOCAL)).astype(np.float32)
    return np.stack([x, y, z], axis=-1)


def colour(frame):
    return (np.uint32(0xFF000000) | (u << 16) | (v << 8) | frame).astype(np.uint32)


def stamp(frame):
    nanoseconds = frame * STEP_NS
    return START_S + nanoseconds // 10**9, nanoseconds % 10**9


def png_bytes(depth):
    file = folder / "scratch.png"
    Picture.fromarray(depth.astype(np.uint16)).save(file)
    data = file.read_bytes()
    file.unlink()
    return data


def write_folders():
    for name in ("png/depth", "pcd", "pcd_loose"):
        (folder / name).mkdir(parents=True)
    camera = dict(width=WIDTH, height=HEIGHT, fx=FOCAL, fy=FOCAL, cx=CENTRE[0], cy=CENTRE[1], depth_scale_m=0.001,
                  frame_rate_hz=10**9 / STEP_NS)
    (folder / "png/camera.json").write_text(json.dumps(camera))
    for name in ("pcd", "pcd_loose"):
        (folder / name / "camera.json").write_text(json.dumps(camera))
    for i in range(FRAMES):
        (folder / f"png/depth/{i:04}.png").write_bytes(png_bytes(depth_mm(i)))
        for name, width, height in (("pcd", WIDTH, HEIGHT), ("pcd_loose", WIDTH * HEIGHT, 1)):
            head = (f"VERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH {width}\n"
                    f"HEIGHT {height}\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {WIDTH * HEIGHT}\nDATA binary\n")
            (folder / name / f"{i}.pcd").write_bytes(head.encode() + cloud_bytes(i, "<", 16, 12))


def cloud_bytes(frame, order, step, colour_at, wide=False):
    """Points of `step` bytes, with x, y, z in front."""
    rows = np.zeros((WIDTH * HEIGHT, step), np.uint8)
    real = np.dtype(order + ("f8" if wide else "f4"))
    rows[:, :3 * real.itemsize] = points(frame).reshape(-1, 3).astype(real).view(np.uint8)
    rows[:, colour_at:colour_at + 4] = colour(frame).reshape(-1, 1).astype(order + "u4").view(np.uint8)
    return rows.tobytes()


def info(**changes):
    values = dict(width=WIDTH, height=HEIGHT, distortion_model="plumb_bob", d=[0.0] * 5,
                  k=[FOCAL, 0.0, CENTRE[0], 0.0, FOCAL, CENTRE[1], 0.0, 0.0, 1.0],
                  r=[1.0, 0, 0, 0, 1.0, 0, 0, 0, 1.0],
                  p=[FOCAL, 0.0, CENTRE[0], 0.0, 0.0, FOCAL, CENTRE[1], 0.0, 0.0, 0.0, 1.0, 0.0],
                  binning_x=0, binning_y=0,
                  roi=dict(x_offset=0, y_offset=0, height=0, width=0, do_rectify=False))
    return {**values, **changes}


class Scene:
    """The messages of all topics, in the order in which a recorder got them."""

    def __init__(self):
        self.messages, self.files = [], 0

    def add(self, frame, topic, kind, value, data=None, frame_id="optical", log_frame=None, stamped=True):
        sec, nanosec = stamp(frame)
        log_ns = (START_S + 3) * 10**9 + (frame if log_frame is None else log_frame) * STEP_NS
        message = dict(topic=topic, type=kind, sec=sec, nanosec=nanosec, frame_id=frame_id, value=value, stamped=stamped,
                       log_ns=str(log_ns))
        if data is not None:
            message["data"] = f"data/{self.files}"
            (folder / message["data"]).write_bytes(data)
            self.files += 1
        self.messages.append(message)


def fields(names, datatype, size, colour_at):
    xyz = [dict(name=n, offset=i * size, datatype=datatype, count=1) for i, n in enumerate(names)]
    return xyz + [dict(name="rgb", offset=colour_at, datatype=6, count=1)]


def add_clouds(scene, frame, topic, order, step, colour_at, wide=False, loose=False, log_frame=None, times=1):
    datatype, size = (8, 8) if wide else (7, 4)
    width, height = (WIDTH * HEIGHT, 1) if loose else (WIDTH, HEIGHT)
    value = dict(height=height, width=width, fields=fields("xyz", datatype, size, colour_at),
                 is_bigendian=order == ">", point_step=step, row_step=step * width, is_dense=False)
    for _ in range(times):
        scene.add(frame, topic, "sensor_msgs/msg/PointCloud2", value, cloud_bytes(frame, order, step, colour_at, wide),
                  log_frame=log_frame)


def add_images(scene, frame):
    image = "sensor_msgs/msg/Image"
    depth = depth_mm(frame)
    size = dict(height=HEIGHT, width=WIDTH)
    scene.add(frame, "/mm/image_raw", image, dict(**size, encoding="16UC1", is_bigendian=0, step=2 * WIDTH),
              depth.astype("<u2").tobytes())
    scene.add(frame, "/big/image_raw", image, dict(**size, encoding="16UC1", is_bigendian=1, step=2 * WIDTH + 6),
              b"".join(row.tobytes() + b"ending" for row in depth.astype(">u2")))
    metres = np.where(depth > 0, depth * 0.001, np.nan)
    scene.add(frame, "/metres/image_raw", image, dict(**size, encoding="32FC1", is_bigendian=0, step=4 * WIDTH),
              metres.astype("<f4").tobytes())
    scene.add(frame, "/bent/image_raw", image, dict(**size, encoding="16UC1", is_bigendian=0, step=2 * WIDTH),
              depth.astype("<u2").tobytes())
    scene.add(frame, "/bent/image_rect", image, dict(**size, encoding="16UC1", is_bigendian=0, step=2 * WIDTH),
              depth.astype("<u2").tobytes())
    head = struct.pack("<iff", 0, 0, 0)
    scene.add(frame, "/mm/image_raw/compressedDepth", "sensor_msgs/msg/CompressedImage",
              dict(format="16UC1; compressedDepth png"), head + png_bytes(depth))
    # As image_transport does it: q = a / depth + b, here with 100 m and a step of 1 cm at 1 m.
    b = 1.0
    a = 100.0 * (100.0 + 1)
    q = np.where(depth > 0, np.rint(a / np.maximum(depth * 0.001, 1e-3) + b), 0)
    scene.add(frame, "/metres/image_raw/compressedDepth", "sensor_msgs/msg/CompressedImage",
              dict(format="32FC1; compressedDepth png"), struct.pack("<iff", 0, a, b) + png_bytes(q))
    scene.add(frame, "/rgb/image_raw", image, dict(**size, encoding="rgb8", is_bigendian=0, step=3 * WIDTH),
              bytes(3 * WIDTH * HEIGHT))


def write_scene():
    scene = Scene()
    turn = [0.5, -0.5, 0.5, -0.5]  # from the optical axes (z forward) to those of the body (x forward)
    x, y, z, w = turn
    transforms = [dict(header=dict(stamp=dict(sec=0, nanosec=0), frame_id="base"), child_frame_id="body",
                       transform=dict(translation=dict(x=1.0, y=2.0, z=3.0), rotation=dict(x=0.0, y=0.0, z=0.0, w=1.0))),
                  dict(header=dict(stamp=dict(sec=0, nanosec=0), frame_id="body"), child_frame_id="optical",
                       transform=dict(translation=dict(x=0.0, y=0.0, z=0.0), rotation=dict(x=x, y=y, z=z, w=w)))]
    scene.add(0, "/tf_static", "tf2_msgs/msg/TFMessage", dict(transforms=transforms), stamped=False)
    for topic in ("/mm", "/big", "/metres", "/rgb"):
        scene.add(0, topic + "/camera_info", "sensor_msgs/msg/CameraInfo", info())
    scene.add(0, "/bent/camera_info", "sensor_msgs/msg/CameraInfo", info(d=PARAMETERS))
    order = [0, 1, 3, 2, 4, 5, 6, 9, 8, 7]  # in which the recorder got the messages of /shuffled
    for i in range(FRAMES):
        add_clouds(scene, i, "/points", "<", 16, 12)
        add_clouds(scene, i, "/points_big", ">", 32, 16)
        add_clouds(scene, i, "/points_wide", "<", 32, 28, wide=True)
        add_clouds(scene, i, "/points_loose", "<", 16, 12, loose=True)
        add_clouds(scene, order[i], "/shuffled", "<", 16, 12, log_frame=i, times=2 if i == 4 else 1)
        add_images(scene, i)
    topics = sorted({message["topic"] for message in scene.messages})
    clouds = ["/points", "/tf_static"]
    bags = [dict(name="all.mcap", topics=topics, compression="zstd", options={}),
            dict(name="points_lz4.mcap", topics=clouds, compression="lz4", options=dict(chunkSize=100000)),
            dict(name="points_zstd.mcap", topics=clouds, compression="zstd", options=dict(chunkSize=100000)),
            dict(name="points_plain.mcap", topics=clouds, compression="", options=dict(chunkSize=100000)),
            dict(name="points_loose_records.mcap", topics=clouds, compression="", options=dict(useChunks=False)),
            dict(name="points_no_index.mcap", topics=clouds, compression="lz4",
                 options=dict(useMessageIndex=False, useChunkIndex=False, useStatistics=False, useSummaryOffsets=False,
                              repeatSchemas=False, repeatChannels=False))]
    (folder / "scene.json").write_text(json.dumps(dict(messages=scene.messages, bags=bags)))
    return scene.messages, topics


def write_db3(messages, topics):
    """The tables of rosbag2_storage_sqlite3."""
    (folder / "ros2").mkdir()
    (folder / "ros2/metadata.yaml").write_text("rosbag2_bagfile_information:\n  version: 5\n")
    database = sqlite3.connect(folder / "ros2/ros2_0.db3")
    database.executescript(
        "CREATE TABLE topics(id INTEGER PRIMARY KEY,name TEXT NOT NULL,type TEXT NOT NULL,"
        "serialization_format TEXT NOT NULL,offered_qos_profiles TEXT NOT NULL);"
        "CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER NOT NULL,timestamp INTEGER NOT NULL, data BLOB NOT NULL);"
        "CREATE INDEX timestamp_idx ON messages (timestamp ASC);")
    kinds = {message["topic"]: message["type"] for message in messages}
    for i, topic in enumerate(topics):
        database.execute("INSERT INTO topics VALUES (?, ?, ?, 'cdr', '')", (i + 1, topic, kinds[topic]))
    for i, message in enumerate(messages):
        database.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)",
                         (topics.index(message["topic"]) + 1, int(message["log_ns"]), (folder / f"cdr/{i}").read_bytes()))
    database.commit()
    database.close()
    (folder / "split").mkdir()
    shutil.copy(folder / "ros2/metadata.yaml", folder / "split")
    for part in (0, 1):
        database = sqlite3.connect(folder / f"split/split_{part}.db3")
        source = sqlite3.connect(folder / "ros2/ros2_0.db3")
        source.backup(database)
        middle = (START_S + 3) * 10**9 + 5 * STEP_NS
        database.execute(f"DELETE FROM messages WHERE timestamp {'>=' if part == 0 else '<'} ?", (middle,))
        database.execute("DELETE FROM messages WHERE topic_id != ?", (topics.index("/points") + 1,))
        database.commit()
        database.close()


def ros1_message(message):
    value, kind = message["value"], message["type"]
    header = Header(stamp=genpy.Time(message["sec"], message["nanosec"]), frame_id=message["frame_id"])
    data = (folder / message["data"]).read_bytes() if "data" in message else b""
    if kind.endswith("PointCloud2"):
        rest = {k: value[k] for k in ("height", "width", "is_bigendian", "point_step", "row_step", "is_dense")}
        return PointCloud2(header=header, fields=[PointField(**f) for f in value["fields"]], data=data, **rest)
    if kind.endswith("CompressedImage"):
        return CompressedImage(header=header, format=value["format"], data=data)
    if kind.endswith("Image"):
        return Image(header=header, data=data, **value)
    if kind.endswith("CameraInfo"):
        camera = CameraInfo(header=header, width=value["width"], height=value["height"],
                            distortion_model=value["distortion_model"])
        camera.D, camera.K, camera.R, camera.P = value["d"], value["k"], value["r"], value["p"]
        return camera
    return TFMessage(transforms=[
        TransformStamped(header=Header(frame_id=t["header"]["frame_id"]), child_frame_id=t["child_frame_id"],
                         transform=Transform(Vector3(**t["transform"]["translation"]),
                                             Quaternion(**t["transform"]["rotation"])))
        for t in value["transforms"]])


def write_ros1(messages):
    for name, compression in (("plain.bag", "none"), ("lz4.bag", "lz4"), ("bz2.bag", "bz2")):
        with rosbag.Bag(str(folder / name), "w", compression=compression, chunk_threshold=200000) as bag:
            for message in messages:
                bag.write(message["topic"], ros1_message(message),
                          genpy.Time(*divmod(int(message["log_ns"]), 10**9)))
    # As librealsense names its topics, in units of 0.5 mm.
    sensor = "/device_0/sensor_0/"
    with rosbag.Bag(str(folder / "realsense.bag"), "w") as bag:
        bag.write(sensor + "option/Depth Units/value", Float32(0.0005), genpy.Time(START_S))
        camera = next(m for m in messages if m["topic"] == "/mm/camera_info")
        bag.write(sensor + "Depth_0/info/camera_info", ros1_message(camera), genpy.Time(START_S))
        for i in range(FRAMES):
            header = Header(stamp=genpy.Time(*stamp(i)), frame_id="0")
            bag.write(sensor + "Depth_0/image/data",
                      Image(header=header, height=HEIGHT, width=WIDTH, encoding="mono16", step=2 * WIDTH,
                            data=(2 * depth_mm(i)).astype("<u2").tobytes()), genpy.Time(*stamp(i)))
            bag.write("/device_0/sensor_1/Color_0/image/data",
                      Image(header=header, height=HEIGHT, width=WIDTH, encoding="rgb8", step=3 * WIDTH,
                            data=bytes(3 * WIDTH * HEIGHT)), genpy.Time(*stamp(i)))


def main():
    (folder / "data").mkdir(parents=True)
    write_folders()
    messages, topics = write_scene()
    script = pathlib.Path(__file__).with_name("write_bags.mjs")
    subprocess.run(["node", str(script), str(folder)], check=True)
    write_db3(messages, topics)
    write_ros1(messages)


main()
