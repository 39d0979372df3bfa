"""Bags that other programs wrote are read as those programs read them; bags that joulepath writes are read by them."""
import json
import subprocess
import zlib

import numpy as np
import pytest

import joulepath as jp

START_NS = 1_700_000_000_000_000_000


def record(file, compression, seconds=40.0):
    """A drive with real message definitions; gives its columns."""
    rosbags = pytest.importorskip("rosbags.typesys")
    writer_of = pytest.importorskip("mcap.writer")
    store = rosbags.get_typestore(rosbags.Stores.ROS2_HUMBLE)
    types = store.types
    t = np.arange(0, seconds, 0.02)
    v = 0.4 * np.sin(0.3 * t) ** 2
    w = 0.5 * np.sin(0.2 * t)

    def header(k):
        total = START_NS + int(round(t[k] * 1e9))
        stamp = types["builtin_interfaces/msg/Time"](sec=total // 10**9, nanosec=total % 10**9)
        return types["std_msgs/msg/Header"](stamp=stamp, frame_id="odom")

    def vector(x=0.0, y=0.0, z=0.0):
        return types["geometry_msgs/msg/Vector3"](x=x, y=y, z=z)

    covariance = np.zeros(36)
    with open(file, "wb") as stream:
        writer = writer_of.Writer(stream, compression=getattr(writer_of.CompressionType, compression), chunk_size=50_000)
        writer.start(profile="ros2")
        channels = {}
        for topic, name in (("/odom", "nav_msgs/msg/Odometry"), ("/joint_states", "sensor_msgs/msg/JointState")):
            definition, _ = store.generate_msgdef(name, ros_version=2)
            schema = writer.register_schema(name, "ros2msg", definition.encode())
            channels[topic] = writer.register_channel(topic, "cdr", schema)
        for k in range(len(t)):
            pose = types["geometry_msgs/msg/PoseWithCovariance"](
                pose=types["geometry_msgs/msg/Pose"](
                    position=types["geometry_msgs/msg/Point"](x=float(t[k]), y=0.0, z=0.0),
                    orientation=types["geometry_msgs/msg/Quaternion"](x=0.0, y=0.0, z=0.0, w=1.0)), covariance=covariance)
            twist = types["geometry_msgs/msg/TwistWithCovariance"](
                twist=types["geometry_msgs/msg/Twist"](linear=vector(x=v[k]), angular=vector(z=w[k])), covariance=covariance)
            odometry = types["nav_msgs/msg/Odometry"](header=header(k), child_frame_id="base_link", pose=pose, twist=twist)
            joints = types["sensor_msgs/msg/JointState"](
                header=header(k), name=["arm", "wheel_right_joint", "wheel_left_joint"], position=np.zeros(3),
                velocity=np.array([9.0, (v[k] + 0.165 * w[k]) / 0.1, (v[k] - 0.165 * w[k]) / 0.1]),
                effort=np.array([0.0, 1.0 + v[k], 1.1 + v[k]]))
            time_ns = START_NS + int(round(t[k] * 1e9)) + 2_000_000
            for topic, message, name in (("/odom", odometry, "nav_msgs/msg/Odometry"),
                                         ("/joint_states", joints, "sensor_msgs/msg/JointState")):
                writer.add_message(channels[topic], time_ns, bytes(store.serialize_cdr(message, name)), time_ns)
        writer.finish()
    return {"time_s": np.array([(START_NS + int(round(x * 1e9))) // 10**9 + 1e-9 * ((START_NS + int(round(x * 1e9))) % 10**9)
                                for x in t]),
            "wheel_speed_left_rad_s": (v - 0.165 * w) / 0.1, "wheel_speed_right_rad_s": (v + 0.165 * w) / 0.1,
            "linear_speed_m_s": v, "angular_speed_rad_s": w, "position_x_m": t, "position_y_m": 0 * t, "heading_rad": 0 * t,
            "motor_current_left_A": 1.1 + v, "motor_current_right_A": 1.0 + v}


COLUMNS = {"wheel_speed_left_rad_s": {"from": "/joint_states.velocity[wheel_left_joint]"},
           "wheel_speed_right_rad_s": {"from": "/joint_states.velocity[wheel_right_joint]"},
           "motor_current_left_A": {"from": "/joint_states.effort[wheel_left_joint]"},
           "motor_current_right_A": {"from": "/joint_states.effort[2]", "offset": -0.1},
           "linear_speed_m_s": {"from": "/odom.twist.twist.linear.x"},
           "angular_speed_rad_s": {"from": "/odom.twist.twist.angular.z"},
           "position_x_m": {"from": "/odom.pose.pose.position.x"}, "position_y_m": {"from": "/odom.pose.pose.position.y"},
           "orientation_w": {"from": "/odom.pose.pose.orientation.w"},
           "orientation_z": {"from": "/odom.pose.pose.orientation.z"}}


@pytest.mark.parametrize("compression", ["NONE", "LZ4", "ZSTD"])
def test_a_diagnosis_from_bags_is_that_of_their_columns(robot, tmp_path, compression):
    frames, bags = [], []
    for k in range(3):
        bags.append(str(tmp_path / f"run_{k}.mcap"))
        frames.append(record(bags[-1], compression, seconds=30.0 + 5 * k))
    columns = dict(COLUMNS, motor_current_right_A={"from": "/joint_states.effort[wheel_right_joint]"})
    from_bags = jp.diagnose(robot, bags, columns=columns).json.to_dict()
    from_frames = jp.diagnose(robot, [jp.Run(frame, name=bag) for frame, bag in zip(frames, bags)]).json.to_dict()
    for answer in (from_bags, from_frames):
        answer.pop("artifacts")
    assert from_bags == from_frames


def test_check_lists_topics_and_proposes_a_dataset(program, tmp_path):
    record(tmp_path / "day.mcap", "ZSTD", seconds=4.0)
    done = subprocess.run([program, "check", "day.mcap"], capture_output=True, text=True, check=True, cwd=tmp_path)
    assert "400 messages" in done.stderr and "/joint_states: 200 messages" in done.stderr
    assert 'wheel_speed_left_rad_s: {from: "/joint_states.velocity[wheel_left_joint]"}' in done.stdout
    robot = jp.Robot.example()
    robot.save(tmp_path / "robot.yaml")
    assert "# payload_kg: 0" in done.stdout
    (tmp_path / "dataset.yaml").write_text(done.stdout)
    done = subprocess.run([program, "check", tmp_path / "dataset.yaml"], capture_output=True, text=True)
    assert done.returncode == 1 and "heading_rad dead" in done.stdout  # the recorded robot turns, its heading stays 0
    subprocess.run([program, "estimate", tmp_path / "day.mcap", "--robot", tmp_path / "robot.yaml"], check=True,
                   stdout=subprocess.DEVNULL)


def test_a_day_of_bags_is_one_dataset_that_works_where_it_is_saved(program, robot, tmp_path):
    (tmp_path / "day").mkdir()
    for k in range(2):
        record(tmp_path / "day" / f"run_{k}.mcap", "NONE", seconds=20.0 + k)
    robot.save(tmp_path / "robot.yaml")
    with open(tmp_path / "dataset.yaml", "w") as stream:
        subprocess.run([program, "check", "day/run_0.mcap", "day/run_1.mcap"], check=True, stdout=stream, stderr=subprocess.DEVNULL,
                       cwd=tmp_path)
    done = subprocess.run([program, "check", "--brief", "dataset.yaml"], capture_output=True, text=True, cwd=tmp_path)
    assert "dataset: 2 runs" in done.stdout, done.stdout + done.stderr


def test_columns_of_one_channel_leave_the_others_as_proposed(program, robot, tmp_path, monkeypatch):
    """In Python and in a dataset file."""
    monkeypatch.chdir(tmp_path)
    record("run.mcap", "NONE")
    columns = {"motor_current_left_A": {"from": "/joint_states.effort[wheel_left_joint]"},
               "motor_current_right_A": {"from": "/joint_states.effort[wheel_right_joint]"}}
    proposed, given = jp.diagnose(robot, ["run.mcap"]), jp.diagnose(robot, ["run.mcap"], columns=columns)
    assert "motor_current" in proposed.missing_channels and "motor_current" not in given.missing_channels
    told = [artifact for artifact in given.artifacts if "proposed" in artifact]
    assert len(told) == 1 and "wheel_speed_left_rad_s" in told[0] and "linear_speed_m_s" in told[0]
    robot.save("robot.yaml")
    (tmp_path / "dataset.yaml").write_text(json.dumps({"robot": "robot.yaml", "columns": columns, "runs": [{"file": "run.mcap"}]}))
    subprocess.run([program, "diagnose", "dataset.yaml", "--out", "out"], check=False, stdout=subprocess.DEVNULL)
    assert json.loads((tmp_path / "out/diagnosis.json").read_text()) == given.json.to_dict()


def test_a_truncated_bag_without_a_message_is_an_error(program, tmp_path):
    record(tmp_path / "day.mcap", "ZSTD", seconds=4.0)
    (tmp_path / "cut.mcap").write_bytes((tmp_path / "day.mcap").read_bytes()[:200])
    done = subprocess.run([program, "check", tmp_path / "cut.mcap"], capture_output=True, text=True)
    assert done.returncode == 2 and "no message" in done.stderr and done.stdout == ""


def test_an_exported_bag_is_read_by_others_and_by_joulepath(program, scenarios, tmp_path):
    reader = pytest.importorskip("mcap.reader")
    rosbags = pytest.importorskip("rosbags.typesys")
    (tmp_path / "path.csv").write_text("x_m,y_m\n0,0\n2,0\n4,1\n")
    file = scenarios / "robots" / "nomad_super_scout.yaml"
    subprocess.run([program, "export", tmp_path / "path.csv", "--robot", file, "--to", "bag", "--out", tmp_path / "plan.mcap"],
                   check=True, stdout=subprocess.DEVNULL)
    plan = jp.plan(tmp_path / "path.csv", robot=jp.Robot.load(file), solver="fast", baselines=False)
    store = rosbags.get_typestore(rosbags.Stores.ROS2_HUMBLE)
    speeds, poses = [], None
    with open(tmp_path / "plan.mcap", "rb") as stream:
        for schema, channel, message in reader.make_reader(stream).iter_messages():
            if channel.message_encoding == "cdr":
                decoded = store.deserialize_cdr(message.data, schema.name)
                if channel.topic == "/plan/odom":
                    speeds.append(decoded.twist.twist.linear.x)
                else:
                    poses = decoded.poses
    np.testing.assert_array_equal(speeds, plan.trajectory["linear_speed_m_s"])
    np.testing.assert_array_equal([p.pose.position.x for p in poses], plan.trajectory["position_x_m"])
    subprocess.run([program, "estimate", tmp_path / "plan.mcap", "--robot", file], check=True, stdout=subprocess.DEVNULL)


def test_a_simulated_log_is_read_by_others_as_a_bag(program, robot, tmp_path):
    reader = pytest.importorskip("mcap.reader")
    log = jp.simulate(jp.profile(robot, [[0, 0], [2, 0], [4, 1]], solver="fast"), seed=3)
    log.save(tmp_path / "run.csv")
    robot.save(tmp_path / "robot.yaml")
    subprocess.run([program, "export", tmp_path / "run.csv", "--robot", tmp_path / "robot.yaml", "--to", "bag", "--out",
                    tmp_path / "log.mcap"], check=True, stdout=subprocess.DEVNULL)
    power, types = [], set()
    with open(tmp_path / "log.mcap", "rb") as stream:
        for schema, channel, message in reader.make_reader(stream).iter_messages():
            types.add((channel.topic, schema.name))
            if channel.topic == "/log/power":
                power.append(json.loads(message.data))
    assert types == {("/log/path", "nav_msgs/msg/Path"), ("/log/odom", "nav_msgs/msg/Odometry"), ("/log/power", "joulepath/power/1")}
    for column in ("motor_current_left_A", "battery_voltage_V", "wheel_speed_right_rad_s"):
        np.testing.assert_array_equal([message[column] for message in power], log[column])


def test_the_index_of_an_exported_bag_is_that_of_another_reader(program, robot, tmp_path):
    """Counts, times and topics by the summary alone; messages by the index are those of a reader that ignores it."""
    reader, records = pytest.importorskip("mcap.reader"), pytest.importorskip("mcap.records")
    stream_reader = pytest.importorskip("mcap.stream_reader")
    log = jp.simulate(jp.profile(robot, [[0, 0], [8, 0]], time_s=60, solver="fast"), seed=3)
    log.save(tmp_path / "run.csv")
    robot.save(tmp_path / "robot.yaml")
    subprocess.run([program, "export", tmp_path / "run.csv", "--robot", tmp_path / "robot.yaml", "--to", "bag", "--out",
                    tmp_path / "log.mcap"], check=True, stdout=subprocess.DEVNULL)
    with open(tmp_path / "log.mcap", "rb") as stream:
        summary = reader.make_reader(stream, validate_crcs=True).get_summary()
    topics = {channel.topic: number for number, channel in summary.channels.items()}
    counts = summary.statistics.channel_message_counts
    rows = len(log["time_s"])
    assert {topic: counts[number] for topic, number in topics.items()} == {"/log/path": 1, "/log/odom": rows, "/log/power": rows}
    assert summary.statistics.message_count == 2 * rows + 1 and summary.statistics.chunk_count == len(summary.chunk_indexes) >= 3
    assert summary.statistics.message_end_time == max(chunk.message_end_time for chunk in summary.chunk_indexes)
    assert set(summary.schemas) == {channel.schema_id for channel in summary.channels.values()}
    with open(tmp_path / "log.mcap", "rb") as stream:  # checks the sums of all chunks
        read = list(stream_reader.StreamReader(stream, validate_crcs=True).records)
    linear = [(m.channel_id, m.log_time, m.data) for m in read if isinstance(m, records.Message)]
    with open(tmp_path / "log.mcap", "rb") as stream:
        indexed = reader.make_reader(stream, validate_crcs=True)
        for topic, number in topics.items():
            found = [(m.channel_id, m.log_time, m.data) for _, _, m in indexed.iter_messages(topics=[topic])]
            assert found == [message for message in linear if message[0] == number]
        last = list(indexed.iter_messages(topics=["/log/power"], starting_at=59 * 10**9, ending_before=60 * 10**9))
        assert len(last) == 50
    data = (tmp_path / "log.mcap").read_bytes()
    footer = records.Footer(*np.frombuffer(data[-28:-12], "<u8").tolist(), int.from_bytes(data[-12:-8], "little"))
    assert zlib.crc32(data[footer.summary_start:-12]) == footer.summary_crc


@pytest.mark.parametrize("compressed", [False, True])
def test_rosbag2_folders_of_sqlite_files_are_read(robot, tmp_path, compressed):
    """Without definitions, as ROS 2 Humble writes them; messages compressed one by one."""
    rosbag2 = pytest.importorskip("rosbags.rosbag2")
    typesys = pytest.importorskip("rosbags.typesys")
    store = typesys.get_typestore(typesys.Stores.ROS2_HUMBLE)
    types = store.types
    folder = tmp_path / "day"
    writer = rosbag2.Writer(folder, version=8)
    if compressed:
        writer.set_compression(rosbag2.CompressionMode.MESSAGE, rosbag2.CompressionFormat.ZSTD)
    with writer:
        connection = writer.add_connection("/odom", "nav_msgs/msg/Odometry", typestore=store)
        for k in range(300):
            time_ns = START_NS + k * 20_000_000
            stamp = types["builtin_interfaces/msg/Time"](sec=time_ns // 10**9, nanosec=time_ns % 10**9)
            zero = types["geometry_msgs/msg/Vector3"](x=0.0, y=0.0, z=0.0)
            message = types["nav_msgs/msg/Odometry"](
                header=types["std_msgs/msg/Header"](stamp=stamp, frame_id="odom"), child_frame_id="base",
                pose=types["geometry_msgs/msg/PoseWithCovariance"](
                    pose=types["geometry_msgs/msg/Pose"](position=types["geometry_msgs/msg/Point"](x=0.004 * k, y=0.0, z=0.0),
                                                         orientation=types["geometry_msgs/msg/Quaternion"](x=0.0, y=0.0, z=0.0, w=1.0)),
                    covariance=np.zeros(36)),
                twist=types["geometry_msgs/msg/TwistWithCovariance"](
                    twist=types["geometry_msgs/msg/Twist"](linear=types["geometry_msgs/msg/Vector3"](x=0.2, y=0.0, z=0.0), angular=zero),
                    covariance=np.zeros(36)))
            writer.write(connection, time_ns, store.serialize_cdr(message, "nav_msgs/msg/Odometry"))
    from_bag = jp.diagnose(robot, [str(folder)])
    assert from_bag.verdict == "too_little_data"
