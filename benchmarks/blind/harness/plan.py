"""The list of blind cases: which bins, how many, in which order. Everything follows from the frozen commit."""
import hashlib
import random

ROBOTS = [("nomad", 0.6), ("warehouse", 0.2), ("small", 0.2)]
PROTOCOLS = [(24, 0.6), (12, 0.25), (6, 0.15)]
FULL = {"single": 40, "null": 560, "pair": 220, "foreign": 20, "removed": 100}  # single, foreign: per effect
SHORT = {"single": 1, "null": 15, "pair": 4, "foreign": 1, "removed": 2}        # 60 cases: mechanics only


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
    if bin_name in ("pair", "removed"):
        effects = rng.sample(effects, 2 if bin_name == "pair" else 1)
    return {"bin": bin_name, "effects": effects, "robot": weighted(rng, ROBOTS),
            "protocol": weighted(rng, PROTOCOLS), "level": rng.randrange(2), "seed": seed_of(frozen, key)}


def plan(frozen, catalog, foreign, counts):
    """All cases, ordered so that every prefix holds the bins in the proportions of the whole; numbered after
    a shuffle within the prefix order, so that a case's number says nothing about its bin."""
    strata = [("null", [], counts["null"]), ("pair", catalog, counts["pair"]), ("removed", catalog, counts["removed"])]
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
