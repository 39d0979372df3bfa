"""The list of blind cases: which bins, how many, in which order. Everything follows from the frozen commit."""
import hashlib
import random

import workspace  # noqa: F401 (knows where spoils is)
from spoils import spoils

ROBOTS = [("nomad", 0.5), ("warehouse", 0.2), ("small", 0.15), ("tug", 0.15)]
PROTOCOLS = [(24, 0.6), (12, 0.25), (6, 0.15)]
FULL = {"single": 24, "null": 320, "pair": 300, "triple": 50, "foreign": 20, "removed": 200,  # single, foreign: per effect
        "spoilt": 150, "battery": 100, "long": 50}
SHORT = {"single": 1, "null": 11, "pair": 3, "triple": 1, "foreign": 1, "removed": 2, "spoilt": 2, "battery": 1, "long": 1}
MIXED = {"pair": 2, "triple": 3, "removed": 1, "battery": 1, "long": 1}  # bins whose effects are drawn: how many
# What MuJoCo has forms of its own for (../mujoco/mjcf.hpp): white noise, textbook laws.
MUJOCO, MUJOCO_EFFECTS = {"single": 6, "null": 40}, (
    "coulomb_friction", "current_sensor_offset", "dragging_wheel", "floor_slope", "payload_mass_error", "rolling_resistance", "track_width_error",
    "viscous_friction", "wheel_radius_error", "winding_resistance_error")
# What the field generator has (../field/causes.py, ../field/days.py); runs of a day as users drive it.
FIELD_ROBOTS = ("courier", "porter", "hauler")
FIELD_DAYS = ("testday", "missions", "out_and_back", "shuttle", "eights", "joystick", "scurve")
FIELD_RUNS = [(18, 0.5), (12, 0.35), (6, 0.15)]
FIELD = {"single": 4, "null": 63, "foreign": 6}
SMALL_MEMBER = 1 / 3  # share of the pairs with a small second effect


def digest(*parts):
    return hashlib.sha256(":".join(str(part) for part in parts).encode()).digest()


def seed_of(frozen, key):
    """63-bit seed of a case: nobody can know it before the commit exists."""
    return int.from_bytes(digest("joulepath-blind", frozen, key)[:8], "big") >> 1


def weighted(rng, choices):
    return rng.choices([value for value, _ in choices], [weight for _, weight in choices])[0]


def case(frozen, bin_name, number, effects):
    key = f"{bin_name}/{'+'.join(effects)}/{number}"
    rng = random.Random(digest("draw", frozen, key))
    if bin_name in MIXED:
        effects = rng.sample(effects, MIXED[bin_name])
    drawn = {"bin": bin_name, "effects": effects, "robot": weighted(rng, ROBOTS),
             "protocol": weighted(rng, PROTOCOLS), "level": rng.randrange(2), "seed": seed_of(frozen, key)}
    if bin_name == "pair" and rng.random() < SMALL_MEMBER:
        drawn["shares"] = [0.7, 0.1]
    elif bin_name == "triple":
        drawn["shares"] = [round(rng.uniform(0.25, 1), 3) for _ in effects]
    elif bin_name == "battery":
        drawn["shares"] = [1]
    elif bin_name == "spoilt":
        drawn["effects"] = rng.sample(effects, number % 2)  # every other day holds an effect as well
        drawn["spoil"] = {"way": rng.choice(sorted(spoils())), "all_runs": rng.random() < 0.5}
    return drawn


def plan(frozen, catalog, foreign, counts):
    """All cases, ordered so that every prefix holds the bins in the proportions of the whole; numbered after
    a shuffle within the prefix order, so that a case's number says nothing about its bin."""
    strata = [("null", [], counts["null"])]
    strata += [(name, catalog, counts.get(name, 0)) for name in (*MIXED, "spoilt")]
    strata += [("single", [name], counts["single"]) for name in catalog]
    strata += [("foreign", [name], counts["foreign"]) for name in foreign]
    ranked = []
    for bin_name, effects, count in strata:
        offset = digest("order", frozen, bin_name, effects)[0] / 256
        for number in range(count):
            ranked.append(((number + offset) / count, case(frozen, bin_name, number, list(effects))))
    ranked.sort(key=lambda entry: (entry[0], entry[1]["seed"]))
    cases = [entry[1] for entry in ranked]
    for index, entry in enumerate(cases):
        entry["id"] = f"case_{index + 1:04d}"
    return cases


def mujoco(frozen):
    """Cases that MuJoCo drives; the oracle's word on them is the plant's, which draws the same machine and noise."""
    return [{**entry, "level": 0, "physics": "blind_mujoco"} for entry in plan(f"mujoco:{frozen}", MUJOCO_EFFECTS, (), MUJOCO)]


def field(frozen):
    """Cases of the field generator, which is its own oracle: nulls go round every kind of day with every robot."""
    entries = plan(f"field:{frozen}", *workspace.effect_names("blind_field"), FIELD)
    nulls = 0
    for entry in entries:
        rng = random.Random(digest("field", frozen, entry["seed"]))
        kind, robot = rng.choice(FIELD_DAYS), rng.choice(FIELD_ROBOTS)
        if not entry["effects"]:
            kind, robot = FIELD_DAYS[nulls % len(FIELD_DAYS)], FIELD_ROBOTS[nulls // len(FIELD_DAYS) % len(FIELD_ROBOTS)]
            nulls += 1
        entry.update(robot=robot, protocol=f"{kind}:{weighted(rng, FIELD_RUNS)}", physics="blind_field", oracle="blind_field")
    return entries


def campaign(name, frozen):
    """The cases of a campaign by its name."""
    if name == "field":
        return field(frozen)
    return mujoco(frozen) if name == "mujoco" else plan(frozen, *workspace.effect_names(), {"full": FULL, "short": SHORT}[name])
