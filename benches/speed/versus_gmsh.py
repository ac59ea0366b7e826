"""quadrel and Gmsh on the same domains, one after the other, again and again: CPU seconds and their ratios.

    benches/speed/versus_gmsh.py [--quadrel PATH] [--runs N] [--order N] [--tolerance E] [DOMAIN...]

Both get the domains of benches/accuracy at one order, and Gmsh the coarsest all-quad settings (its algorithms and
sizes as in benches/accuracy, without searches over its optimisers) whose mesh has a scaled Jacobian of at least 0.1 and
whose boundary is as near to the exact one as quadrel's: the search is not timed. Timed is a process each: quadrel from
the file to the written mesh, Gmsh (loaded already) from its curves to high-order nodes. Runs alternate, so that what
else the machine does hits both; the fastest counts. Needs Python with numpy, scipy and gmsh (benches/accuracy/run.sh
installs them to target/accuracy/python).
"""

import argparse
import json
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "benches/accuracy"))

import numpy as np

import gmsh_meshes
from domains import DOMAINS, Domain
from poisson import basis, lobatto, scaled_jacobian

LEAST_SCALED_JACOBIAN = 0.1
# Sizes as shares of the diagonal, coarse to fine, and elements a full turn.
SHARES, CURVATURES = (1, 2, 4, 8, 16, 32, 64), (0, 10)
# Distances of the boundary below this share of the diagonal count as none.
EXACT = 1e-9


def boundary(domain, mesh):
    """How far a mesh's boundary is from the exact one, in diagonals; infinite where the mesh is no good."""
    value, _ = basis(lobatto(mesh.order), np.linspace(-1, 1, 4 * mesh.order + 1))
    sides, _ = mesh.boundary_sides()
    points = np.einsum("qi,eic->eqc", value, sides).reshape(-1, 2)
    if scaled_jacobian(mesh) < LEAST_SCALED_JACOBIAN or not domain.followed(points):
        return math.inf
    return domain.distance(points)


class Measure:
    """What gmsh_meshes asks of a mesh: here its elements and its boundary."""

    most = 200_000

    def __init__(self, domain):
        self.domain = domain

    def __call__(self, mesh):
        return len(mesh.places), boundary(self.domain, mesh)


def coarsest(domain, order, wanted):
    """(elements, recipe) of Gmsh's coarsest good mesh; None if there is none."""
    best = None
    sizes = [domain.diagonal / share for share in SHARES]
    for recipe in gmsh_meshes.recipes(sizes, CURVATURES):
        result = gmsh_meshes.measured(domain, recipe, (order,), 0, Measure(domain), set()).get(order)
        if isinstance(result, tuple) and result[1] <= wanted and (best is None or result[0] < best[0]):
            best = (result[0], recipe)
    return best


def in_child(work):
    """Does `work` in a process of its own."""
    child = os.fork()
    if child == 0:
        code = 1
        try:
            work()
            code = 0
        finally:
            os._exit(code)
    if os.waitpid(child, 0)[1]:
        raise RuntimeError("a run of Gmsh's failed")


def timed(work):
    """CPU seconds of the processes that `work` starts and waits for."""
    before = os.times()
    work()
    after = os.times()
    return after.children_user + after.children_system - before.children_user - before.children_system


def run_gmsh(domain, recipe, order):
    gmsh = gmsh_meshes.gmsh
    gmsh.initialize(["gmsh"], False, False)
    gmsh_meshes._generate(domain, recipe)
    gmsh.model.mesh.setOrder(order)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("domains", nargs="*", default=DOMAINS)
    parser.add_argument("--quadrel", type=Path, default=ROOT / "target/release/quadrel")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--order", type=int, default=5)
    parser.add_argument("--tolerance", type=float, default=1e-4, help="relative, largest distance")
    arguments = parser.parse_args()
    print("| domain | quadrel: elements | s | Gmsh: elements | s | quadrel / Gmsh |")
    print("|---|---|---|---|---|---|")
    ratios = []
    with tempfile.TemporaryDirectory() as folder:
        for name in arguments.domains:
            file = ROOT / "tests/domains" / f"{name}.control"
            domain = Domain(file)
            mesh, stats = Path(folder) / "mesh.vtu", Path(folder) / "stats.json"
            command = [arguments.quadrel, file, "--order", str(arguments.order), "--norm", "max"]
            command += ["--relative", str(arguments.tolerance), "-o", mesh, "--stats", stats]

            def run_quadrel():
                with open(os.devnull, "w") as sink:
                    subprocess.run(command, stdout=sink, stderr=sink, check=True)

            found = coarsest(domain, arguments.order, max(arguments.tolerance, EXACT))
            own, other = [], []
            for _ in range(arguments.runs):
                own.append(timed(run_quadrel))
                if found:
                    other.append(timed(lambda: in_child(lambda: run_gmsh(domain, found[1], arguments.order))))
            elements = json.loads(stats.read_text())["elements"]
            row = [name, elements, f"{min(own):.3f}"]
            if found:
                ratios.append(min(own) / min(other))
                row += [found[0], f"{min(other):.3f}", f"{ratios[-1]:.2f}"]
            else:
                row += ["none", "-", "-"]
            print("| " + " | ".join(map(str, row)) + " |", flush=True)
    if ratios:
        print(f"\nmedian ratio {float(np.median(ratios)):.2f}, geometric mean {float(np.exp(np.mean(np.log(ratios)))):.2f}")


if __name__ == "__main__":
    main()
