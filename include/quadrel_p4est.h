/*
 * quadrel_p4est.h - a mesh as a p4est forest: its elements are the trees, which p4est refines, balances and
 * distributes. Header only, C99 and C++. Link p4est and sc.
 *
 *     p4est_connectivity_t *trees = quadrel_p4est_connectivity(mesh);
 *     p4est_geometry_t *geometry = quadrel_p4est_geometry(mesh);
 *     p4est_t *forest = p4est_new(MPI_COMM_WORLD, trees, 0, NULL, NULL);
 *     ...
 *     p4est_destroy(forest);
 *     p4est_geometry_destroy(geometry);
 *     p4est_connectivity_destroy(trees);
 *
 * Tree t is element t of the mesh; x runs along its side 0 and y along its side 3, both from corner 0. The same
 * domain and options give the same mesh, to the bit, so every process may generate it for itself.
 */
#ifndef QUADREL_P4EST_H
#define QUADREL_P4EST_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>

#include <p4est_connectivity.h>
#include <p4est_geometry.h>

#include "quadrel.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The element's side (0 to 3, as in quadrel_mesh_element_boundaries) at p4est's face (-x, +x, -y, +y); -1 for other
 * faces. */
static inline int quadrel_p4est_side(int face) {
    static const int sides[4] = {3, 1, 0, 2};
    return face >= 0 && face < 4 ? sides[face] : -1;
}

/* The elements as trees, conforming at their sides and corners. Vertices are the elements' corners, in the plane
 * z = 0. The caller owns it (p4est_connectivity_destroy); the mesh may go. NULL if mesh is NULL. */
static inline p4est_connectivity_t *quadrel_p4est_connectivity(const quadrel_mesh *mesh) {
    static const int corner[4] = {0, 1, 3, 2}; /* p4est counts x before y */
    const size_t trees = quadrel_mesh_element_count(mesh), vertices = quadrel_mesh_vertex_count(mesh);
    p4est_connectivity_t *result;
    size_t t, v;
    int k;
    if (mesh == NULL) return NULL;
    result = p4est_connectivity_new((p4est_topidx_t)vertices, (p4est_topidx_t)trees, 0, 0);
    for (v = 0; v < vertices; ++v) {
        result->vertices[3 * v] = quadrel_mesh_vertices(mesh)[2 * v];
        result->vertices[3 * v + 1] = quadrel_mesh_vertices(mesh)[2 * v + 1];
        result->vertices[3 * v + 2] = 0.0;
    }
    for (t = 0; t < trees; ++t) {
        for (k = 0; k < 4; ++k) {
            result->tree_to_vertex[4 * t + (size_t)k] = quadrel_mesh_elements(mesh)[4 * t + (size_t)corner[k]];
            result->tree_to_tree[4 * t + (size_t)k] = (p4est_topidx_t)t;
            result->tree_to_face[4 * t + (size_t)k] = (int8_t)k;
        }
    }
    /* Trees that share two vertices share the side between them. */
    p4est_connectivity_complete(result);
    return result;
}

/* Values at x in [0, 1] of the Lagrange polynomials of the mesh's nodes. */
static inline void quadrel_p4est_basis(const quadrel_mesh *mesh, double x, double *values) {
    const double *nodes = quadrel_mesh_reference_nodes(mesh);
    const int row = quadrel_mesh_order(mesh) + 1;
    int i, k;
    for (i = 0; i < row; ++i) {
        values[i] = 1.0;
        for (k = 0; k < row; ++k) {
            if (k != i) values[i] *= (2.0 * x - 1.0 - nodes[k]) / (nodes[i] - nodes[k]);
        }
    }
}

/* The point of tree `tree` at (x, y) in [0, 1]^2: on the curved element. */
static inline void quadrel_p4est_point(p4est_geometry_t *geometry, p4est_topidx_t tree, const double reference[3], double xyz[3]) {
    const quadrel_mesh *mesh = (const quadrel_mesh *)geometry->user;
    const size_t row = (size_t)quadrel_mesh_order(mesh) + 1;
    const int32_t *numbers = quadrel_mesh_element_nodes(mesh) + (size_t)tree * row * row;
    const double *nodes = quadrel_mesh_nodes(mesh);
    double along[64], across[64]; /* orders end at 32 */
    size_t i, j;
    quadrel_p4est_basis(mesh, reference[0], along);
    quadrel_p4est_basis(mesh, reference[1], across);
    xyz[0] = xyz[1] = xyz[2] = 0.0;
    for (j = 0; j < row; ++j) {
        for (i = 0; i < row; ++i) {
            const double *node = nodes + 2 * (size_t)numbers[j * row + i];
            xyz[0] += along[i] * across[j] * node[0];
            xyz[1] += along[i] * across[j] * node[1];
        }
    }
}

static inline void quadrel_p4est_free_geometry(p4est_geometry_t *geometry) { P4EST_FREE(geometry); }

/* The curved elements as p4est's geometry, for p4est_vtk and solvers. The caller owns it
 * (p4est_geometry_destroy) and keeps the mesh as long. NULL if mesh is NULL. */
static inline p4est_geometry_t *quadrel_p4est_geometry(const quadrel_mesh *mesh) {
    p4est_geometry_t *result;
    if (mesh == NULL) return NULL;
    result = P4EST_ALLOC_ZERO(p4est_geometry_t, 1);
    result->name = "quadrel";
    result->user = (void *)(uintptr_t)mesh;
    result->X = quadrel_p4est_point;
    result->destroy = quadrel_p4est_free_geometry;
    return result;
}

#ifdef __cplusplus
}
#endif

#endif /* QUADREL_P4EST_H */
