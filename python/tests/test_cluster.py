"""Many plans on Dask workers: the bytes of one process, whatever happens to the workers."""
import json
import os
import pathlib
import random
import signal
import subprocess
import sys
import threading

import pytest

import joulepath as jp

distributed = pytest.importorskip("distributed", reason="distributed (Dask) is not installed")
from joulepath import cluster  # noqa: E402


@pytest.fixture(scope="module")
def workers(tmp_path_factory):
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None,
                                  local_directory=str(tmp_path_factory.mktemp("dask"))) as made:
        yield made


@pytest.fixture(scope="module")
def client(workers):
    with distributed.Client(workers) as connected:
        yield connected


@pytest.fixture
def missions(tmp_path, monkeypatch):
    """Curves of many lengths; one whose robot is missing, one that is infeasible."""
    jp.Robot.example().save(tmp_path / "robot.yaml")
    lines = [{"robot": "robot.yaml", "legs": [{"path": {"bezier_m": [[[0, 0], [2, 0], [2, 1 + 0.1 * k], [4, 0.05 * k]]]}}]}
             for k in range(40)]
    lines[7]["robot"] = "none.yaml"
    lines[20]["legs"][0]["duration_s"] = 0.5
    (tmp_path / "missions.jsonl").write_text("".join(json.dumps(line) + "\n" for line in lines))
    monkeypatch.chdir(tmp_path)
    return "missions.jsonl"


def one_process(*words):
    done = subprocess.run([sys.executable, "-m", "joulepath", *map(str, words), "-j", "1", "--quiet", "--out", "one"])
    assert done.returncode in (0, 1)  # 1: a line of a batch cannot be read
    return pathlib.Path("one")


def assert_same(one, other, names=("results.jsonl", "report.html")):
    for name in names:
        assert (one / name).read_bytes() == (other / name).read_bytes(), name


def shard_processes(folder):
    """Processes of shards that run now: (pid, words of the command line)."""
    found = []
    for entry in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            words = (entry / "cmdline").read_text().split("\0")
        except OSError:
            continue
        if "joulepath.cluster" in words and any(str(folder) in word for word in words):
            found.append((int(entry.name), words))
    return found


class Repeated(threading.Thread):
    """Calls a function every 50 ms until the block ends."""

    def __init__(self, function):
        super().__init__()
        self.function, self.over = function, threading.Event()

    def run(self):
        while not self.over.wait(0.05):
            self.function()

    def __enter__(self):
        self.start()

    def __exit__(self, *_):
        self.over.set()
        self.join()


def test_a_batch_has_the_bytes_of_one_process(client, missions):
    one, seen = one_process("batch", missions), []
    found = cluster.run(missions, client, "many", shards=5, progress=lambda done, of: seen.append((done, of)))
    assert_same(one, found)
    assert seen == [(k, 5) for k in range(1, 6)]
    assert not pathlib.Path("many.shards").exists()
    with pytest.raises(jp.ConfigError, match="which exists"):
        cluster.run(missions, client, "many")


def test_a_sweep_has_the_bytes_of_one_process(client, missions, tmp_path):
    (tmp_path / "mission.yaml").write_text((tmp_path / missions).read_text().splitlines()[0])
    (tmp_path / "study.yaml").write_text("schema: joulepath/study/1\nmissions: mission.yaml\nparameters:\n"
                                         "  gear: {key: robot.motor.gear_ratio, from: 20, to: 30, count: 4}\n")
    one = one_process("sweep", "study.yaml", "--nodes", 40)
    found = cluster.run("study.yaml", client, tmp_path / "many", shards=6, options=("--nodes", "40"))
    assert_same(one, found, ("sweep.csv", "sweep.json", "report.html"))


def test_workers_killed_at_random_change_nothing(workers, client, missions, tmp_path):
    slow = ("--nodes", "500", "--no-cache")
    one = one_process("batch", missions, *slow)
    chance, killed = random.Random(4), []

    def kill():
        if chance.random() < (0.05 if killed else 0.3) and len(killed) < 8:
            pid = chance.choice([nanny.pid for nanny in workers.workers.values()])
            if pid is not None:
                os.kill(pid, signal.SIGKILL)
                killed.append(pid)

    with Repeated(kill):
        found = cluster.run(missions, client, "many", shards=10, options=slow)
    assert killed
    assert_same(one, found)
    assert not shard_processes(tmp_path)


def test_a_mission_that_kills_its_process_is_set_aside(client, missions, tmp_path):
    """What the system's out-of-memory killer does: the process of mission 5 dies each time that it plans it."""
    target, quarantine = 5, tmp_path / "many.shards" / "2" / "quarantine.jsonl"
    lines = [json.loads(line) for line in (tmp_path / missions).read_text().splitlines()]
    one = [json.loads(line) for line in (one_process("batch", missions, "--nodes", 100) / "results.jsonl").open()]
    lines[target]["legs"] *= 60  # takes long
    (tmp_path / missions).write_text("".join(json.dumps(line) + "\n" for line in lines))
    journal, killed = tmp_path / "many.shards" / "2" / "results.partial.jsonl", []

    def kill():
        if journal.exists() and journal.read_text().count('\n{"index"') == 1 and not quarantine.read_text():
            for pid, words in shard_processes(tmp_path):
                if "2/4" in words and pid not in killed:
                    os.kill(pid, signal.SIGKILL)
                    killed.append(pid)

    with Repeated(kill):
        found = cluster.run(missions, client, "many", shards=4, options=("--nodes", "100", "--no-cache"))
    assert len(killed) == 2
    got = [json.loads(line) for line in (found / "results.jsonl").read_text().splitlines()]
    assert [line["index"] for line in got if line["status"] == "quarantined"] == [target]
    assert got[target]["message"] == "killed its process by SIGKILL, 2 times"
    assert [line for line in got if line["index"] != target] == [line for line in one if line["index"] != target]


def test_a_memory_bomb_hits_itself_alone(client, missions, tmp_path):
    size = 9_000
    with open(tmp_path / "map.pgm", "wb") as image:
        image.write(b"P5\n%d %d\n255\n" % (size, size))
        image.write(b"\xff" * size * size)
    (tmp_path / "map.yaml").write_text("image: map.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\n"
                                       "occupied_thresh: 0.65\nfree_thresh: 0.2\n")
    bomb = {"robot": "robot.yaml", "map": "map.yaml", "stations": {"a": {"x_m": 5, "y_m": 5}, "b": {"x_m": 9, "y_m": 9}},
            "start": {"station": "a"}, "legs": [{"to": "b"}]}
    (tmp_path / missions).write_text((tmp_path / missions).read_text().splitlines()[0] + "\n" + json.dumps(bomb) + "\n")
    found = cluster.run(missions, client, "many", shards=2, memory_MiB=800)
    good, bad = [json.loads(line) for line in (found / "results.jsonl").open()]
    assert good["status"] == "optimal"
    assert (bad["status"], bad["message"]) == ("environment_error", "not enough memory")


def other_build():
    from joulepath import cluster as of_worker

    of_worker.build_id = lambda: "0.0.9"


def test_a_worker_of_another_version_is_refused(workers, missions):
    with distributed.LocalCluster(n_workers=1, threads_per_worker=1, processes=True, dashboard_address=None) as made:
        with distributed.Client(made) as client:
            client.run(other_build)
            with pytest.raises(cluster.ClusterError, match="workers with another build of joulepath than"):
                cluster.run(missions, client, "many")
            assert not pathlib.Path("many").exists() and not pathlib.Path("many.shards").exists()
            shard = cluster._Shard(1, 1, ("batch", missions), os.getcwd(), pathlib.Path("x"), 0, cluster.build_id())
            with pytest.raises(cluster.ClusterError, match="a worker has joulepath 0.0.9"):
                client.submit(cluster._run_shard, shard).result()


def test_an_interrupted_run_ends_its_processes_and_continues(client, missions, tmp_path):
    def stop(done, of):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        cluster.run(missions, client, "many", shards=8, progress=stop)
    while shard_processes(tmp_path):
        pass
    assert not pathlib.Path("many").exists() and pathlib.Path("many.shards").exists()
    with pytest.raises(jp.ConfigError, match="many.shards, which exists"):  # it would be deleted
        cluster.run(missions, client, "many")
    with pytest.raises(jp.ConfigError, match="with as many shards"):
        cluster.run(missions, client, "many", shards=3, resume=True)
    found = cluster.run(missions, client, "many", resume=True)
    assert_same(one_process("batch", missions), found)


def test_one_shard_is_a_run_too(client, missions):
    assert_same(one_process("batch", missions), cluster.run(missions, client, "many", shards=1))


@pytest.mark.parametrize("wrong, said", [
    ({"shards": 0}, "shards: found 0, accepted: a whole number from 1"),
    ({"shards": True}, "shards: found True"),
    ({"shards": 2.0}, "shards: found 2.0"),
    ({"memory_MiB": -1}, "memory_MiB: found -1, accepted: a whole number from 0"),
    ({"memory_MiB": "800"}, "memory_MiB: found '800'"),
    ({"resume": 1}, "resume: found 1, accepted: True or False"),
    ({"progress": 3}, "progress: found 3, accepted: a function"),
    ({"client": None}, "client: found a value of type NoneType, accepted: a distributed.Client"),
    ({"study": 3}, "study: found a value of type int"),
    ({"study": "none.jsonl"}, "none.jsonl"),
    ({"out": None}, "out: found a value of type NoneType"),
    ({"options": "--nodes 100"}, "options: found '--nodes 100', accepted: words"),
    ({"options": ("--nodes", 100)}, "options.1.: found 100, accepted: a string"),
    ({"options": ("--nodes", "1")}, "--nodes"),
    ({"options": ("--out", "elsewhere")}, "--out"),
    ({"options": ("--shard", "1/2")}, "--shard"),
    ({"options": ("--quarantine", "held.jsonl")}, "--quarantine"),
])
def test_a_wrong_argument_is_refused_before_anything_is_written(client, missions, tmp_path, wrong, said):
    before = sorted(tmp_path.rglob("*"))
    arguments = {"study": missions, "client": client, "out": "many", **wrong}
    with pytest.raises(jp.ConfigError, match=said):
        cluster.run(**arguments)
    assert sorted(tmp_path.rglob("*")) == before


def test_a_client_that_cannot_run_tasks_is_refused(client, missions, tmp_path):
    closed = distributed.Client(client.scheduler.address)
    closed.close()
    with pytest.raises(jp.ConfigError, match="client: found a client that is closed"):
        cluster.run(missions, closed, "many")
    with distributed.LocalCluster(n_workers=0, processes=True, dashboard_address=None) as empty:
        with distributed.Client(empty) as idle, pytest.raises(jp.ConfigError, match="client: found a cluster without workers"):
            cluster.run(missions, idle, "many")
    assert not (tmp_path / "many.shards").exists()
