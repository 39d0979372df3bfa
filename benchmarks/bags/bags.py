"""CPU time and peak memory of the program on a day's bag.

usage: bags.py PROGRAM FOLDER HOURS RESULT.md HEADER
"""
import os
import pathlib
import re
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
DATASET = """schema: joulepath/dataset/1
robot: robot.yaml
columns:
  wheel_speed_left_rad_s: {from: "/joint_states.velocity[wheel_left_joint]"}
  wheel_speed_right_rad_s: {from: "/joint_states.velocity[wheel_right_joint]"}
  motor_current_left_A: {from: "/joint_states.effort[wheel_left_joint]"}
  motor_current_right_A: {from: "/joint_states.effort[wheel_right_joint]"}
  linear_speed_m_s: {from: "/odom.twist.twist.linear.x"}
  angular_speed_rad_s: {from: "/odom.twist.twist.angular.z"}
  battery_voltage_V: {from: "/battery.voltage"}
  battery_current_A: {from: "/battery.current", scale: -1}
  position_x_m: {absent: true}
  position_y_m: {absent: true}
  heading_rad: {absent: true}
runs:
  - {file: day.mcap, payload_kg: 0}
"""
STEPS = (("list the topics", ("check", "day.mcap"), ""),
         ("read all columns, check the data", ("check", "dataset.yaml", "--brief"), "10 s, 300 MiB"),
         ("diagnose", ("diagnose", "dataset.yaml", "--out", "diagnosis", "--force", "--quiet"), "30 s"))


def measured(words, folder):
    """CPU seconds and peak MiB of a command."""
    process = subprocess.Popen(words, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    told = process.stderr.read().decode()
    _, status, used = os.wait4(process.pid, 0)
    if status != 0:
        raise SystemExit(f"{words}: {told}")
    return used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


def prepare(program, folder, hours):
    """The bag of the day; gives its messages."""
    folder.mkdir(parents=True, exist_ok=True)
    subprocess.run([program, "init", "robot", "--quiet", "--force"], cwd=folder, check=True)
    text = (folder / "robot/robot.yaml").read_text()
    (folder / "robot.yaml").write_text(text)
    (folder / "dataset.yaml").write_text(DATASET)
    (folder / "path.csv").write_text("x_m,y_m\n0,0\n3,0\n5,1\n7,4\n4,6\n1,3\n")
    subprocess.run([program, "plan", "path.csv", "--robot", "robot.yaml", "--out", "plan", "--force", "--quiet"], cwd=folder, check=True)
    subprocess.run([program, "simulate", "plan", "--robot", "robot.yaml", "--out", "logs", "--force", "--quiet", "--sample-rate-Hz",
                    "100", "--effect", "rolling_resistance:coefficient=0.01"], cwd=folder, check=True)
    log = next((folder / "logs").glob("run_*.csv"))
    made = subprocess.run([sys.executable, HERE / "day.py", log, hours, folder / "day.mcap"], check=True, stdout=subprocess.PIPE)
    return int(made.stdout)


def main():
    program, folder, hours, result, header = sys.argv[1:]
    folder = pathlib.Path(folder).resolve()
    count = prepare(program, folder, hours)
    size_MiB = (folder / "day.mcap").stat().st_size / 2**20
    lines = ["# Bags of a day", "", header, f"Load average before the measurement: {os.getloadavg()[0]:.2f}.", "",
             f"{float(hours):g} hours of odometry and joint states at 100 Hz and battery at 10 Hz: {count:,} messages, {size_MiB:.0f} MiB "
             "of MCAP with zstd chunks (`benchmarks/bags/day.py`).", "",
             "| step | command | CPU, s | peak memory, MiB | target |", "|---|---|---:|---:|---|"]
    for name, words, target in STEPS:
        cpu_s, peak_MiB = measured([program, *words], folder)
        lines.append(f"| {name} | `joulepath {re.sub(' --force --quiet| --quiet', '', ' '.join(words))}` | {cpu_s:.1f} | {peak_MiB:.0f} | {target} |")
    pathlib.Path(result).write_text("\n".join(lines) + "\n", encoding="utf-8")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
