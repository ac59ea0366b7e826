"""All-quad meshes of Gmsh's on the same exact curves, with every combination of what Gmsh offers for them.

A mesh is made in a process of its own, because some combinations crash or do not end.
"""

import hashlib
import itertools
import multiprocessing
import os

import gmsh
import numpy as np

from poisson import Mesh, basis, lobatto

# Frontal-Delaunay for quads, packing of parallelograms, quasi-structured.
FRONTAL, PACKING, QUASI = 8, 9, 11
# 0 simple and 1 blossom leave triangles, so that all is divided once more; 2 and 3 divide by themselves.
RECOMBINATIONS = (0, 1, 2, 3)
# Gmsh's number of quadrilaterals with four nodes.
LINEAR_QUAD = 3
# Gmsh's high-order optimisers: none, elastic analogy and then optimisation, fast curving.
OPTIMISERS = {0: (), 2: ("HighOrderElastic", "HighOrder"), 4: ("HighOrderFastCurving",)}
# Seconds that one mesh may take, of all orders asked for.
PATIENCE = 10


# Marks the message that carries a mesh's digest.
MADE = "made"


class Failure(Exception):
    """Why there is no mesh."""


def recipes(sizes, curvatures):
    """(algorithm, recombination, size, elements a full turn); quasi-structured meshes have a recombination of their own."""
    for algorithm in (FRONTAL, PACKING):
        yield from itertools.product((algorithm,), RECOMBINATIONS, sizes, curvatures)
    yield from itertools.product((QUASI,), (1,), sizes, curvatures)


def _generate(domain, recipe):
    algorithm, recombination, size, curvature = recipe
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    gmsh.option.setNumber("Mesh.Algorithm", algorithm)
    gmsh.option.setNumber("Mesh.RecombineAll", 1)
    gmsh.option.setNumber("Mesh.RecombinationAlgorithm", recombination)
    # A divided mesh is meant to have the size asked for.
    divided = algorithm != QUASI and recombination in (0, 1)
    gmsh.option.setNumber("Mesh.SubdivisionAlgorithm", 1 if divided else 0)
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", curvature / (2 if divided else 1))
    gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 1)
    if algorithm == QUASI:
        # Sizes as asked for, not those of its own automatic size map.
        gmsh.option.setNumber("Mesh.QuadqsSizemapMethod", 0)
    gmsh.model.add("domain")
    domain.add_to(gmsh.model.occ)
    gmsh.model.occ.synchronize()
    gmsh.model.mesh.setSize(gmsh.model.getEntities(0), size * (2 if divided else 1))
    gmsh.model.mesh.generate(2)


def _read(order):
    kinds, _, nodes = gmsh.model.mesh.getElements(2)
    if not len(kinds):
        raise Failure("no elements")
    if len(kinds) != 1 or not gmsh.model.mesh.getElementProperties(kinds[0])[0].startswith("Quad"):
        raise Failure("not all elements are quadrilaterals")
    _, _, _, count, local, _ = gmsh.model.mesh.getElementProperties(kinds[0])
    tags, places, _ = gmsh.model.mesh.getNodes()
    at = np.zeros((int(tags.max()) + 1, 2))
    at[tags] = places.reshape(-1, 3)[:, :2]
    i, j = np.rint((local.reshape(count, 2) + 1) * order / 2).astype(int).T
    numbers = np.empty((len(nodes[0]) // count, order + 1, order + 1), np.int64)
    numbers[:, i, j] = nodes[0].reshape(-1, count)
    _, compact = np.unique(numbers, return_inverse=True)
    # Gmsh's nodes are equispaced.
    value, _ = basis(np.linspace(-1, 1, order + 1), lobatto(order))
    places = np.einsum("ai,bj,eijc->eabc", value, value, at[numbers])
    compact = compact.reshape(numbers.shape)
    # Some algorithms list corners clockwise, which is no fault.
    a, b = places[:, -1, -1] - places[:, 0, 0], places[:, 0, -1] - places[:, -1, 0]
    clockwise = a[:, 0] * b[:, 1] < a[:, 1] * b[:, 0]
    for array in (places, compact):
        array[clockwise] = array[clockwise].swapaxes(1, 2)
    return Mesh(places, compact)


def _work(domain, recipe, orders, optimiser, measure, seen, pipe):
    try:
        gmsh.initialize(["gmsh"], False, False)
        _generate(domain, recipe)
        made = hashlib.sha256(gmsh.model.mesh.getNodes()[1].tobytes()).digest()
        pipe.send((MADE, made))
        count = len(gmsh.model.mesh.getElementsByType(LINEAR_QUAD)[0])
        # Many sizes make the same mesh, on which nothing new is to be found out.
        for order in orders if made not in seen else ():
            try:
                # Orders are not given to meshes that are too fine for them: that alone takes long.
                if order**2 * count > measure.most:
                    raise Failure("too many unknowns")
                gmsh.model.mesh.setOrder(order)
                for method in OPTIMISERS[optimiser]:
                    gmsh.model.mesh.optimize(method)
                pipe.send((order, measure(_read(order))))
            except (Failure, ValueError) as error:
                pipe.send((order, str(error)))
    except Exception as error:
        pipe.send((None, str(error).strip() or type(error).__name__))
    pipe.close()
    os._exit(0)


def measured(domain, recipe, orders, optimiser, measure, seen):
    """`measure` of the mesh of each order, or a sentence that says why there is none: a dictionary by order, empty
    for a mesh whose digest is in `seen`, which is added to."""
    receive, send = multiprocessing.Pipe(False)
    context = multiprocessing.get_context("fork")
    process = context.Process(target=_work, args=(domain, recipe, orders, optimiser, measure, seen, send))
    process.start()
    send.close()
    results, why = {}, f"more than {PATIENCE} s"
    left = PATIENCE
    while receive.poll(left):
        try:
            order, result = receive.recv()
        except EOFError:
            why = "crashed"
            break
        if order == MADE:
            if result in seen:
                orders = ()
            seen.add(result)
        elif order is None:
            why = result
        else:
            results[order] = result
    if process.is_alive():
        process.kill()
    process.join()
    return {order: results.get(order, why) for order in orders}
