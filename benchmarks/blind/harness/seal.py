"""Seal a campaign: labels (with the oracle's word on detectability) go to a folder outside the tree, salted
hashes of them to a manifest that is committed before anything is diagnosed."""
import concurrent.futures
import hashlib
import json
import os
import secrets
import subprocess
import sys
import tempfile

import plan
import workspace


def plant_command(case, program="blind_plant"):
    command = [workspace.program(program), "--effect", ",".join(case["effects"]) or "none", "--robot", case["robot"],
               "--protocol", str(case["protocol"]), "--level", str(case["level"]), "--seed", str(case["seed"])]
    if "shares" in case:
        command += ["--share", ",".join(map(str, case["shares"]))]
    return command + (["--one-log"] if case["bin"] == "long" else [])


def physics_of(case):
    """The program that moves the robot."""
    return case.get("physics", "blind_plant")


def oracle_of(case):
    """The program whose word it is what a case shows: the plant's, except where a generator has an oracle of its own."""
    return case.get("oracle", "blind_plant")


def label_of(case):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "label.json")
        subprocess.run(plant_command(case, oracle_of(case)) + ["--label", path, "--observer" if case["bin"] in ("single", "removed") else "--oracle"], check=True)
        with open(path) as file:
            text = file.read()
    try:
        label = json.loads(text)
    except ValueError:  # nan or inf: what the oracle could not compute cannot be scored
        return {"id": case["id"], "bin": case["bin"], "unusable": text}
    return {**{key: case[key] for key in ("id", "bin", "spoil") if key in case}, **label}


def commitment(salt, label):
    return hashlib.sha256((salt + json.dumps(label, sort_keys=True)).encode()).hexdigest()


def seal(name, limit, jobs):
    frozen = workspace.head()
    if workspace.dirty():
        sys.exit("the tree has changes: commit them first, the seeds derive from the commit")
    folder = workspace.sealed_folder(frozen, name)
    manifest = workspace.manifest_path(frozen, name)
    if manifest.exists():
        sys.exit(f"{manifest.name} exists: this commit is sealed already")
    cases = plan.campaign(name, frozen)[: limit or None]
    for physics in {program(case) for case in cases for program in (physics_of, oracle_of)}:
        workspace.program(physics)
    folder.mkdir(parents=True, mode=0o700, exist_ok=True)
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        labels = list(pool.map(label_of, cases))
    hashes = {}
    descriptor = os.open(folder / "sealed.jsonl", os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
    with os.fdopen(descriptor, "w") as file:
        for label in labels:
            salt = secrets.token_hex(16)
            hashes[label["id"]] = commitment(salt, label)
            file.write(json.dumps({"salt": salt, "label": label}) + "\n")
    manifest.parent.mkdir(parents=True, exist_ok=True)
    manifest.write_text(json.dumps({"campaign": name, "frozen_commit": frozen, "cases": len(cases),
                                    "seed": "SHA-256 of the frozen commit and the case's key, see harness/plan.py",
                                    "label_sha256_with_salt": hashes}, indent=1) + "\n")
    print(f"{len(cases)} labels sealed in {folder}")
    print(f"commit {manifest} now, before diagnosing")
    return frozen


def open_labels(frozen, name):
    """The labels, each checked against the manifest's hash."""
    hashes = json.loads(workspace.manifest_path(frozen, name).read_text())["label_sha256_with_salt"]
    labels = {}
    for line in (workspace.sealed_folder(frozen, name) / "sealed.jsonl").read_text().splitlines():
        entry = json.loads(line)
        label = entry["label"]
        if commitment(entry["salt"], label) != hashes[label["id"]]:
            sys.exit(f"{label['id']}: the label is not the one that was sealed")
        labels[label["id"]] = label
    if set(labels) != set(hashes):
        sys.exit("labels and manifest name different cases")
    return labels
