"""What `joulepath diagnose` says of a dataset, as cells of a table."""
import json
import subprocess

import workspace

TITLE = ("| set | known cause | verdict | named (probability) | energy gap, held out: before → after (noise floor) | wheel | phase |\n"
         "|---|---|---|---|---|---|---|")


def diagnose(dataset, out):
    command = [workspace.program("joulepath"), "diagnose", str(dataset), "--out", str(out)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=900)
    answer = out / "diagnosis.json"
    if done.returncode not in (0, 1) or not answer.exists():
        return {"verdict": f"failed ({done.returncode})", "error": (done.stderr or done.stdout)[-300:].replace("\n", " ")}
    return json.loads(answer.read_text())


def cause_text(cause):
    values = ", ".join(f"{key} {value['value']:.3g}" if isinstance(value.get("value"), (int, float)) else str(value.get("value"))
                       for key, value in (cause.get("parameters") or {}).items() if isinstance(value, dict))
    group = cause.get("indistinguishable_from") or []
    return f"{cause['effect']}: {values} ({cause.get('probability', 0):.2f})" + (f", or {', '.join(group)}" if group else "")


def shares(answer, axis, count):
    cells = sorted((w for w in answer.get("where", []) if w.get("axis") == axis), key=lambda w: -w["share_of_gap"])[:count]
    return ", ".join(f"{w['value']} {100 * w['share_of_gap']:.0f} % ({100 * w['interval_95'][0]:.0f}–{100 * w['interval_95'][1]:.0f})"
                     for w in cells) or "–"


def named_text(answer):
    """The names; where none is given, what the ranking holds likely, in brackets."""
    if answer.get("causes"):
        return "; ".join(map(cause_text, answer["causes"]))
    likely = [f"{r['effect']} {r['probability']:.2f}" for r in answer.get("ranking") or [] if r["probability"] > 0.5]
    return answer.get("error") or ("none" + (f" [candidates: {', '.join(likely)}]" if likely else ""))


def energy_text(answer):
    energy = answer.get("gap", {}).get("energy", {})
    if not energy.get("before_J"):
        return "–"
    text = f"{energy['before_percent']:.1f} % (bias {energy['bias_before_percent']:+.1f})"
    if answer.get("causes"):
        text += f" → {energy['after_percent']:.1f} %"
    return text + f" ({energy['noise_floor_percent']:.1f} %)"


def row(name, cause, answer):
    return (f"| {name} | {cause} | {answer.get('verdict', '?')} | {named_text(answer)} | {energy_text(answer)} "
            f"| {shares(answer, 'wheel', 2)} | {shares(answer, 'phase', 2)} |")


def value_of(answer, effect, parameter):
    """A named effect's parameter, or None."""
    for cause in answer.get("causes") or []:
        if cause["effect"] == effect:
            return (cause["parameters"].get(parameter) or {}).get("value")
    return None
