"""The table and the plot of what accuracy.py measured: report.py FOLDER [LEAST_SCALED_JACOBIAN]."""

import csv
import sys
from pathlib import Path

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt
import matplotlib.ticker

matplotlib.rcParams.update({"svg.hashsalt": "quadrel", "svg.fonttype": "none", "font.size": 9})

ERRORS = (1e-4, 1e-6, 1e-8)
# Below it elements do not count.
LEAST_SCALED_JACOBIAN = 0.1


def envelope(rows):
    """Corners (unknowns, error) of the least error for so many unknowns."""
    best = []
    for row in sorted(rows, key=lambda r: (r[0], r[1])):
        if not best or row[1] < best[-1][1]:
            best.append(row)
    return best


def fewest(best, error):
    return next((row for row in best if row[1] <= error), None)


def main():
    folder = Path(sys.argv[1])
    least = float(sys.argv[2]) if len(sys.argv) > 2 else LEAST_SCALED_JACOBIAN
    rows = {}
    with open(folder / "accuracy.csv", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            tools = rows.setdefault(row["domain"], {"quadrel": [], "gmsh": []})
            if row["error"] and float(row["scaled_jacobian"]) >= least:
                both = max(float(row["error"]), float(row["boundary"]))
                tools[row["tool"]].append((int(row["unknowns"]), both, row["order"], row["settings"]))
    lines = ["| domain | " + " | ".join(f"{e:.0e}" for e in ERRORS) + " |", "|---|" + "---|" * len(ERRORS)]
    figure, axes = plt.subplots(2, 3, figsize=(9, 5.4))
    for (domain, tools), axis in zip(rows.items(), axes.flat):
        best = {tool: envelope(found) for tool, found in tools.items()}
        cells = []
        for error in ERRORS:
            own, other = (fewest(best[tool], error) for tool in ("quadrel", "gmsh"))
            share = f"**{own[0] / other[0]:.2f}**" if own and other else ""
            texts = [f"{row[0]} (N = {row[2]})" if row else "none" for row in (own, other)]
            cells.append(" : ".join(texts) + (f" = {share}" if share else ""))
            for tool, row in (("quadrel", own), ("gmsh", other)):
                print(f"{domain}, {error:.0e}, {tool}: {row}", file=sys.stderr)
        lines.append(f"| {domain} | " + " | ".join(cells) + " |")
        for tool, colour in (("quadrel", "tab:blue"), ("gmsh", "tab:orange")):
            if best[tool]:
                axis.loglog(*zip(*[row[:2] for row in best[tool]]), color=colour, marker="o", markersize=3, linewidth=1.2,
                            label="quadrel" if tool == "quadrel" else "Gmsh 4.15.2")
        axis.set_title(domain, fontsize=9)
        axis.set_ylim(1e-10, 1e-1)
        # Labels between powers of ten would lie on each other.
        axis.xaxis.set_minor_formatter(matplotlib.ticker.NullFormatter())
        axis.grid(True, linewidth=0.3)
    for axis in axes.flat[len(rows) :]:
        axis.remove()
    for axis in axes[:, 0]:
        axis.set_ylabel("relative error")
    for axis in axes[-1]:
        axis.set_xlabel("degrees of freedom")
    axes.flat[0].legend(frameon=False)
    figure.tight_layout()
    figure.savefig(folder / "accuracy.svg", metadata={"Date": None, "Creator": None})
    (folder / "accuracy.md").write_text("\n".join(lines) + "\n", encoding="utf-8")
    print("\n".join(lines))


main()
