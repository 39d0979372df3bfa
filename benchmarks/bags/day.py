"""Writes a day's bag: odometry and joint states at 100 Hz, battery at 10 Hz, MCAP with zstd chunks of one second.

usage: day.py LOG.csv HOURS BAG.mcap
LOG.csv: a run log at 100 Hz from rest to rest. The day repeats it with noise, and the robot stands for STOP_S after each.
"""
import csv
import struct
import sys

import numpy as np
import zstandard

RATE, START_NS = 100, 1_700_000_000_000_000_000
STOP_S = 3
MAGIC = b"\x89MCAP0\r\n"
HALF_TRACK_M, WHEEL_RADIUS_M = 0.165, 0.0825
TYPES = {"/odom": "nav_msgs/msg/Odometry", "/joint_states": "sensor_msgs/msg/JointState",
         "/battery": "sensor_msgs/msg/BatteryState"}


def text(value):
    return struct.pack("<I", len(value)) + value.encode()


def record(opcode, content):
    return struct.pack("<BQ", opcode, len(content)) + content


def message_type(fields):
    """A record of one message: the MCAP head, then the message (little-endian CDR after 4 bytes)."""
    return np.dtype([("opcode", "u1"), ("length", "<u8"), ("channel", "<u2"), ("sequence", "<u4"), ("log_ns", "<u8"),
                     ("publish_ns", "<u8"), ("cdr", "V4"), ("sec", "<i4"), ("nanosec", "<u4"), *fields])


def cdr_text(value, at):
    """A text at a position behind the CDR's 4 bytes, with the padding before it."""
    return bytes(-at % 4) + struct.pack("<I", len(value) + 1) + value.encode() + b"\0"


def padded(data, start, size):
    """`data`, which begins at `start`, up to a multiple of `size`."""
    return data + bytes(-(start + len(data)) % size)


FRAMES = cdr_text("odom", 8)
FRAMES = padded(FRAMES + cdr_text("base_link", 8 + len(FRAMES)), 8, 8)
NAMES = padded(cdr_text("", 8), 8, 4) + struct.pack("<I", 2)
for joint in ("wheel_left_joint", "wheel_right_joint"):
    NAMES += cdr_text(joint, 8 + len(NAMES))
NAMES = padded(NAMES, 8, 4)
ODOMETRY = message_type([("frames", f"V{len(FRAMES)}"), ("position", "<f8", 3), ("orientation", "<f8", 4),
                         ("covariance", "<f8", 36), ("linear", "<f8", 3), ("angular", "<f8", 3), ("more", "<f8", 36)])
JOINTS = message_type([("names", f"V{len(NAMES)}"), ("n", "<u4"), *([("pad", "V4")] if (len(NAMES) + 12) % 8 else []),
                       ("position", "<f8", 2), ("n2", "<u4"), ("pad2", "V4"), ("velocity", "<f8", 2), ("n3", "<u4"),
                       ("pad3", "V4"), ("effort", "<f8", 2)])
BATTERY = message_type([("frame", "V8"), ("voltage", "<f4"), ("temperature", "<f4"), ("current", "<f4"), ("rest", "V41")])
EMPTY = np.void(struct.pack("<II", 1, 0))  # an empty text, padded
REST = np.void(bytes(28) + struct.pack("<IIIB", 1, 0, 1, 0))  # of a BatteryState: five numbers, two empty arrays, two empty texts


def messages(dtype, channel, times_ns, **fields):
    rows = np.zeros(len(times_ns), dtype)
    rows["opcode"], rows["length"], rows["channel"] = 5, dtype.itemsize - 9, channel
    rows["log_ns"] = rows["publish_ns"] = times_ns + 2_000_000
    rows["cdr"] = np.void(b"\0\1\0\0")
    rows["sec"], rows["nanosec"] = times_ns // 10**9, times_ns % 10**9
    for name, values in fields.items():
        rows[name] = values
    return rows.tobytes()


def channels():
    data = b""
    for number, (topic, name) in enumerate(TYPES.items(), 1):
        data += record(3, struct.pack("<H", number) + text(name) + text("") + text(""))
        data += record(4, struct.pack("<HH", number, number) + text(topic) + text("cdr") + struct.pack("<I", 0))
    return data


class Day:
    """The repeated run; the pose is the integral of its speeds."""

    def __init__(self, file):
        with open(file, newline="") as stream:
            rows = list(csv.DictReader(stream))
        rows += STOP_S * RATE * [rows[-1]]
        self.of = {name: np.array([float(row[name]) for row in rows]) for name in rows[0] if rows[0][name] != ""}
        self.rows = len(rows)
        self.random = np.random.default_rng(5)
        self.pose = np.zeros(3)

    def second(self, second):
        k = (np.arange(RATE) + second * RATE) % self.rows
        times_ns = START_NS + second * 10**9 + np.arange(RATE, dtype=np.int64) * (10**9 // RATE)
        wheels = np.stack([self.of[f"wheel_speed_{side}_rad_s"][k] for side in ("left", "right")], 1)
        wheels += (wheels != 0) * 0.003 * self.random.standard_normal(wheels.shape)
        v = WHEEL_RADIUS_M * wheels.mean(1)
        w = WHEEL_RADIUS_M * (wheels[:, 1] - wheels[:, 0]) / (2 * HALF_TRACK_M)
        heading = self.pose[2] + np.cumsum(w) / RATE
        x, y = (self.pose[i] + np.cumsum(v * f(heading)) / RATE for i, f in ((0, np.cos), (1, np.sin)))
        self.pose = np.array([x[-1], y[-1], heading[-1]])
        zero = np.zeros(RATE)
        current = np.stack([self.of[f"motor_current_{side}_A"][k] for side in ("left", "right")], 1)
        current += 0.02 * self.random.standard_normal(current.shape)
        tenth = slice(None, None, 10)
        return (messages(ODOMETRY, 1, times_ns, frames=np.void(FRAMES), position=np.stack([x, y, zero], 1),
                         orientation=np.stack([zero, zero, np.sin(heading / 2), np.cos(heading / 2)], 1),
                         linear=np.stack([v, zero, zero], 1), angular=np.stack([zero, zero, w], 1))
                + messages(JOINTS, 2, times_ns, names=np.void(NAMES), n=2, n2=2, n3=2, velocity=wheels, effort=current)
                + messages(BATTERY, 3, times_ns[tenth], frame=EMPTY, rest=REST, voltage=self.of["battery_voltage_V"][k][tenth],
                           current=-self.of["battery_current_A"][k][tenth] + 0.01 * self.random.standard_normal(10)))


def main():
    log, hours, file = sys.argv[1:]
    day, pack = Day(log), zstandard.ZstdCompressor(level=1).compress
    count = 0
    with open(file, "wb") as out:
        out.write(MAGIC + record(1, text("ros2") + text("bench")) + channels())
        for second in range(round(3600 * float(hours))):
            records = day.second(second)
            packed = pack(records)
            out.write(record(6, struct.pack("<QQQI", 0, 0, len(records), 0) + text("zstd") + struct.pack("<Q", len(packed)) + packed))
            count += 2 * RATE + RATE // 10
        out.write(record(15, bytes(4)) + record(2, bytes(20)) + MAGIC)
    print(count)


if __name__ == "__main__":
    main()
