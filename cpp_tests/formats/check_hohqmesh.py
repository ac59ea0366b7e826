"""ISM, ISM-v2, ISM-MM and Abaqus files read back are the mesh: check_hohqmesh.py LIBRARY DOMAINS."""

import os
import re
import sys
import tempfile

import numpy as np

import hohqmesh
from mesh import Mesh, load, tensor

EXAMPLES = (("hohq/NACA0012.control", 1), ("hohq/NACA0012.control", 4), ("glyphs/DejaVuSans/u0038.svg", 7),
            ("hohq/GingerbreadMan.control", 5), ("mech/turek-hron-fsi.control", 12))
PLACES = np.array([-1.0, -0.83, -0.41, 0.0, 0.13, 0.77, 1.0])


def compare(file, mesh, label):
    assert file.order == mesh.order and np.array_equal(file.elements, mesh.elements), f"{label}: elements"
    assert np.array_equal(file.corners, mesh.vertices), f"{label}: corners are not the same to the bit"
    found, expected = tensor(file.points, file.nodes(), PLACES), mesh.evaluate(PLACES)
    error = np.abs(found - expected).max() / mesh.diagonal
    assert error < 1e-12, f"{label}: points differ by {error:.1e} of the diagonal"
    words = [re.sub(r"\s", "_", name) or f"boundary_{k}" for k, name in enumerate(mesh.names, 1)] + ["---"]
    assert file.names == [[words[k] for k in sides] for sides in mesh.side_boundaries], f"{label}: names"
    return error


def refused(path, text, change):
    """A file with that change is refused; so the reader is as strict as it says."""
    changed = change(text)
    assert changed != text
    with open(path, "w", encoding="utf-8") as file:
        file.write(changed)
    for read in (hohqmesh.read_ism, hohqmesh.read_abaqus):
        try:
            read(path)
        except hohqmesh.Malformed:
            continue
        raise AssertionError(f"{path} was read with a fault")


def main():
    library, domains = load(sys.argv[1]), sys.argv[2]
    with tempfile.TemporaryDirectory() as folder:
        for domain, order in EXAMPLES:
            mesh = Mesh(library, os.path.join(domains, domain), order, 1e-4)
            worst = 0.0
            for name, read in (("ism", hohqmesh.read_ism), ("ism-v2", hohqmesh.read_ism), ("ism-mm", hohqmesh.read_ism), ("inp", hohqmesh.read_abaqus)):
                path = os.path.join(folder, f"mesh.{name}")
                mesh.write(name, path)
                file = read(path)
                assert (file.edges is not None) == (name == "ism-v2") and (file.materials is not None) == (name == "ism-mm")
                worst = max(worst, compare(file, mesh, f"{domain}, {name}"))
            print(f"{domain}, order {order}: {len(mesh.elements)} elements, points to {worst:.1e}")
        path = os.path.join(folder, "mesh.ism-v2")
        with open(path, encoding="utf-8") as file:
            text = file.read()
        first_edge = text.split("\n")[2 + len(mesh.vertices)]
        for change in (lambda t: t + "1\n", lambda t: t[:-2] + "\n", lambda t: t.replace(first_edge, "1" + first_edge, 1),
                       lambda t: t.replace("ISM-V2", "ISM-V3", 1), lambda t: t.replace(" ---", " inside", 1), lambda t: t.replace("0.0\n", "0.1\n", 1)):
            refused(path, text, change)


main()
