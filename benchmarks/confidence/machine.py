"""Machines of another family than the planner's model: constants of their own, friction that depends on the speed.

The equations are written out here from Newton's laws and share no code with the program. A machine tracks a motion exactly and
says which currents, voltages and joules that takes.
"""

import dataclasses

import numpy as np

GRAVITY = 9.80665
SAMPLE_s = 0.02


@dataclasses.dataclass(frozen=True)
class Machine:
    radius: float
    half_track: float
    chassis_kg: float
    wheel_kg: float
    yaw_inertia: float       # of the chassis, about the axle's middle
    payload_inertia_m2: float
    axle_inertia: float      # of a wheel with its rotor
    diameter_inertia: float
    gear: float
    ohm: float
    torque_constant: float
    viscous: float
    friction: tuple          # left, right: N m at high speed
    standby_W: float
    recovered: float         # share of negative power that comes back
    stribeck: float = 0.0    # more friction at standstill, relative
    stribeck_rad_s: float = 3.0

    def wheels(self, v, a, w, dw, payload_kg):
        """Currents (A) and voltages (V) of both wheels, an array of two rows each."""
        mass = self.chassis_kg + 2 * self.wheel_kg + payload_kg
        inertia = (self.yaw_inertia + self.payload_inertia_m2 * payload_kg
                   + 2 * (self.wheel_kg * self.half_track**2 + self.diameter_inertia))
        currents, voltages = [], []
        for sign, coulomb in zip((-1, 1), self.friction):
            push = 0.5 * mass * a + sign * 0.5 * inertia * dw / self.half_track
            speed = (v + sign * self.half_track * w) / self.radius
            gain = (a + sign * self.half_track * dw) / self.radius
            dry = coulomb * (1 + self.stribeck * np.exp(-np.abs(speed) / self.stribeck_rad_s))
            torque = self.radius * push + self.axle_inertia * gain + self.viscous * speed + dry * np.sign(speed)
            current = torque / (self.torque_constant * self.gear)
            currents.append(current)
            voltages.append(self.ohm * current + self.torque_constant * self.gear * speed)
        return np.array(currents), np.array(voltages)

    def energy_J(self, time_s, currents, voltages):
        """From the supply, standby included; each wheel's negative power counts by what comes back."""
        power = currents * voltages
        taken = np.where(power > 0, power, self.recovered * power).sum(axis=0) + self.standby_W
        return float(np.sum(0.5 * (taken[1:] + taken[:-1]) * np.diff(time_s)))


BASES = {  # round numbers about three robots of the repository, without an offset of the center of mass
    "nomad": Machine(0.1, 0.165, 21.2, 1.39, 0.5, 0.02, 0.0281, 0.007, 24.9, 2.74, 0.069, 0.0017, (0.37, 0.35), 10, 0.0),
    "amr": Machine(0.13, 0.25, 144, 3.0, 12.3, 0.03, 0.047, 0.013, 12.0, 0.3, 0.1135, 0.02, (2.0, 2.1), 60, 0.5),
    "tug": Machine(0.125, 0.32, 584, 8.0, 90, 0.05, 0.35, 0.03, 25.0, 0.35, 0.12, 0.06, (6.0, 6.2), 60, 0.4),
}
PAYLOAD_kg = {"nomad": 8.0, "amr": 60.0, "tug": 400.0}
SPEED_m_s = {"nomad": 0.8, "amr": 1.2, "tug": 1.2}


def true_machine(base, random):
    """A machine as built and worn: its file has the constants of the base."""
    def near(value, sigma):
        return value * float(np.exp(sigma * random.normal()))
    wear = near(1.0, 0.1)
    return dataclasses.replace(
        base, chassis_kg=near(base.chassis_kg, 0.02), yaw_inertia=near(base.yaw_inertia, 0.05), ohm=near(base.ohm, 0.04),
        torque_constant=near(base.torque_constant, 0.02), viscous=near(base.viscous, 0.2),
        friction=tuple(near(wear * f, 0.05) for f in base.friction), stribeck=float(random.uniform(0.0, 0.06)))


def robot_text(machine, name, max_current_A=None, max_voltage_V=1000.0, capacity_Wh=5000.0):
    """The robot file of a machine; the limits of motion are wide, so that the motors decide."""
    current = f", max_current_A: {max_current_A}" if max_current_A else ""
    return f"""schema: joulepath/robot/1
name: {name}
geometry: {{wheel_radius_m: {machine.radius}, half_track_m: {machine.half_track}}}
inertia: {{chassis_mass_kg: {machine.chassis_kg}, wheel_mass_kg: {machine.wheel_kg}, chassis_yaw_inertia_kg_m2: {machine.yaw_inertia}, payload_yaw_inertia_m2: {machine.payload_inertia_m2}, wheel_axle_inertia_kg_m2: {machine.axle_inertia}, wheel_diameter_inertia_kg_m2: {machine.diameter_inertia}}}
motor: {{gear_ratio: {machine.gear}, resistance_ohm: {machine.ohm}, torque_constant_Nm_A: {machine.torque_constant}, voltage_constant_V_s_rad: {machine.torque_constant}, viscous_friction_Nm_s_rad: {machine.viscous}, friction_torque_Nm: {{left: {machine.friction[0]}, right: {machine.friction[1]}}}, max_voltage_V: {max_voltage_V}{current}}}
limits: {{speed_m_s: 3, acceleration_m_s2: 5, deceleration_m_s2: 5, lateral_acceleration_m_s2: 2, yaw_rate_rad_s: 4, yaw_acceleration_rad_s2: 20, max_payload_kg: 1000}}
power: {{standby_W: {machine.standby_W}, regeneration_efficiency: {machine.recovered}}}
battery: {{capacity_Wh: {capacity_Wh}, open_circuit_voltage_V: 48, reserve_fraction: 0.1}}
footprint: {{radius_m: 0.3}}
"""


def ramp(top, gain, hold_s, turn=0.0):
    """Speed and yaw rate over time: a trapezoid between rests of one second."""
    rise_s = abs(top) / gain
    time_s = np.arange(0, 2 + 2 * rise_s + hold_s, SAMPLE_s)
    share = np.clip(np.minimum((time_s - 1) / rise_s, (time_s[-1] - 1 - time_s) / rise_s), 0, 1)
    v = top * share if turn == 0 else np.zeros_like(time_s)
    return time_s, v, turn * share


def day_motions(kind, random):
    """(motion, payload) of the runs of a test day: straights at several speeds and loads, turns, strong ramps."""
    top, load = SPEED_m_s[kind], PAYLOAD_kg[kind]
    runs = []
    for share, gain, payload in [(0.25, 0.3, 0), (0.5, 0.4, 0), (1.0, 0.5, 0), (1.0, 0.9, 0), (-0.5, 0.4, 0),
                                 (0.4, 0.4, load), (0.8, 0.6, load), (1.0, 0.9, load)]:
        for _ in range(2):
            runs.append((ramp(top * share, gain, float(random.uniform(6, 10))), payload))
    for turn, payload in [(0.8, 0), (-0.8, 0), (1.5, 0), (-1.5, load)]:
        for _ in range(2):
            runs.append((ramp(1.0, 0.8, 6.0, turn), payload))
    return runs


def log_text(machine, motion, payload_kg, random, scatter=0.01):
    """A log of one run: the friction of a run differs from that of the day, sensors have noise."""
    time_s, v, w = motion
    of_run = dataclasses.replace(machine, friction=tuple(f * (1 + scatter * random.normal()) for f in machine.friction))
    a, dw = np.gradient(v, time_s), np.gradient(w, time_s)
    currents, voltages = of_run.wheels(v, a, w, dw, payload_kg)
    moves = np.abs(v) + np.abs(w) > 1e-9
    currents, voltages = currents * moves, voltages * moves
    wheel = np.array([(v - machine.half_track * w), (v + machine.half_track * w)]) / machine.radius
    def noisy(values, sigma):
        return values + sigma * random.normal(size=values.shape)
    scale_A, scale_V = 0.01 * np.abs(currents).max() + 0.005, 0.003 * np.abs(voltages).max() + 0.005
    rows = np.vstack([time_s, noisy(wheel, 0.01), noisy(currents, scale_A), noisy(voltages, scale_V)]).T
    names = "time_s,wheel_speed_left_rad_s,wheel_speed_right_rad_s,motor_current_left_A,motor_current_right_A,motor_voltage_left_V,motor_voltage_right_V"
    return names + "\n" + "\n".join(",".join(f"{x:.6g}" for x in row) for row in rows) + "\n"


def write_day(folder, machine, base, kind, random):
    """A dataset whose robot file has the constants of the base; returns its file."""
    (folder / "robot.yaml").write_text(robot_text(base, kind))
    lines = ["schema: joulepath/dataset/1", "robot: robot.yaml", "runs:"]
    for k, (motion, payload) in enumerate(day_motions(kind, random)):
        (folder / f"run_{k:02}.csv").write_text(log_text(machine, motion, payload, random))
        use = ", use: validation" if k % 2 else ""
        lines.append(f"  - {{file: run_{k:02}.csv, payload_kg: {payload}{use}}}")
    (folder / "dataset.yaml").write_text("\n".join(lines) + "\n")
    return folder / "dataset.yaml"


def mission_legs(kind, random):
    """One or two legs, straight or bent, empty or loaded."""
    legs = []
    for _ in range(int(random.integers(1, 3))):
        length, bend = float(random.uniform(3, 9)), float(random.choice([0.0, 0.0, random.uniform(-0.25, 0.25)]))
        points = [[0, 0], [round(length / 3, 3), 0], [round(2 * length / 3, 3), round(bend * length / 2, 3)],
                  [round(length, 3), round(bend * length, 3)]]
        payload = float(random.choice([0.0, PAYLOAD_kg[kind] * round(float(random.uniform(0.2, 1.0)), 2)]))
        legs.append({"path": {"bezier_m": [points]}, "payload_kg": payload})
    return legs
