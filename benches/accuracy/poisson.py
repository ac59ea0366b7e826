"""Poisson's equation on a mesh of curved quadrilaterals, continuous elements of the mesh's own order (spectral/hp).

Knows nothing of mesh generators: a mesh is the Gauss-Lobatto nodes of its elements and their numbers. Insides of
elements are condensed, what is left is solved directly, integrals are over-integrated Gauss sums.
"""

import numpy as np
from numpy.polynomial import legendre
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu

# Gauss points a direction beyond the order: Jacobians of curved elements are no polynomials of the order.
EXTRA_POINTS = 4
# Elements whose matrices are made at a time.
BATCH = 64


def lobatto(order):
    """The Gauss-Lobatto points of [-1, 1]."""
    inner = legendre.legroots(legendre.legder([0.0] * order + [1.0]))
    points = np.concatenate([[-1.0], np.sort(inner), [1.0]])
    return 0.5 * (points - points[::-1])


def basis(nodes, points):
    """Values and derivatives at `points` of the polynomials that are 1 at one of `nodes` and 0 at the others."""
    degree = len(nodes) - 1
    inverse = np.linalg.inv(legendre.legvander(nodes, degree))
    derived = legendre.legder(np.eye(degree + 1), axis=0)
    return legendre.legvander(points, degree) @ inverse, legendre.legvander(points, degree - 1) @ derived @ inverse


class Mesh:
    """Elements x nodes along the first side x nodes along the last side: places (x, y), and numbers of nodes."""

    def __init__(self, places, numbers):
        self.places, self.numbers = places, numbers
        self.order = places.shape[1] - 1
        self.count = int(numbers.max()) + 1

    def boundary_sides(self):
        """Places and numbers of the nodes along the sides that belong to one element."""

        def sides(a):
            return np.concatenate([a[:, :, 0], a[:, -1, :], a[:, ::-1, -1], a[:, 0, ::-1]])

        numbers = sides(self.numbers)
        # By all nodes: the two sides of an airfoil may have the same ends.
        _, index, times = np.unique(np.sort(numbers, axis=1), axis=0, return_inverse=True, return_counts=True)
        if times.max() > 2:
            raise ValueError("three elements share a side")
        single = times[index.ravel()] == 1
        return sides(self.places)[single], numbers[single]


class Folded(ValueError):
    """An element's Jacobian is not positive everywhere."""


def solve(mesh, exact, laplacian):
    """Relative L2 error, over the mesh, of the solution whose boundary values are `exact`'s."""
    order = mesh.order
    nodes = lobatto(order)
    points, weights = legendre.leggauss(order + EXTRA_POINTS)
    value, slope = basis(nodes, points)
    per_element = (order + 1) ** 2
    inside = np.zeros((order + 1, order + 1), bool)
    inside[1:-1, 1:-1] = True
    inner, outer = np.flatnonzero(inside), np.flatnonzero(~inside)
    both = np.einsum("qi,rj->qrij", value, value).reshape(-1, per_element)
    along = np.stack([np.einsum("qi,rj->qrij", slope, value), np.einsum("qi,rj->qrij", value, slope)])
    along = along.reshape(2, -1, per_element)
    weight = np.outer(weights, weights).ravel()
    places = mesh.places.reshape(-1, per_element, 2)
    numbers = mesh.numbers.reshape(-1, per_element)

    schur, loads, recover = [], [], []
    scale = np.ptp(places.reshape(-1, 2), axis=0).max()
    for k in range(0, len(places), BATCH):
        x = places[k : k + BATCH]
        jacobian = np.einsum("dqi,eic->eqcd", along, x)
        determinant = np.linalg.det(jacobian)
        if determinant.min() <= 1e-12 * scale**2 * 1e-6:
            raise Folded("an element's Jacobian is not positive")
        at = both @ x
        inverse = np.linalg.inv(jacobian)
        metric = np.einsum("eqdc,eqfc,eq->eqdf", inverse, inverse, determinant * weight)
        flux = np.einsum("eqdf,fqi->edqi", metric, along)
        matrix = np.zeros((len(x), per_element, per_element))
        for d in range(2):
            matrix += along[d].T @ flux[:, d]
        source = -laplacian(at[..., 0], at[..., 1]) * determinant * weight @ both
        a_ii = matrix[:, inner[:, None], inner]
        a_io = matrix[:, inner[:, None], outer]
        both_sides = np.concatenate([a_io, source[:, inner, None]], axis=2)
        solved = np.linalg.solve(a_ii, both_sides)
        a_oi = np.swapaxes(a_io, 1, 2)
        schur.append(matrix[:, outer[:, None], outer] - a_oi @ solved[:, :, :-1])
        loads.append(source[:, outer] - (a_oi @ solved[:, :, -1:])[..., 0])
        recover.append(solved)
    schur, loads, recover = np.concatenate(schur), np.concatenate(loads), np.concatenate(recover)

    skeleton, index = np.unique(numbers[:, outer], return_inverse=True)
    index = index.reshape(len(places), -1)
    at = np.empty((len(skeleton), 2))
    at[index.ravel()] = places[:, outer].reshape(-1, 2)
    given = np.zeros(len(skeleton), bool)
    given[np.searchsorted(skeleton, mesh.boundary_sides()[1].ravel())] = True
    u = np.zeros(len(skeleton))
    u[given] = exact(at[given, 0], at[given, 1])
    rows = np.repeat(index, index.shape[1], axis=1).ravel()
    columns = np.tile(index, (1, index.shape[1])).ravel()
    matrix = coo_matrix((schur.ravel(), (rows, columns)), shape=(len(u), len(u))).tocsc()
    load = np.bincount(index.ravel(), loads.ravel(), len(u)) - matrix @ u
    free = ~given
    if free.any():
        factor = splu(matrix[free][:, free], permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
        u[free] = factor.solve(load[free])
    whole = np.empty((len(places), per_element))
    whole[:, outer] = u[index]
    whole[:, inner] = recover[:, :, -1] - np.einsum("eio,eo->ei", recover[:, :, :-1], u[index])

    error = norm = 0.0
    for k in range(0, len(places), BATCH):
        x = places[k : k + BATCH]
        determinant = np.linalg.det(np.einsum("dqi,eic->eqcd", along, x))
        at = both @ x
        wanted = exact(at[..., 0], at[..., 1])
        error += np.sum((whole[k : k + BATCH] @ both.T - wanted) ** 2 * determinant * weight)
        norm += np.sum(wanted**2 * determinant * weight)
    return float(np.sqrt(error / norm))


def scaled_jacobian(mesh):
    """The least one on a grid of 2N + 1 points a direction, corners included."""
    value, slope = basis(lobatto(mesh.order), np.linspace(-1, 1, 2 * mesh.order + 1))
    a = np.einsum("qi,rj,eijc->eqrc", slope, value, mesh.places)
    b = np.einsum("qi,rj,eijc->eqrc", value, slope, mesh.places)
    product = np.linalg.norm(a, axis=-1) * np.linalg.norm(b, axis=-1)
    return float(np.min((a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]) / np.maximum(product, 1e-300)))
