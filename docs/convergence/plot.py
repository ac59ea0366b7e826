"""Draws convergence.svg from the table that cpp_tests/solvers/convergence.cpp writes: plot.py TABLE.csv PICTURE.svg"""

import csv
import sys

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt

matplotlib.rcParams.update({"svg.hashsalt": "quadrel", "svg.fonttype": "none", "font.size": 9})


def main():
    table, picture = sys.argv[1:]
    curves = {}
    with open(table, encoding="utf-8") as file:
        for row in csv.DictReader(file):
            if row["route"] == "arrays":
                curves.setdefault(row["domain"], []).append((int(row["p"]), float(row["error"])))
    figure, axes = plt.subplots(figsize=(5.2, 3.2))
    for (name, points), marker in zip(curves.items(), "osd^v"):
        axes.semilogy(*zip(*points), marker=marker, markersize=4, linewidth=1.2, label=name)
    axes.set_xlabel("order p of the solution")
    axes.set_ylabel("relative L2 error")
    axes.grid(True, linewidth=0.3)
    axes.legend(frameon=False)
    figure.tight_layout()
    figure.savefig(picture, metadata={"Date": None, "Creator": None})


main()
