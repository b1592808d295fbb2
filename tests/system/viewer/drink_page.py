#!/usr/bin/python3
"""Takes all that a live run sends to its page, acknowledges it, and draws nothing. Usage: drink_page.py ADDRESS"""
import os
import socket
import struct
import sys
import urllib.parse

place = urllib.parse.urlsplit(sys.argv[1])
host = f"{place.hostname}:{place.port}"
link = socket.create_connection((place.hostname, place.port))
link.sendall(f"GET {place.path}channel?1 HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\nConnection: Upgrade\r\n"
             "Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n".encode())
stream = link.makefile("rb")
assert b" 101 " in stream.readline()
while stream.readline().strip():
    pass


def messages():
    while True:
        head = stream.read(2)
        if len(head) < 2 or head[0] & 15 == 8:
            return
        size = head[1] & 127
        if size == 126:
            size, = struct.unpack(">H", stream.read(2))
        elif size == 127:
            size, = struct.unpack(">Q", stream.read(8))
        yield head[0] & 15, stream.read(size)


def send(payload):
    mask = os.urandom(4)
    masked = bytes(byte ^ mask[i % 4] for i, byte in enumerate(payload))
    link.sendall(struct.pack("BB", 0x82, 0x80 | len(payload)) + mask + masked)


ticks = frames = size = 0
try:
    for kind, message in messages():
        size += len(message)
        if kind != 2 or len(message) < 16:
            continue
        what, number, rows = struct.unpack_from("<III", message)
        ticks += rows if what == 1 else 0
        frames += what == 2
        send(struct.pack("<II", 2, number))
except OSError:
    pass
print(f"(page: {ticks} ticks, {frames} frames, {size / 1e6:.0f} MB)")
