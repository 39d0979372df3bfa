"""The few statistics that the scorecard needs."""
import math


def wilson(hits, total, z=1.959964):
    """Wilson score interval of a proportion [Wilson1927]."""
    if total == 0:
        return (0.0, 1.0)
    p = hits / total
    center = (p + z * z / (2 * total)) / (1 + z * z / total)
    half = z / (1 + z * z / total) * math.sqrt(p * (1 - p) / total + z * z / (4 * total * total))
    return (max(0.0, center - half), min(1.0, center + half))


def median(values):
    ordered = sorted(values)
    if not ordered:
        return float("nan")
    middle = len(ordered) // 2
    return ordered[middle] if len(ordered) % 2 else 0.5 * (ordered[middle - 1] + ordered[middle])


def calibration(pairs, bins=10):
    """(expected calibration error, Brier score, table of (mean probability, share right, count)) of (p, right)."""
    if not pairs:
        return float("nan"), float("nan"), []
    table = []
    for k in range(bins):
        inside = [(p, right) for p, right in pairs if min(int(p * bins), bins - 1) == k]
        if inside:
            table.append((sum(p for p, _ in inside) / len(inside), sum(r for _, r in inside) / len(inside), len(inside)))
    error = sum(n * abs(p - share) for p, share, n in table) / len(pairs)
    brier = sum((p - right) ** 2 for p, right in pairs) / len(pairs)
    return error, brier, table


def smallest_found(sizes_found, share=0.9):
    """The smallest size from which on at least `share` of the cases are found; None if never."""
    best, found, count = None, 0, 0
    for size, hit in sorted(sizes_found, reverse=True):
        count += 1
        found += hit
        if found / count >= share:
            best = size
        elif count >= 5:
            break
    return best
