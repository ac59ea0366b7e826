"""How time and memory grow with a domain: plates with round holes and fractal coasts, made here from a seed.

    benches/speed/growth.py [--quadrel PATH] [--folder DIR] [--limit SECONDS] [--runs N] [--quick]

Every domain is meshed in a process of its own at order 5 and relative tolerance 1e-5. Prints a table and, for each
family, the exponents p of cost ~ size^p (least squares in logarithms): time over base triangles and over boundary
pieces, peak memory likewise. Needs Python alone.
"""

import argparse
import json
import math
import os
import random
import subprocess
import sys
import time
from pathlib import Path

HOLES = (25, 100, 400, 1600)
POINTS = (1_000, 10_000, 80_000)
SEED = 20240611
# Radius of a hole, in spacings, and how far its centre may lie off the grid: no two come closer than 0.3.
RADII = (0.18, 0.28)
OFF = 0.07
# Share of its length by which the middle of a coast's piece is moved off the line at each halving.
ROUGHNESS = 0.18
# Least angle between two pieces that meet, in radians: sharper ones are cusps, which are refused.
SHARP = 0.4


def plate(holes):
    """A square plate with about round holes on a disturbed grid, as an SVG path."""
    source = random.Random(SEED + holes)
    side = math.isqrt(holes)
    parts = [f"M0 0H{side}V{side}H0Z"]
    for i in range(side):
        for j in range(side):
            x, y = (k + 0.5 + source.uniform(-OFF, OFF) for k in (i, j))
            r = source.uniform(*RADII)
            parts.append(f"M{x - r:.9f} {y:.9f}a{r:.9f} {r:.9f} 0 1 0 {2 * r:.9f} 0a{r:.9f} {r:.9f} 0 1 0 {-2 * r:.9f} 0Z")
    return "".join(parts)


def crosses(a, b, c, d):
    def side(p, q, r):
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])

    return side(a, b, c) * side(a, b, d) <= 0 and side(c, d, a) * side(c, d, b) <= 0


def angle(a, b, c):
    """Between the pieces that meet at b."""
    turn = math.atan2(a[1] - b[1], a[0] - b[0]) - math.atan2(c[1] - b[1], c[0] - b[0])
    return abs(math.remainder(turn, 2 * math.pi))


class Cells:
    """The pieces of a coast by the cells of a grid that they lie in."""

    def __init__(self, size):
        self.size, self.cells = size, {}

    def around(self, a, b):
        columns = range(math.floor(min(a[0], b[0]) / self.size), math.floor(max(a[0], b[0]) / self.size) + 1)
        rows = range(math.floor(min(a[1], b[1]) / self.size), math.floor(max(a[1], b[1]) / self.size) + 1)
        return [(i, j) for i in columns for j in rows]

    def add(self, a, b):
        for cell in self.around(a, b):
            self.cells.setdefault(cell, set()).add((a, b))

    def remove(self, a, b):
        for cell in self.around(a, b):
            self.cells[cell].discard((a, b))

    def free(self, a, b):
        """Whether the piece meets no other but those that it shares an end with."""
        for cell in self.around(a, b):
            for c, d in self.cells.get(cell, ()):
                if not {a, b} & {c, d} and crosses(a, b, c, d):
                    return False
        return True


def coast(points):
    """A square whose sides are halved again and again, each middle moved at random where nothing is crossed."""
    source = random.Random(SEED + points)
    line = [(0.0, 0.0), (1000.0, 0.0), (1000.0, 1000.0), (0.0, 1000.0)]
    while len(line) < points:
        length = max(math.dist(a, b) for a, b in zip(line, line[1:] + line[:1]))
        cells = Cells(length)
        for a, b in zip(line, line[1:] + line[:1]):
            cells.add(a, b)
        finer = []
        # The last level halves as many pieces as are asked for.
        halved = set(source.sample(range(len(line)), min(len(line), points - len(line))))
        for k, (a, b) in enumerate(zip(line, line[1:] + line[:1])):
            finer.append(a)
            if k not in halved:
                continue
            cells.remove(a, b)
            shift = source.gauss(0, ROUGHNESS)
            before, after = (finer[-2] if k else line[-1]), (finer[1] if k + 1 == len(line) else line[(k + 2) % len(line)])
            for share in (shift, 0.5 * shift, 0.0):
                middle = (
                    round(0.5 * (a[0] + b[0]) - share * (b[1] - a[1]), 9),
                    round(0.5 * (a[1] + b[1]) + share * (b[0] - a[0]), 9),
                )
                blunt = min(angle(before, a, middle), angle(a, middle, b), angle(middle, b, after)) > SHARP
                if blunt and cells.free(a, middle) and cells.free(middle, b):
                    break
            cells.add(a, middle)
            cells.add(middle, b)
            finer.append(middle)
        line = finer
    return "M" + "L".join(f"{x:.9f} {y:.9f}" for x, y in line) + "Z"


def measure(binary, file, folder, limit):
    """Seconds, peak memory in kB and statistics of one run."""
    stats = folder / (file.stem + ".json")
    stats.unlink(missing_ok=True)
    command = [str(binary), str(file), "--order", "5", "--relative", "1e-5", "--stats", str(stats)]
    command += ["-o", str(folder / (file.stem + ".vtu"))]
    started = time.monotonic()
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    # wait4 tells the child's own peak; getrusage that of the largest child so far.
    while True:
        pid, status, usage = os.wait4(child.pid, os.WNOHANG)
        if pid:
            break
        if time.monotonic() - started > limit:
            child.kill()
            usage = os.wait4(child.pid, 0)[2]
            return usage.ru_utime + usage.ru_stime, usage.ru_maxrss, {"status": "time limit"}
        time.sleep(0.02)
    child.returncode = os.waitstatus_to_exitcode(status)
    known = json.loads(stats.read_text()) if stats.exists() else {"status": f"exit {child.returncode}"}
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss, known


def exponent(pairs):
    """Slope of log cost over log size."""
    pairs = [(math.log(x), math.log(y)) for x, y in pairs if x and y]
    if len(pairs) < 2:
        return math.nan
    mx, my = (sum(p[k] for p in pairs) / len(pairs) for k in (0, 1))
    spread = sum((x - mx) ** 2 for x, _ in pairs)
    return sum((x - mx) * (y - my) for x, y in pairs) / spread if spread else math.nan


def main():
    root = Path(__file__).resolve().parents[2]
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quadrel", type=Path, default=root / "target/release/quadrel")
    parser.add_argument("--folder", type=Path, default=root / "target/speed")
    parser.add_argument("--limit", type=float, default=600.0, help="seconds for one run")
    parser.add_argument("--runs", type=int, default=1, help="runs of each domain; the fastest counts")
    parser.add_argument("--quick", action="store_true", help="leave the largest of each family out")
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    failed = False
    print("| domain | pieces | status | s (CPU) | base triangles | elements | peak MB | allowed MB | µs a triangle |")
    print("|---|---|---|---|---|---|---|---|---|")
    for family, sizes, make in (("plate", HOLES, plate), ("coast", POINTS, coast)):
        rows = []
        for size in sizes[:-1] if arguments.quick else sizes:
            file = arguments.folder / f"{family}-{size}.svg"
            file.write_text(f'<svg xmlns="http://www.w3.org/2000/svg"><path d="{make(size)}"/></svg>\n')
            runs = [measure(arguments.quadrel, file, arguments.folder, arguments.limit) for _ in range(arguments.runs)]
            seconds, memory, known = min(runs, key=lambda run: run[0])
            triangles, elements = known.get("triangles") or 0, known.get("elements") or 0
            pieces = 4 + 2 * size if family == "plate" else size
            # What the design allows beside the program itself: 1 kB a base triangle and 2 kB an element.
            allowed = (triangles + 2 * elements) / 1024
            cells = (file.stem, pieces, known["status"], f"{seconds:.2f}", triangles, elements,
                     f"{memory / 1024:.0f}" if memory else "-", f"{allowed:.0f}",
                     f"{1e6 * seconds / triangles:.0f}" if triangles else "-")
            print("| " + " | ".join(map(str, cells)) + " |", flush=True)
            if known["status"] == "ok":
                rows.append((pieces, triangles, seconds, memory))
            else:
                failed = True
        for name, x in (("boundary pieces", 0), ("base triangles", 1)):
            powers = [exponent([(row[x], row[y]) for row in rows]) for y in (2, 3)]
            print(f"\n{family}: over {name}, time grows with the power {powers[0]:.2f}, peak memory {powers[1]:.2f}", flush=True)
        print()
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
