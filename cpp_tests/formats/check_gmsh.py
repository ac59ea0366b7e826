"""Gmsh reads our .msh, of every order that it has, as the mesh: check_gmsh.py LIBRARY DOMAINS."""

import os
import sys
import tempfile

import gmsh
import numpy as np

from mesh import Mesh, load

DOMAINS = ("hohq/NACA0012.control", "glyphs/DejaVuSans/u0038.svg")
PLACES = np.array([-1.0, -0.83, -0.41, 0.0, 0.13, 0.77, 1.0])


def groups(dimension):
    """Physical groups of a dimension: name to (tag, entities)."""
    found = gmsh.model.getPhysicalGroups(dimension)
    return {gmsh.model.getPhysicalName(d, t): (t, gmsh.model.getEntitiesForPhysicalGroup(d, t)) for d, t in found}


def quadrilaterals(mesh):
    kinds, tags, nodes = gmsh.model.mesh.getElements(2)
    assert len(kinds) == 1 and len(tags[0]) == len(mesh.elements)
    name, _, order, count, _, _ = gmsh.model.mesh.getElementProperties(kinds[0])
    assert name.startswith("Quadrilateral") and order == mesh.order and count == (order + 1) ** 2
    # Gmsh's tags of the corners are the vertices' numbers, from 1.
    assert np.array_equal(nodes[0].reshape(-1, count)[:, :4] - 1, mesh.elements)
    x, y = np.meshgrid(PLACES, PLACES)
    local = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    _, determinants, points = gmsh.model.mesh.getJacobians(kinds[0], local.ravel())
    assert determinants.min() > 0
    points = points.reshape(len(mesh.elements), len(PLACES), len(PLACES), 3)
    assert np.all(points[..., 2] == 0)
    return np.abs(points[..., :2] - mesh.evaluate(PLACES)).max()


def boundary(mesh):
    """Lines are the boundary edges, in groups of their names, the domain to their left."""
    named = groups(1)
    names = [name or f"boundary_{k}" for k, name in enumerate(mesh.names, 1)]
    assert list(named) == names, f"{list(named)} for {names}"
    for k, name in enumerate(names):
        tag, curves = named[name]
        assert tag == k + 1
        found = set()
        for curve in curves:
            _, tags, nodes = gmsh.model.mesh.getElements(1, curve)
            for pair in nodes[0].reshape(len(tags[0]), -1)[:, :2]:
                found.add(tuple(pair - 1))
        expected = {tuple(v) for v, own in zip(mesh.edge_vertices, mesh.edge_boundaries) if own == k}
        assert found == expected, f"{name}: {len(found)} lines for {len(expected)} edges"


def main():
    library, domains = load(sys.argv[1]), sys.argv[2]
    with tempfile.TemporaryDirectory() as folder:
        for domain in DOMAINS:
            for order in range(1, 11):
                mesh = Mesh(library, os.path.join(domains, domain), order, 1e-4)
                path = os.path.join(folder, "mesh.msh")
                mesh.write("msh", path)
                gmsh.initialize(["gmsh"], False, False)
                gmsh.option.setNumber("General.Terminal", 0)
                gmsh.logger.start()
                gmsh.open(path)
                complaints = [m for m in gmsh.logger.get() if m.startswith(("Warning", "Error"))]
                assert not complaints, complaints
                tags, nodes, _ = gmsh.model.mesh.getNodes()
                assert len(tags) == len(set(tags)) and len(nodes) == 3 * len(tags)
                error = quadrilaterals(mesh) / mesh.diagonal
                assert error < 1e-8, f"{domain}, order {order}: points differ by {error:.1e} of the diagonal"
                boundary(mesh)
                tag, surfaces = groups(2)["domain"]
                assert tag == 1 and list(surfaces) == [1]
                # Every curve bounds the surface and starts where another one ends.
                curves = gmsh.model.getBoundary([(2, 1)])
                assert sorted(c for _, c in curves) == [c for _, c in gmsh.model.getEntities(1)]
                ends = [p for c in curves for p in gmsh.model.getBoundary([c], combined=False)]
                assert all(ends.count(p) == 2 for p in ends)
                gmsh.logger.stop()
                gmsh.finalize()
                print(f"{domain}, order {order}: {len(mesh.elements)} elements, points to {error:.1e}")


main()
