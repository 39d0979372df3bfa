"""The machine in motion: all runs of a day, and variants of the machine beside each other, step by step.

Each wheel has a rotor and a rim, joined by a gear with backlash and finite stiffness. A tyre builds its force up over a
relaxation length. The current follows its set point as behind a field-oriented current loop. A sampled speed controller
reads encoder counts and is released at rest. A lidar localizer corrects the way of tracked runs. Semi-implicit Euler steps;
dry friction is an impulse that takes what motion is left, at most its limit (a standing robot stands exactly).

Arrays have the shape (2, B): left and right wheel, runs times variants. Units are SI; wheel quantities are at the wheel.
"""
import numpy as np

from days import TICK_s, path_of
from machines import GRAVITY_m_s2

STEP_s = 0.001
STEPS_PER_TICK = round(TICK_s / STEP_s)
RECORD_STEPS = 10
CURRENT_LAG_s = 0.0008  # of the current loop: 200 Hz
LASH_rad = 0.0006  # half of the backlash at the wheel
SLIP_PER_LOAD, RELAXATION_m = 25.0, 0.04  # slip stiffness over load; relaxation length
LIDAR_LATENCY_s = 0.02
TRIM_s = 0.3  # of the smoother behind the path follower
DRIVER_LOSS = 0.002  # share of the motors' power that the driver's switching takes from the bus
SHARE_ON_ROTOR = 0.6  # of dry and viscous friction; the rest brakes the rim
OCV_SLOPE = 0.12  # relative fall of the open-circuit voltage over a full charge


class Batch:
    """Constants of all variants and runs as arrays, and the state that moves them."""

    def __init__(self, machines, runs, errors=None):
        """`machines`: variants; `runs`: of a day; `errors`: the localizer's (updates, 3, runs), m and rad."""
        self.machines, self.runs = machines, runs
        self.variants, self.count = len(machines), len(runs)
        self.steps = max(len(run["command"][0]) for run in runs) * STEPS_PER_TICK
        self.errors = errors
        self.constants()
        self.commands()
        self.rest()

    def per(self, key):
        """A constant for each column: (B,), or (2, B) where it has sides."""
        values = np.array([m[key] for m in self.machines], float)
        return np.repeat(values.T, self.count, axis=-1)

    def per_run(self, values):
        return np.tile(np.array(values, float), self.variants)

    def constants(self):
        for key in ("r", "K", "R", "nu", "T"):
            setattr(self, key, self.per(key))
        for key in ("l", "roll", "patch", "stribeck", "stribeck_w", "reverse", "loss", "scrub", "air", "grade", "uphill", "heat", "heat_s", "drop",
                    "teeth", "hose", "lag", "flat", "brake", "phase", "standby", "eta", "R_b", "U", "n", "Wh"):
            setattr(self, key, self.per(key))
        self.box = np.repeat(np.array([m["box"] for m in self.machines]).T, self.count, axis=-1)
        self.start_s = self.per_run([run["start_s"] for run in self.runs])
        self.T = self.T * self.per_run([run.get("friction_factor", 1.0) for run in self.runs])
        self.inertias()
        self.controller()

    def inertias(self):
        """Mass, yaw inertia about the axle's middle, first moment; rotor and rim; tyre and gear."""
        stated = self.per_run([run["load"] for run in self.runs])
        load, at = stated * self.per("load_factor"), self.per("d_p")
        m_c, m_w, d, l = self.per("m_c"), self.per("m_w"), self.per("d"), self.l
        self.m = m_c + 2 * m_w + load
        self.moment = m_c * d + load * at
        self.I = self.per("I_c") + self.per("k_p") * load + m_c * d**2 + load * at**2 + 2 * m_w * l**2 + 2 * self.per("I_d")
        self.I_rim = self.per("I_w")
        self.I_rotor = self.per("I_a") - self.I_rim
        self.load_N = self.m * GRAVITY_m_s2 / 2
        self.tyre_N_m = SLIP_PER_LOAD * self.load_N / RELAXATION_m
        self.tyre_damping = 0.04 * self.I_rim / self.r[0] ** 2 / STEP_s
        reduced = self.I_rim * self.I_rotor / self.per("I_a")
        self.gear_stiffness = reduced * 220.0**2
        self.gear_damping = 2 * 0.15 * reduced * 220.0

    def controller(self):
        """Gains of the speed loop, from the file's constants: 25 rad/s and an integrator of 6 rad/s."""
        m = self.machines[0]["file"]
        loads = self.per_run([run["load"] for run in self.runs])
        self.file = m
        self.J_file = m["I_a"] + (m["m_c"] + 2 * m["m_w"] + loads) * m["r"][0] ** 2 / 2
        self.gain = self.J_file * 25.0 / m["K"][0]
        self.integral_gain = self.gain * 6.0
        self.count_rad = 2 * np.pi / m["counts"]

    def commands(self):
        """Commanded speeds (ticks, runs) and the poses that they lead to."""
        ticks = self.steps // STEPS_PER_TICK
        self.v_ref, self.w_ref = np.zeros((ticks, self.count)), np.zeros((ticks, self.count))
        self.way = np.zeros((ticks, 3, self.count))
        for k, run in enumerate(self.runs):
            v, w = run["command"]
            self.v_ref[: len(v), k], self.w_ref[: len(w), k] = v, w
            path = np.array(path_of(run["command"], run["pose"]))
            self.way[: len(v), :, k], self.way[len(v):, :, k] = path.T, path[:, -1]
        moving = (np.abs(self.v_ref) + np.abs(self.w_ref)) > 1e-9
        started = np.zeros(self.count)
        self.since = np.zeros((ticks, self.count))  # seconds since the present motion was commanded
        for k in range(ticks):
            started = np.where(moving[k], started + TICK_s, 0.0)
            self.since[k] = started
        self.tracked = np.array([bool(run.get("tracked")) for run in self.runs])

    def rest(self):
        B = self.variants * self.count
        pair, one = lambda: np.zeros((2, B)), lambda: np.zeros(B)
        self.q_m, self.w_m, self.q_w, self.w_w = pair(), pair(), pair(), pair()
        self.i, self.i_set, self.bristle, self.wound = pair(), pair(), pair(), pair()
        self.estimate, self.w_set_before, self.counts_before = pair(), pair(), pair()
        self.still = one()
        self.v, self.w, self.driven = one(), one(), one()
        self.pose = np.tile(np.array([run["pose"] for run in self.runs], float).T, self.variants)
        self.heading_start = self.pose[2].copy()
        self.seen, self.snapshot = self.pose.copy(), self.pose.copy()
        self.trim_v, self.trim_w, self.asked_v, self.asked_w = one(), one(), one(), one()
        self.charge_used_J = self.standby * self.start_s
        self.sums = {key: pair() for key in ("i", "V", "E")}
        self.sums.update({key: one() for key in ("I_bat", "U_bat", "E_bat")})
        self.account = {key: one() for key in ("electrical", "copper", "friction", "tyre", "gear")}

    # ---- slow parts, once a tick
    def sides(self, v, w, l, r):
        """Wheel speeds of a body's speed and yaw rate."""
        return np.stack([v - l * w, v + l * w]) / r

    def control(self, tick):
        file = self.file
        v = np.tile(self.v_ref[tick], self.variants) + self.trim_v
        w = np.tile(self.w_ref[tick], self.variants) + self.trim_w
        target = self.sides(v, w, file["l"], file["r"][0])
        counts = np.floor(self.q_m / self.count_rad)
        raw = (counts - self.counts_before) * self.count_rad / TICK_s
        self.counts_before = counts
        self.estimate += 0.5 * (raw - self.estimate)
        self.set_current(target, (target - self.w_set_before) / TICK_s)
        self.w_set_before = target

    def set_current(self, target, rise):
        """Speed PI with feed-forward of the file's inertia and friction; released after 0.2 s of standstill."""
        file = self.file
        error = target - self.estimate
        ahead = self.J_file * np.clip(rise, -40, 40) + np.array(file["T"])[:, None] * np.tanh(target / 0.05) + file["nu"][0] * target
        self.wound = np.clip(self.wound + self.integral_gain * error * TICK_s, -file["i_max"], file["i_max"])
        wanted = ahead / file["K"][0] + self.gain * error + self.wound
        stands = np.all(target == 0, axis=0) & np.all(np.abs(self.estimate) < 0.02, axis=0)
        self.still = np.where(stands, self.still + TICK_s, 0.0)
        free = self.still > 0.2
        self.wound = np.where(free, 0.0, self.wound)
        self.i_set = np.where(free, 0.0, np.clip(wanted, -file["i_max"], file["i_max"]))

    def localize(self, tick):
        """Snapshots and, a latency later, published poses; at each one a tracked run's commands are trimmed."""
        period, late = round(self.file["lidar_s"] / TICK_s), round(LIDAR_LATENCY_s / TICK_s)
        if tick % period == 0:
            self.snapshot = self.pose.copy()
        if tick % period == late and tick >= late:
            update = tick // period
            self.seen = self.snapshot.copy()
            if self.errors is not None:
                self.seen += np.tile(self.errors[update], self.variants)
            self.track(tick)

    def track(self, tick):
        """Kanayama's law around the commanded way, only while a motion is commanded."""
        x, y, heading = (np.tile(self.way[tick, k], self.variants) for k in range(3))
        dx, dy = x - self.seen[0], y - self.seen[1]
        along = np.cos(self.seen[2]) * dx + np.sin(self.seen[2]) * dy
        across = -np.sin(self.seen[2]) * dx + np.cos(self.seen[2]) * dy
        turned = np.remainder(heading - self.seen[2] + np.pi, 2 * np.pi) - np.pi
        v, w = np.tile(self.v_ref[tick], self.variants), np.tile(self.w_ref[tick], self.variants)
        active = np.tile(self.tracked, self.variants) & ((np.abs(v) > 0.05) | (np.abs(w) > 0.05))
        self.asked_v = np.where(active & (np.abs(v) > 0.05), np.clip(0.4 * along, -0.05, 0.05), 0.0)
        self.asked_w = np.where(active, np.clip(1.5 * v * across + 0.8 * turned, -0.15, 0.15), 0.0)

    def smooth_trim(self, tick):
        """Trims pass a smoother of 0.3 s, so that no step of a pose becomes a step of the speed; none at rest."""
        self.trim_v += (self.asked_v - self.trim_v) * TICK_s / TRIM_s
        self.trim_w += (self.asked_w - self.trim_w) * TICK_s / TRIM_s
        rests = np.tile((self.v_ref[tick] == 0) & (self.w_ref[tick] == 0), self.variants)
        for trim in (self.trim_v, self.trim_w, self.asked_v, self.asked_w):
            trim[rests] = 0.0

    def slow(self, tick):
        """What changes slowly: commands, windings, tyres, floor, brake, open-circuit voltage."""
        self.localize(tick)
        self.smooth_trim(tick)
        self.control(tick)
        warm = 1 + self.heat * (1 - np.exp(-(self.start_s + tick * TICK_s) / self.heat_s))
        weak = np.stack([1 + self.phase * (1 + np.cos(10 * self.n * self.q_m[0])), np.ones_like(self.phase)])
        self.R_now = self.R * warm * weak
        gone = self.flat * np.minimum(1.0, (self.start_s + self.driven) / 400.0)
        self.r_now = np.stack([self.r[0] * (1 - gone), self.r[1]])
        self.roll_now = np.stack([self.roll + 0.3 * gone, self.roll]) + self.patch * self.inside()
        early = np.tile((self.since[tick] > 0) & (self.since[tick] < 0.8), self.variants)
        self.brake_now = self.brake * early
        self.ocv = self.U * (1 - OCV_SLOPE * self.charge_used_J / (3600 * self.Wh))

    def inside(self):
        x, y = self.pose[0], self.pose[1]
        return (x >= self.box[0]) & (x <= self.box[1]) & (y >= self.box[2]) & (y <= self.box[3])

    # ---- one step
    def rotor_limits(self, torque):
        """Friction torque that brakes the rotor: its share of the dry one, the gear's loss, loaded teeth."""
        limit = SHARE_ON_ROTOR * self.T + self.loss * np.abs(torque)
        if self.teeth.any():
            peak = self.J_file * self.file["a"] / self.file["r"][0] + self.file["T"][0]
            part = self.teeth * np.minimum(1.0, np.abs(torque) / peak)
            limit = limit + part * np.abs(torque) * (1 + 0.5 * np.sin(23 * self.q_m))
        return limit

    def rim_limits(self):
        """Friction torque that brakes the rim: dry, rolling, at low speed, backward, the brake."""
        limit = (1 - SHARE_ON_ROTOR) * self.T + self.roll_now * self.load_N * self.r_now + self.brake_now
        if self.stribeck.any():
            limit = limit + self.stribeck * np.exp(-((self.w_w / self.stribeck_w) ** 2))
        return limit + self.reverse * (self.w_w < 0) if self.reverse.any() else limit

    @staticmethod
    def braked(speed, limit):
        """The speed after a friction impulse of at most `limit` (in the speed's unit), and the change."""
        change = np.clip(-speed, -limit, limit)
        return speed + change, change

    def step(self):
        h = STEP_s
        self.i += (1 - np.exp(-h / CURRENT_LAG_s)) * (self.i_set - self.i)
        K = self.K * np.cos(self.lag * self.w_m) if self.lag.any() else self.K
        torque = K * self.i
        gear, gear_elastic = self.gear_torque()
        w_m = self.w_m + h / self.I_rotor * (torque - gear - SHARE_ON_ROTOR * self.nu * self.w_m)
        w_m, jolt_m = self.braked(w_m, h / self.I_rotor * self.rotor_limits(torque))
        ground = np.stack([self.v - self.l * self.w, self.v + self.l * self.w])
        slip = self.r_now * self.w_w - ground
        self.bristle = (self.bristle + h * slip) / (1 + h * np.abs(ground) / RELAXATION_m)
        force = self.tyre_N_m * self.bristle + self.tyre_damping * slip
        w_w = self.w_w + h / self.I_rim * (gear - self.r_now * force - (1 - SHARE_ON_ROTOR) * self.nu * self.w_w)
        w_w, jolt_w = self.braked(w_w, h / self.I_rim * self.rim_limits())
        v, w = self.body(force)
        self.electrical(K, h)
        self.audit(torque, gear, gear_elastic, force, slip, jolt_m, jolt_w, w_m, w_w)
        self.advance(w_m, w_w, v, w)

    def gear_torque(self):
        """Torque from rotor to rim, and its elastic part, behind the backlash."""
        twist = self.q_m - self.q_w
        wound = twist - np.clip(twist, -LASH_rad, LASH_rad)
        elastic = self.gear_stiffness * wound
        return elastic + self.gear_damping * (self.w_m - self.w_w) * (wound != 0), elastic

    def body(self, force):
        """Speed and yaw rate after the step; dry resistances of the body are impulses as well."""
        h, along, around = STEP_s, force[0] + force[1], self.l * (force[1] - force[0])
        if self.air.any():
            along = along - self.air * self.v * np.abs(self.v)
        if self.grade.any():
            along = along - self.m * GRAVITY_m_s2 * self.grade * np.cos(self.pose[2] - self.uphill)
            around = around - self.moment * GRAVITY_m_s2 * self.grade * np.sin(self.uphill - self.pose[2])
        v = self.v + h / self.m * (along + self.moment * self.w**2)
        w = self.w + h / self.I * (around - self.moment * self.v * self.w)
        if self.hose.any():
            pull = self.hose * np.exp(np.minimum(0.5 * np.abs(self.pose[2] - self.heading_start), 2.0))
            v = self.braked(v, h / self.m * pull)[0]
        return v, self.braked(w, h / self.I * self.scrub)[0] if self.scrub.any() else w

    def electrical(self, K, h):
        """Voltages, powers and the battery; sums over time."""
        V = self.R_now * self.i + K * self.w_m
        terminal = V + self.drop * np.tanh(self.i / 0.01)
        P = terminal * self.i
        bus = self.standby + np.sum(np.maximum(P, self.eta * P) + DRIVER_LOSS * np.abs(P), axis=0)
        I = (self.ocv - np.sqrt(self.ocv**2 - 4 * self.R_b * bus)) / (2 * self.R_b)
        self.charge_used_J += h * self.ocv * I
        for key, value in (("i", self.i), ("V", terminal), ("E", P), ("I_bat", I), ("U_bat", self.ocv - self.R_b * I), ("E_bat", bus)):
            self.sums[key] += h * value

    def audit(self, torque, gear, elastic, force, slip, jolt_m, jolt_w, w_m, w_w):
        """Where the energy went, J: each force times the mean speed of the step."""
        h, rotor, rim = STEP_s, (self.w_m + w_m) / 2, (self.w_w + w_w) / 2
        a = self.account
        a["electrical"] += h * np.sum(self.R_now * self.i**2 + torque * rotor, axis=0)
        a["copper"] += h * np.sum(self.R_now * self.i**2, axis=0)
        viscous = SHARE_ON_ROTOR * self.w_m * rotor + (1 - SHARE_ON_ROTOR) * self.w_w * rim
        a["friction"] += np.sum(h * self.nu * viscous - self.I_rotor * jolt_m * rotor - self.I_rim * jolt_w * rim, axis=0)
        a["tyre"] += h * np.sum(force * slip, axis=0)
        a["gear"] += h * np.sum((gear - elastic) * (rotor - rim), axis=0)

    def advance(self, w_m, w_w, v, w):
        h = STEP_s
        self.q_m, self.q_w = self.q_m + h * w_m, self.q_w + h * w_w
        heading = self.pose[2] + h * (self.w + w) / 2
        middle, speed = (self.pose[2] + heading) / 2, (self.v + v) / 2
        self.pose = np.stack([self.pose[0] + h * speed * np.cos(middle), self.pose[1] + h * speed * np.sin(middle), heading])
        self.driven = self.driven + h * np.abs(speed)
        self.w_m, self.w_w, self.v, self.w = w_m, w_w, v, w

    def kinetic_J(self):
        """Energy of rotors, rims and body."""
        rotating = np.sum(self.I_rotor * self.w_m**2 + self.I_rim * self.w_w**2, axis=0)
        return 0.5 * (self.m * self.v**2 + self.I * self.w**2 + rotating)

    # ---- the whole day
    def drive(self):
        """Records each RECORD_STEPS steps: {name: array (records, sides?, B)}; sums are integrals since the start."""
        kept = {key: [] for key in ("q", "i", "V", "E", "I_bat", "U_bat", "E_bat", "heading", "seen", "pose", "w")}
        for k in range(self.steps):
            if k % STEPS_PER_TICK == 0:
                self.slow(k // STEPS_PER_TICK)
            if k % RECORD_STEPS == 0:
                self.record(kept)
            self.step()
        self.record(kept)
        return {key: np.array(values) for key, values in kept.items()}

    def record(self, kept):
        for key in ("i", "V", "E", "I_bat", "U_bat", "E_bat"):
            kept[key].append(self.sums[key].copy())
        kept["q"].append(self.q_m.copy())
        kept["heading"].append(self.pose[2].copy())
        kept["w"].append(self.w.copy())
        kept["seen"].append(self.seen.copy())
        kept["pose"].append(self.pose.copy())
