#!/usr/bin/env python3
"""The studio's server against other programs of this machine, and what a save leaves of the files. No browser.

usage: server_test.py JOULEPATH
"""
import json
import pathlib
import re
import resource
import select
import socket
import stat
import sys
import tempfile
import time
import urllib.error

from studio_page import Served, write_mission

MEMORY_BYTES = 3 << 30
PATIENCE_S = 120


class Raw:
    """A connection that sends what it likes."""

    def __init__(self, served):
        self.port = int(re.match(r"http://[^:]*:(\d+)/", served.address)[1])
        self.base = served.address.split(str(self.port), 1)[1]
        self.socket = socket.create_connection(("127.0.0.1", self.port), timeout=PATIENCE_S)

    def head(self, target, *fields, method="POST"):
        own = f"127.0.0.1:{self.port}"
        lines = [f"{method} {target} HTTP/1.1", f"Host: {own}", f"Origin: http://{own}", *fields]
        return "\r\n".join(lines).encode() + b"\r\n\r\n"

    def send(self, data):
        """False where the server has hung up."""
        try:
            self.socket.sendall(data)
            return True
        except (ConnectionResetError, BrokenPipeError):
            return False

    def status(self):
        """Of the answer; 0 where the connection ends without one."""
        answer = b""
        try:
            while b"\r\n" not in answer:
                more = self.socket.recv(4096)
                if not more:
                    break
                answer += more
        except ConnectionResetError:
            pass
        return int(answer.split()[1]) if answer.startswith(b"HTTP/1.") else 0


def memory_kB(served):
    status = pathlib.Path(f"/proc/{served.process.pid}/status").read_text()
    return int(re.search(r"VmHWM:\s+(\d+)", status)[1])


def check_alive(served):
    assert served.process.poll() is None, f"the server ended with {served.process.returncode}"
    assert served.files()["name"] == "mission"


def check_token_comes_first(served):
    """Without the token nothing of a body is waited for; with it the announced size is a bounded number."""
    for fields in (("Transfer-Encoding: chunked",), ("Content-Length: 1000000",), ("Content-Length: 17000000",)):
        one = Raw(served)
        one.send(one.head("/nothing", *fields))
        assert one.status() == 404, fields
    for field, status in (("Content-Length: 17000000", 413), ("Content-Length: " + "9" * 40, 400), ("Content-Length: -1", 400), ("Content-Length: 1\r\nContent-Length: 2", 400),
                          ("Content-Length: 1\r\nTransfer-Encoding: chunked", 400), ("Content-Length : 1", 400), ("Host: other", 400)):
        one = Raw(served)
        one.send(one.head(one.base + "answer", field))
        assert one.status() == status, field


def chunk(data):
    return b"%x\r\n%s\r\n" % (len(data), data)


def check_chunks(served):
    """A body in chunks is read; its bound holds for their sum, and for what a chunk announces."""
    question = json.dumps({key: value for key, value in served.files().items() if key in ("mission", "robot", "base")}).encode()
    pieces = b"".join(chunk(question[at:at + 100]) for at in range(0, len(question), 100))
    mebibyte = chunk(b" " * (1 << 20))
    for body, status in ((pieces + b"0\r\n\r\n", 200), (15 * mebibyte + pieces + b"0\r\nX-Trailer: a\r\n\r\n", 200), (16 * mebibyte + chunk(b" "), 413), (b"1000001\r\n", 413),
                         (b"fffffffffffffffff\r\n", 400), (b"-1\r\n", 400), (b"1;" + b"x" * 20_000, 400), (b"0\r\n" + b"x: y\r\n" * 4000, 400)):
        one = Raw(served)
        one.send(one.head(one.base + "save", "Transfer-Encoding: chunked") + body)
        assert one.status() == status, (body[:100], status)


def check_headers_in_pieces(served):
    """The bound of the headers holds for their sum, however they arrive."""
    for start, piece in ((b"x", b": y\r\nx" * 20), (b"", b"x: y\r\n" * 20), (b"", b"a" * 120)):
        one = Raw(served)
        one.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        one.send(b"GET / HTTP/1.1\r\n" + start)
        for _ in range(200):
            time.sleep(0.002)
            one.send(piece)
        assert one.status() == 431, piece[:10]


def check_memory(served):
    """Chunks, headers and lines without end are cut off."""
    before_kB = memory_kB(served)
    chunks = b"100000\r\n" + b"a" * 0x100000 + b"\r\n"
    for start, more in ((lambda one: one.head("/nothing", "Transfer-Encoding: chunked"), chunks), (lambda one: one.head(one.base + "answer", "Transfer-Encoding: chunked"), chunks),
                        (lambda one: b"GET / HTTP/1.1\r\n", b"x: y\r\n" * 100_000), (lambda one: b"GET /", b"a" * 1_000_000), (lambda one: b"GET / HTTP/1.1\r\nHost: ", b"a" * 1_000_000)):
        one = Raw(served)
        one.send(start(one))
        for _ in range(100):
            if not one.send(more):
                break
    grown_kB = memory_kB(served) - before_kB
    assert grown_kB < 60_000, f"the server grew by {grown_kB} kB"


def check_deep_questions(served):
    for brackets in (b"[" * 100_000 + b"]" * 100_000, b'{"a":' * 40_000 + b"1" + b"}" * 40_000, b"[" * 5_000_000):
        for what in ("answer", "save"):
            for body in (b'{"mission":' + brackets + b',"robot":{}}', brackets):
                try:
                    served.post(what, body)
                    raise AssertionError("a deep question was answered")
                except urllib.error.HTTPError as error:
                    assert error.code == 400, error.code
    check_alive(served)


def check_slow_connections(served):
    """The page is answered while 150 connections send a byte of their headers now and then."""
    slow = [Raw(served) for _ in range(150)]
    page = Raw(served)
    page.send(page.head(page.base + "files", method="GET"))
    for byte in b"GET /" + b"a" * 55:
        for one in slow:
            one.send(bytes([byte]))
        if select.select([page.socket], [], [], 0.5)[0]:
            break
    else:
        raise AssertionError("slow connections hold up the page")
    assert page.status() == 200
    for one in slow:
        one.socket.close()


def saved(served, change):
    """The files with a change of {mission, robot}, saved; the answer."""
    files = served.files()
    change(files)
    return served.post("save", {key: files[key] for key in ("mission", "robot", "base")})


def add_payload(files):
    files["mission"]["legs"][0]["payload_kg"] += 0.5


def check_other_files(served, folder):
    """The page names no file; a question that does changes nothing, and the page stays alive."""
    mission, other = folder / "mission.yaml", folder.parent / "other_robot.yaml"
    other.write_bytes((folder / "robot.yaml").read_bytes())
    before = mission.read_bytes()
    for key, value in (("robot", "../other_robot.yaml"), ("robot", "gone.yaml"), ("map", "/etc/passwd"), ("order", "order.json"), ("speed_mask", {"file": "x.yaml"}), ("keepout", "x.yaml"), ("route_graph", "x")):
        try:
            saved(served, lambda files: files["mission"].update({key: value}))
            raise AssertionError(f"{key}: {value} was saved")
        except urllib.error.HTTPError as error:
            assert error.code == 400
        assert mission.read_bytes() == before, key
        check_alive(served)


def check_links_and_modes(program, folder):
    """A save writes through symbolic links and keeps modes; a file that may not be written stays."""
    write_mission(folder)
    real = folder / "real"
    real.mkdir()
    for name, mode in (("mission.yaml", 0o640), ("robot.yaml", 0o664)):
        (folder / name).rename(real / name)
        (real / name).chmod(mode)
    (folder / "mission.yaml").symlink_to("real/mission.yaml")
    (folder / "robot.yaml").symlink_to("real/robot.yaml")
    with Served(program, folder / "mission.yaml") as served:
        def change(files):
            add_payload(files)
            files["robot"]["limits"]["speed_m_s"] *= 0.9
        answer = saved(served, change)
        assert answer["mission"]["legs"][0]["payload_kg"] == 6.2, answer
        for name, mode in (("mission.yaml", 0o640), ("robot.yaml", 0o664)):
            assert (folder / name).is_symlink(), f"{name} is no link any more"
            assert stat.S_IMODE((real / name).stat().st_mode) == mode, name
        assert "6.2" in (real / "mission.yaml").read_text()
        assert answer == served.files(), "the answer of a save is not what the files hold"
        assert sorted(path.name for path in real.iterdir()) == ["mission.yaml", "robot.yaml"]


def check_line_ends(program, folder):
    """A file of CRLF stays one when lines are added, moved and removed."""
    mission = write_mission(folder)
    mission.write_bytes(mission.read_bytes().replace(b"\n", b"\r\n"))
    with Served(program, mission) as served:
        def reversed_and_longer(files):
            files["mission"]["legs"] = files["mission"]["legs"][::-1] + [{"motion": {"profile": "spin", "angle_rad": 1.0, "yaw_rate_rad_s": 0.5}, "payload_kg": 1.0}]
            files["mission"]["clearance_m"] = 0.1
        saved(served, reversed_and_longer)
        text = mission.read_bytes()
        assert b"spin" in text and b"clearance_m" in text
        assert text.count(b"\n") == text.count(b"\r\n"), text.decode()


def main():
    program = sys.argv[1]
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY_BYTES, MEMORY_BYTES))
    for check in (check_token_comes_first, check_chunks, check_headers_in_pieces, check_memory, check_deep_questions, check_slow_connections, check_other_files, check_links_and_modes, check_line_ends):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name) / "missions"
            folder.mkdir()
            if check in (check_links_and_modes, check_line_ends):
                check(program, folder)
            else:
                with Served(program, write_mission(folder)) as served:
                    check(served, folder) if check is check_other_files else check(served)
                    check_alive(served)
        print("ok:", check.__name__)


if __name__ == "__main__":
    main()
