"""The mistakes: what was done, by which edit, with which command, and the words of a good answer.

Words are regular expressions, without regard to case, within one line of the answer:
  a  the cause and the place: what is wrong, and the file's key, the station, or the log's channel
  b  the place or the cause
"""
import dataclasses
import math
import typing


@dataclasses.dataclass
class Mistake:
    kind: str
    what: str
    edit: typing.Callable
    command: str = ""
    a: str = ""
    b: str = ""
    code: str = ""  # of Python, instead of a command


def together(place, cause):
    """Both in one line."""
    return f"(?:(?:{place}).*(?:{cause})|(?:{cause}).*(?:{place}))"


PLAN = "plan mission.yaml --out out"
DIAGNOSE = "diagnose dataset.yaml --out out"
CHECK_DAY = "check dataset.yaml"


def value(file, old, new):
    return lambda folder: folder.replace(file, old, new)


def robots():
    yield Mistake("robot", "gear ratio inverted: wheel turns per motor turn",
                  value("robot.yaml", "gear_ratio: 24.9", "gear_ratio: 0.0402"), PLAN,
                  together("gear_ratio", "invers|invert|reciprocal|motor turns|turns per|1 ?/"), "gear_ratio")
    yield Mistake("robot", "winding resistance in milliohm",
                  value("robot.yaml", "resistance_ohm: 2.74", "resistance_ohm: 2740"), "check robot.yaml",
                  together("resistance_ohm", "milli|mohm|mΩ|stall current"), "resistance_ohm")
    yield Mistake("robot", "motor voltage ten times too high",
                  value("robot.yaml", "max_voltage_V: 24.0", "max_voltage_V: 240"), PLAN,
                  together("max_voltage_V", "battery|open_circuit"), "max_voltage_V")
    yield Mistake("robot", "a battery of 4.6 V for motors of 24 V",
                  value("robot.yaml", "open_circuit_voltage_V: 25.0", "open_circuit_voltage_V: 4.6"), PLAN,
                  together("open_circuit_voltage_V", "cell|max_voltage_V|motor"), "open_circuit_voltage_V")
    yield Mistake("robot", "footprint polygon crosses itself (bow tie)",
                  value("scenarios/robots/amr_150kg.yaml", "[-0.527, 0.296], [-0.527, -0.296]", "[-0.527, -0.296], [-0.527, 0.296]"),
                  "check scenarios/robots/amr_150kg.yaml", together("polygon_m", "cross|intersect|bow"), "polygon_m")
    yield Mistake("robot", "footprint in cm", value("robot.yaml", "{radius_m: 0.25}", "{radius_m: 25}"), PLAN,
                  together("footprint|radius_m", r"\bcm\b|centi|track|wheel|implausib"), "footprint|radius_m")
    yield Mistake("robot", "wheel diameter in place of the radius, with logs that show it",
                  value("robot.yaml", "wheel_radius_m: 0.1 ", "wheel_radius_m: 0.2 "), DIAGNOSE,
                  "wheel_radius|wheel radius", "does not describe this robot|wheel_speed")
    yield Mistake("robot", "whole track in place of half of it: wheels outside of the footprint",
                  value("robot.yaml", "half_track_m: 0.165", "half_track_m: 0.33"), "check robot.yaml",
                  together("half_track_m", "footprint|outline|whole|half of"), "half_track_m")
    yield Mistake("robot", "yaw inertia about the drawing's origin, ten times too large",
                  value("robot.yaml", "chassis_yaw_inertia_kg_m2: 0.5", "chassis_yaw_inertia_kg_m2: 5.0"), "check robot.yaml",
                  together("chassis_yaw_inertia_kg_m2", "footprint|outline|gyration|box|within"), "chassis_yaw_inertia_kg_m2")
    yield Mistake("robot", "voltage constant in rpm per volt",
                  value("robot.yaml", "voltage_constant_V_s_rad: 0.069", "voltage_constant_V_s_rad: 138"), "check robot.yaml",
                  together("voltage_constant_V_s_rad", "rpm|torque_constant"), "voltage constant.*rpm|voltage_constant_V_s_rad")
    yield Mistake("robot", "friction torque at the motor's shaft, not at the wheel",
                  value("robot.yaml", "{left: 0.373, right: 0.346}", "{left: 0.015, right: 0.0139}"), "check robot.yaml",
                  together("friction_torque_Nm", "wheel|gear|shaft"), "friction_torque_Nm")
    yield Mistake("robot", "battery capacity in ampere hours",
                  value("robot.yaml", "capacity_Wh: 240.0", "capacity_Wh: 9.6"), "check robot.yaml",
                  together("capacity_Wh", r"\bAh\b|ampere|hour|standby"), "capacity_Wh")
    yield Mistake("robot", "uncertainty in percent: 1.5 where 0.015 is meant",
                  value("robot.yaml", "{friction_torque_Nm: 0.015", "{friction_torque_Nm: 1.5"), DIAGNOSE,
                  together("uncertainty.friction_torque_Nm", "percent|%|relative|at most|between"), "uncertainty.friction_torque_Nm")
    yield Mistake("robot", "top speed in km/h: more than the motors' voltage allows",
                  value("robot.yaml", "  speed_m_s: 1.0", "  speed_m_s: 3.6"), "check robot.yaml",
                  together("limits.speed_m_s|[^_]speed_m_s", "voltage|reach|km/h"), "[^_]speed_m_s")
    yield Mistake("robot", "decimal comma within braces", value("robot.yaml", "standby_W: 10.0,", "standby_W: 10,0,"),
                  "check robot.yaml", together("power|standby_W", "comma|decimal"), r"robot.yaml:\d+:\d+.*power")


def missions():
    shelf = "shelf: {x_m: 10.5, y_m: 6.5}"
    yield Mistake("mission", "x and y of a stop swapped", value("mission.yaml", shelf, "shelf: {x_m: 6.5, y_m: 10.5}"), PLAN,
                  together("shelf|mission.yaml:8", "outside|swap|beyond"), "shelf|outside of the map")
    yield Mistake("mission", "heading in degrees", value("mission.yaml", "heading_rad: 0.0", "heading_rad: 90"), PLAN,
                  together("heading_rad", r"deg|\brad\b|2 ?pi|6\.28|3\.14"), "heading_rad|dock.*heading")
    yield Mistake("mission", "payload in grams", value("mission.yaml", "payload_kg: 8.25", "payload_kg: 8250"), PLAN,
                  together("payload_kg", "max_payload_kg|12 kg|gram"), "payload")
    yield Mistake("mission", "negative deadline", value("mission.yaml", "deadline_s: 90", "deadline_s: -90"), PLAN,
                  together("deadline_s", "-90"), "deadline")
    yield Mistake("mission", "deadline too early: 1.5 (minutes) for 90 s", value("mission.yaml", "deadline_s: 90", "deadline_s: 1.5"),
                  PLAN, r"fastest drive arrives .* after the deadline|deadline_s = \d", "deadline")
    yield Mistake("mission", "deadline of the second leg counted from its own start",
                  value("mission.yaml", "{to: dock, payload_kg: 8.25}", "{to: dock, payload_kg: 8.25, deadline_s: 40}"), PLAN,
                  together("deadline", "mission's start|counted from"), "leg 1.*deadline|deadline.*leg 1")
    yield Mistake("mission", "indented by a tab", value("mission.yaml", "  shelf:", "\tshelf:"), "check mission.yaml",
                  together(r"mission.yaml:\d+", r"\btabs?\b"), r"mission.yaml:\d+")
    yield Mistake("mission", "key misspelled", value("mission.yaml", "payload_kg: 8.25", "paylod_kg: 8.25"), PLAN,
                  together("paylod_kg", "mean payload_kg"), "paylod_kg")
    yield Mistake("mission", "goal inside a shelf", value("mission.yaml", shelf, "shelf: {x_m: 6.0, y_m: 5.4}"), PLAN,
                  together(r"shelf|6\.0*, 5\.4", "occupied|wall|not fit|obstacle|not free"), "shelf")
    yield Mistake("mission", "two stations of one name", value("mission.yaml", "  shelf:", "  dock:"), "check mission.yaml",
                  together("dock", "twice|duplicate|again|already|second"), "dock")
    yield Mistake("mission", "dwell in milliseconds", value("mission.yaml", "dwell_s: 20}", "dwell_s: 20000}"), PLAN,
                  together("dwell", "2000|5.6 h|deadline"), r"dwell")
    yield Mistake("mission", "a zone's speed in percent",
                  value("mission.yaml", "objective:", "speed_zones: [{leg: 0, from_m: 2, to_m: 5, speed_m_s: 50}]\nobjective:"), PLAN,
                  together(r"speed_zones\[0\]", r"above|limits|percent|no effect|does not"), "speed_zones")
    yield Mistake("map", "map without its image", lambda folder: folder.remove("map.pgm"), PLAN,
                  together(r"map.yaml:\d+", "map.pgm"), "map.pgm")
    yield Mistake("map", "resolution in cm: 5", value("map.yaml", "resolution: 0.05", "resolution: 5"), PLAN,
                  together("resolution", "cm|met(?:re|er)|m per|accepted|footprint|coarse|robot"), "resolution")
    yield Mistake("map", "resolution 0.5: a map ten times too large", value("map.yaml", "resolution: 0.05", "resolution: 0.5"), PLAN,
                  together("resolution", "met(?:re|er)|m per|accepted|footprint|coarse|robot"), "resolution")
    yield Mistake("map", "negate: 1 on an image with dark walls", value("map.yaml", "negate: 0", "negate: 1"), PLAN,
                  "negate", "map.yaml|occupied")
    yield Mistake("map", "origin's yaw in degrees", value("map.yaml", "[0.0, 0.0, 0.0]", "[0.0, 0.0, 90]"), PLAN,
                  together("origin", "deg|rad|yaw"), "origin|yaw")


def semicolons(text):
    return text.replace(",", ";")


def decimal_commas(text):
    return text.replace(",", ";").replace(".", ",")


def scaled(factor, *words):
    def change(columns):
        for name in columns:
            if any(word in name for word in words):
                columns[name] = [factor * x for x in columns[name]]
    return lambda folder: folder.columns(change)


def swapped(columns):
    left, right = "wheel_speed_left_rad_s", "wheel_speed_right_rad_s"
    columns[left], columns[right] = columns[right], columns[left]


def ticks(columns):
    for name in ("wheel_speed_left_rad_s", "wheel_speed_right_rad_s"):
        angle, counts, before = 0.0, [], columns["time_s"][0]
        for t, w in zip(columns["time_s"], columns[name]):
            angle, before = angle + w * (t - before), t
            counts.append(round(angle * 2000 * 24.9 / (2 * math.pi)))
        columns[name] = counts


def late_currents(columns):
    rows = round(2 / (columns["time_s"][1] - columns["time_s"][0]))
    for name in columns:
        if name.startswith("motor_"):
            columns[name] = columns[name][rows:] + [columns[name][-1]] * rows


def standing(columns):
    for name in columns:
        if name != "time_s":
            columns[name] = [columns[name][0]] * len(columns[name])
        if name.startswith("wheel_speed"):
            columns[name] = [0.0] * len(columns[name])


def odometry(columns):
    """The pose that the wheels alone state: radius 0.1 m, half track 0.165 m."""
    x, y, heading, before = 0.0, 0.0, 0.0, columns["time_s"][0]
    pose = {"position_x_m": [], "position_y_m": [], "heading_rad": []}
    for t, left, right in zip(columns["time_s"], columns["wheel_speed_left_rad_s"], columns["wheel_speed_right_rad_s"]):
        step_s, before = t - before, t
        heading += 0.1 * (right - left) / 0.33 * step_s
        x += 0.05 * (left + right) * math.cos(heading) * step_s
        y += 0.05 * (left + right) * math.sin(heading) * step_s
        for name, number in zip(pose, (x, y, heading)):
            pose[name].append(number)
    columns.update(pose)


def one_hertz(columns):
    step = round(1 / (columns["time_s"][1] - columns["time_s"][0]))
    for name in columns:
        columns[name] = columns[name][::step]


def magnitudes(columns):
    for name in ("motor_current_left_A", "motor_current_right_A"):
        columns[name] = [abs(x) for x in columns[name]]


def joined(folder):
    second = (folder.path / "run_02.csv").read_text().split("\n", 1)[1]
    folder.write("run_01.csv", (folder.path / "run_01.csv").read_text() + second)


def logs():
    right = "causes?.*rolling_resistance|explained.*rolling_resistance"  # read rightly: nothing is lost
    yield Mistake("log", "columns separated by semicolons", lambda folder: folder.each_log(semicolons), DIAGNOSE,
                  together(r"run_\d+.csv", "semicolon|';'|\";\"|separat|delimit") + "|" + right, r"run_\d+.csv:1")
    yield Mistake("log", "semicolons and decimal commas, as a spreadsheet saves them",
                  lambda folder: folder.each_log(decimal_commas), DIAGNOSE,
                  together(r"run_\d+.csv", "decimal|comma|semicolon") + "|" + right, r"run_\d+.csv:\d")
    yield Mistake("log", "stamps in ms", scaled(1000, "time_s"), CHECK_DAY,
                  together("time_s", r"\bms\b|milli|scale: (?:1e-0?3|1\.0e-3|0\.001)"), "time_s")
    yield Mistake("log", "wheel columns swapped", lambda folder: folder.columns(swapped), CHECK_DAY,
                  together("wheel_speed", "swap"), "wheel_speed|swap")
    yield Mistake("log", "the right wheel's sign reversed", scaled(-1, "wheel_speed_right"), CHECK_DAY,
                  together("wheel_speed_right_rad_s", "invert|sign|negat|scale: -1"), "wheel_speed_right")
    yield Mistake("log", "counts of the encoders as wheel speeds", lambda folder: folder.columns(ticks), CHECK_DAY,
                  "(?s)^(?!.* dead[.]).*" + together("wheel_speed_(?:left|right)_rad_s", "tick|count|encoder|angle|derivative"), "wheel_speed")
    yield Mistake("log", "currents in mA", scaled(1000, "motor_current"), CHECK_DAY,
                  together("motor_current", r"\bmA\b|milli|scale: (?:1e-0?3|1\.0e-3|0\.001)"), "motor_current")
    yield Mistake("log", "motor driver's log two seconds late, joined by row", lambda folder: folder.columns(late_currents), CHECK_DAY,
                  together("motor_current|motor_voltage|wheel_speed", r"delay|late\b|clock|shift|offset in time|seconds|2\.0+ s"),
                  "motor_current|motor_voltage|time_misalignment|delay")
    yield Mistake("log", "one empty log", lambda folder: folder.write("run_03.csv", ""), DIAGNOSE,
                  together("run_03.csv", "empty|no header|no rows|0 rows|nothing"), "run_03.csv")
    yield Mistake("log", "logs of a standing robot", lambda folder: folder.columns(standing), DIAGNOSE,
                  "no motion|no run moves|never moves?|does not move|no wheel turns", "too_little_data")
    yield Mistake("dataset", "another robot's file", value("dataset.yaml", "robot: robot.yaml", "robot: scenarios/robots/kobuki.yaml"),
                  DIAGNOSE, "another robot|does not describe this robot: .*(?:mass|resistance|gear|track|speed|inertia) ", "unexplained|constant")
    yield Mistake("log", "two runs in one file: the time starts again", joined, CHECK_DAY,
                  together(r"run_01.csv:\d+", "increase|backward|again|after"), "run_01.csv")
    yield Mistake("dataset", "one log listed twice, with another payload",
                  value("dataset.yaml", "file: run_02.csv", "file: run_01.csv"), CHECK_DAY,
                  together(r"dataset.yaml:\d+.*run_01.csv", "twice|already|again|same"), "run_01.csv")
    yield Mistake("log", "pose of the wheel odometry as localization", lambda folder: folder.columns(odometry), CHECK_DAY,
                  together("position|pose|heading", "wheels|odometry"), "position_|heading_rad|pose")
    yield Mistake("log", "logs at 1 Hz", lambda folder: folder.columns(one_hertz), DIAGNOSE,
                  r"\d ?Hz.*(?:20|rate|coarse|too|at least)|(?:rate|coarse|samples).*\d ?Hz|sample.*(?:rate|period|apart)",
                  "samples|too_little_data|rate")
    yield Mistake("log", "currents without their sign", lambda folder: folder.columns(magnitudes), CHECK_DAY,
                  together("motor_current", "unsigned|sign"), "motor_current")
    yield Mistake("log", "heading clockwise, as on a compass", scaled(-1, "heading_rad"), CHECK_DAY,
                  together("heading_rad", "invert|sign|clockwise|scale: -1"), "heading_rad")


NAV2 = """velocity_smoother:
  ros__parameters:
    max_velocity: 0.5
    max_accel: [2.5, 0.0, 3.2]
    max_decel: [-2.5, 0.0, -3.2]
"""
STUDY = """schema: joulepath/study/1
missions: mission.yaml
parameters:
  gear: {key: robot.motor.gear_ratio, from: 10, to: 40, count: 600}
  speed: {key: robot.limits.speed_m_s, from: 0.5, to: 1.2, count: 600}
objectives: {energy_J: minimize}
"""
LINES = """{"schema": "joulepath/mission/1", "robot": "robot.yaml", "legs": [{"motion": {"profile": "stand", "duration_s": 5}}]}
{"schema": "joulepath/mission/1", "robot": "robot.yaml", "legs": [{"motion": {"profile": "stand", "duration": 5}}]}
"""


def others():
    order, night = "scenarios/orders/warehouse_v2.json", "scenarios/fleets/night_shift.yaml"
    yield Mistake("VDA 5050", "maxSpeed of the edges in mm/s", lambda folder: folder.replace_all(order, '"maxSpeed": 0.5', '"maxSpeed": 500'),
                  f"plan {order} --robot robot.yaml --out out", together("maxSpeed", r"500|mm/s|above|limits"), "maxSpeed")
    yield Mistake("VDA 5050", "node positions in mm",
                  lambda folder: folder.write(order, in_millimeters((folder.path / order).read_text())),
                  f"plan {order} --robot robot.yaml --out out", together("node|edge|x:", r"\bmm\b|millim|long|km|10000|apart"), "node|edge")
    yield Mistake("route graph", "another map's route graph",
                  value("scenarios/missions/depot_round.yaml", "map: ../maps/depot.yaml",
                        "map: ../maps/depot.yaml\nroute_graph: ../maps/warehouse_graph.geojson"),
                  "plan scenarios/missions/depot_round.yaml --out out",
                  together("route_graph|warehouse_graph", "map|outside|occupied|not free"), "route_graph|warehouse_graph")
    yield Mistake("Nav2", "max_velocity of the velocity smoother as one number", lambda folder: folder.write("nav2.yaml", NAV2),
                  "init cart --from nav2.yaml", together(r"nav2.yaml:\d+.*max_velocity", r"list|three|sequence|array|numbers|\[x, y, theta\]"),
                  "max_velocity")
    yield Mistake("batch", "a robot file as the missions of a batch", lambda folder: None, "batch robot.yaml --out out",
                  together("robot.yaml", "robot file|missions?"), "robot.yaml")
    yield Mistake("batch", "check of .jsonl missions with a wrong key in the second line",
                  lambda folder: folder.write("missions.jsonl", LINES), "check missions.jsonl",
                  together("missions.jsonl:2", "duration"), "duration")
    yield Mistake("sweep", "a grid of 600 x 600 designs", lambda folder: folder.write("study.yaml", STUDY),
                  "sweep study.yaml --out out", together("360.?000", r"hours?|days?|latin_hypercube|at most|accepted"), "360.?000")
    yield Mistake("fleet", "a charger's power in kW", value(night, "power_W: 200", "power_W: 0.2"), f"fleet {night}",
                  together("power_W", "kW|standby|less than|at least"), "power_W")
    yield Mistake("fleet", "a shift in hours", value(night, "start: shelf_9,", "start: shelf_9, from_s: 0, to_s: 8,"), f"fleet {night}",
                  together("to_s|shift", r"hours?|\b8\b|short"), "to_s")
    yield Mistake("command", "waypoints of a lane in cm", lambda folder: folder.write("lane.csv", "x_m,y_m\n0,0\n200,0\n400,100\n600,100\n"),
                  "plan lane.csv --robot robot.yaml --out out", together("lane.csv|path", r"\bcm\b|centim|apart|m long|corners"), "lane.csv")
    yield Mistake("command", "an effect's size in percent", lambda folder: None,
                  "simulate mission.yaml --effect rolling_resistance:coefficient=1.5 --out out",
                  together("coefficient", r"1\.5"), "coefficient")
    yield Mistake("command", "plan of a robot file", lambda folder: None, "plan robot.yaml --out out",
                  together("robot.yaml", "robot file|joulepath/robot|mission"), "robot.yaml")
    python = "import joulepath as jp\nrobot = jp.Robot.load('robot.yaml')\n"
    yield Mistake("Python", "times in ms",
                  lambda folder: None, code=python + "print(jp.energy(robot, [0, 1000, 5000, 6000], [0, 0.5, 0.5, 0], [0, 0, 0, 0]).total_J)",
                  a=together(r"\bt\b|times", r"\bms\b|milli|seconds|apart"), b=r"\bt\b:|times")
    yield Mistake("Python", "waypoints as (2, N)", lambda folder: None,
                  code=python + "print(jp.profile(robot, [[0, 2, 4, 6], [0, 0, 1, 1]]).energy_J)",
                  a=together("xy", r"\(N, 2\)|shape|transpos"), b="xy|shape")


def in_millimeters(text):
    import re
    return re.sub(r'"(x|y)": (-?[\d.]+)', lambda found: f'"{found[1]}": {1000 * float(found[2])}', text)


def mistakes():
    yield from robots()
    yield from missions()
    yield from logs()
    yield from others()
