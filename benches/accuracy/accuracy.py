"""Error against degrees of freedom, on quadrel's meshes and on Gmsh's: accuracy.py LIBRARY FOLDER [--quick] [NAMES].

Writes FOLDER/accuracy.csv, a row for each mesh and order (or for why there is none); report.py makes the table and the
plot of it. Both tools get the same domains, exact solution and solver, the orders that they have, and the same demands:

* the Jacobian is positive on a fine grid over every element (report.py asks for a scaled Jacobian of 0.1);
* a mesh has error e only if its boundary, too, is within e diagonals of the exact one.
"""

import argparse
import csv
import os
import sys
import time
from pathlib import Path

# Matrices are small: threads cost more than they give.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

import gmsh_meshes
import quadrel_meshes
from domains import DOMAINS, Domain
from poisson import basis, lobatto, scaled_jacobian, solve

ROOT = Path(__file__).resolve().parents[2]
ORDERS = (4, 5, 6, 7, 8, 9, 10)
# quadrel's only: Gmsh's quadrilaterals end at order 10.
HIGH_ORDERS = (11, 12, 13, 14, 16)
TOLERANCES = (1e-4, 1e-6, 1e-8)
# Largest sizes as shares of the diagonal. Gmsh takes them at the points of the curves and, with the second list, as
# many elements as that a full turn.
SIZES = tuple(round(1.2**k, 2) for k in range(21))
CURVATURES = (0, 6, 10, 16)
QUICK_ORDERS, QUICK_SIZES, QUICK_CURVATURES = (4, 6, 8, 10), SIZES[2::2], (0, 10)
# Nothing finer is tried once a mesh has this error.
ENOUGH = 2e-9
# Unknowns above which no mesh is solved on; for Gmsh also above this multiple of what quadrel needs for LEAST_ERROR.
MOST_UNKNOWNS, BEYOND = 100000, 3
LEAST_SCALED_JACOBIAN = 0.1
INVALID = "Jacobian not positive"
# Gmsh's optimisers move nodes of given elements: they are tried where unknowns are at most this multiple of the fewest
# at a mesh's error, and on invalid meshes with fewer than the least error plotted takes.
NEAR, LEAST_ERROR = 1.5, 1e-8
OPTIMISERS = (4, 2)
COLUMNS = ("domain", "tool", "settings", "order", "elements", "unknowns", "scaled_jacobian", "boundary", "error", "why")


class Judge:
    """What a mesh of a domain is worth."""

    def __init__(self, domain):
        self.domain, self.k = domain, 2 * np.pi / domain.diagonal
        self.most = MOST_UNKNOWNS

    def exact(self, x, y):
        return np.sin(self.k * x) * np.cosh(self.k * y)

    def laplacian(self, x, y):
        return np.zeros_like(x * y)

    def __call__(self, mesh):
        """A row without domain, tool and settings."""
        row = {"order": mesh.order, "elements": len(mesh.places), "unknowns": mesh.count}
        row["scaled_jacobian"] = scaled_jacobian(mesh)
        sides, _ = mesh.boundary_sides()
        value, _ = basis(lobatto(mesh.order), np.linspace(-1, 1, 4 * mesh.order + 1))
        points = np.einsum("qi,eic->eqc", value, sides).reshape(-1, 2)
        row["boundary"] = self.domain.distance(points)
        if row["scaled_jacobian"] <= 0:
            row["why"] = INVALID
        elif not self.domain.followed(points):
            row["why"] = "does not follow all of the boundary"
        elif mesh.count > self.most:
            row["why"] = "too many unknowns"
        else:
            row["error"] = solve(mesh, self.exact, self.laplacian)
        return row


def good(row):
    return row["scaled_jacobian"] >= LEAST_SCALED_JACOBIAN


def total(row):
    return max(row["error"], row["boundary"])


def quadrel_rows(library, domain, judge, orders, sizes):
    for order in orders:
        seen = set()
        for tolerance in TOLERANCES:
            for share in (None, *sizes):
                settings = f"tolerance {tolerance:.0e}, size " + (f"D/{share}" if share else "free")
                try:
                    mesh = library.mesh(domain, order, tolerance, domain.diagonal / share if share else None)
                except RuntimeError as error:
                    yield {"settings": settings, "order": order, "why": str(error)}
                    continue
                # Many sizes and tolerances make the same mesh.
                if mesh.places.tobytes() in seen:
                    continue
                seen.add(mesh.places.tobytes())
                row = {"settings": settings, **judge(mesh)}
                yield row
                if "error" not in row or total(row) <= ENOUGH:
                    break


def promising(row, rows):
    """Whether an optimiser could make the mesh the best at its error, or, if it is invalid, at some error."""
    valid = [r for r in rows if "error" in r and good(r)]
    if "error" in row and good(row):
        return row["unknowns"] <= NEAR * min(r["unknowns"] for r in valid if total(r) <= total(row))
    accurate = [r["unknowns"] for r in valid if total(r) <= LEAST_ERROR]
    return ("error" in row or row.get("why") == INVALID) and row["unknowns"] <= min(accurate, default=MOST_UNKNOWNS)


def gmsh_rows(domain, judge, orders, sizes, curvatures, optimisers):
    rows, again, seen = [], [], set()
    for recipe in gmsh_meshes.recipes([domain.diagonal / s for s in sizes], curvatures):
        for order, result in gmsh_meshes.measured(domain, recipe, orders, 0, judge, seen).items():
            rows.append(gmsh_row(domain, recipe, 0, order, result))
            again.append((recipe, order))
            yield rows[-1]
    wanted = {}
    for row, (recipe, order) in zip(list(rows), again):
        if promising(row, rows):
            wanted.setdefault(recipe, []).append(order)
    for optimiser in optimisers:
        for recipe, few in wanted.items():
            for order, result in gmsh_meshes.measured(domain, recipe, few, optimiser, judge, set()).items():
                yield gmsh_row(domain, recipe, optimiser, order, result)


def gmsh_row(domain, recipe, optimiser, order, result):
    algorithm, recombination, size, curvature = recipe
    settings = f"algorithm {algorithm}, recombination {recombination}, optimiser {optimiser}, size D/{domain.diagonal / size:.2f}, curvature {curvature}"
    return {"settings": settings, **(result if isinstance(result, dict) else {"order": order, "why": result})}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("library", type=Path)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--tool", choices=("quadrel", "gmsh"))
    parser.add_argument("names", nargs="*")
    options = parser.parse_intermixed_args()
    orders, sizes, curvatures = (QUICK_ORDERS, QUICK_SIZES, QUICK_CURVATURES) if options.quick else (ORDERS, SIZES, CURVATURES)
    library = quadrel_meshes.Library(options.library)
    options.folder.mkdir(parents=True, exist_ok=True)
    with open(options.folder / "accuracy.csv", "w", encoding="utf-8", newline="") as file:
        table = csv.DictWriter(file, COLUMNS)
        table.writeheader()
        for path in DOMAINS:
            domain = Domain(ROOT / "tests/domains" / f"{path}.control")
            if options.names and domain.name not in options.names:
                continue
            judge = Judge(domain)
            for tool in ("quadrel", "gmsh"):
                if options.tool not in (None, tool):
                    continue
                begun = time.monotonic()
                if tool == "quadrel":
                    high = () if options.quick else HIGH_ORDERS
                    made = quadrel_rows(library, domain, judge, (*orders, *high), sizes)
                else:
                    made = gmsh_rows(domain, judge, orders, sizes, curvatures, () if options.quick else OPTIMISERS)
                rows = []
                for row in made:
                    rows.append(row)
                    shown = {k: f"{v:.4e}" if isinstance(v, float) else v for k, v in row.items()}
                    table.writerow({"domain": domain.name, "tool": tool, **shown})
                    file.flush()
                if tool == "quadrel":
                    enough = [r["unknowns"] for r in rows if "error" in r and total(r) <= LEAST_ERROR]
                    judge.most = min([MOST_UNKNOWNS, *(BEYOND * n for n in enough)])
                solved = sum("error" in r for r in rows)
                print(f"{domain.name}, {tool}: {solved} of {len(rows)} meshes, {time.monotonic() - begun:.0f} s", file=sys.stderr)


main()
