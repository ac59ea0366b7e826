/* A mesh as a p4est forest on several processes: forest FOLDER, tests/domains. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include <p4est_algorithms.h>
#include <p4est_bits.h>
#include <p4est_extended.h>

#include "../support/check.h"
#include "quadrel.h"
#include "quadrel_p4est.h"

enum { FINEST = 4 };

/* Refines at one boundary of the domain. */
static int at_boundary(p4est_t *forest, p4est_topidx_t tree, p4est_quadrant_t *quadrant) {
    const quadrel_mesh *mesh = (const quadrel_mesh *)forest->user_pointer;
    const p4est_qcoord_t last = P4EST_ROOT_LEN - P4EST_QUADRANT_LEN(quadrant->level);
    const int touches[4] = {quadrant->x == 0, quadrant->x == last, quadrant->y == 0, quadrant->y == last};
    int face;
    for (face = 0; face < 4; ++face) {
        const int side = quadrel_p4est_side(face);
        if (touches[face] && quadrel_mesh_element_boundaries(mesh)[4 * tree + side] == 0) return quadrant->level < FINEST;
    }
    return 0;
}

/* The point of a face at s in [0, 1], along growing x or y. */
static void face_point(p4est_geometry_t *geometry, p4est_topidx_t tree, int face, double s, double xyz[3]) {
    const double fixed = face % 2, reference[3] = {face < 2 ? fixed : s, face < 2 ? s : fixed, 0.0};
    geometry->X(geometry, tree, reference, xyz);
}

/* Neighbours are those of the mesh, and trees that p4est joins meet on the same curve. */
static void joined(const quadrel_mesh *mesh, const p4est_connectivity_t *trees, p4est_geometry_t *geometry, double size) {
    p4est_topidx_t t;
    int face, k;
    for (t = 0; t < trees->num_trees; ++t) {
        for (face = 0; face < 4; ++face) {
            const p4est_topidx_t other = trees->tree_to_tree[4 * t + face];
            const int code = trees->tree_to_face[4 * t + face];
            const int32_t neighbor = quadrel_mesh_element_neighbors(mesh)[4 * t + quadrel_p4est_side(face)];
            if (neighbor < 0) {
                CHECK(other == t && code == face);
                continue;
            }
            CHECK(other == neighbor);
            for (k = 0; k <= 4; ++k) {
                double own[3], across[3];
                face_point(geometry, t, face, k / 4.0, own);
                face_point(geometry, other, code % 4, code >= 4 ? 1 - k / 4.0 : k / 4.0, across);
                CHECK(hypot(own[0] - across[0], own[1] - across[1]) < 1e-12 * size);
            }
        }
    }
}

static p4est_t *grown(sc_MPI_Comm processes, p4est_connectivity_t *trees, quadrel_mesh *mesh) {
    p4est_t *forest = p4est_new(processes, trees, 0, NULL, mesh);
    p4est_refine(forest, 1, at_boundary, NULL);
    p4est_balance(forest, P4EST_CONNECT_FULL, NULL);
    p4est_partition(forest, 0, NULL);
    CHECK(p4est_is_valid(forest) && p4est_is_balanced(forest, P4EST_CONNECT_FULL));
    return forest;
}

static void check(const char *folder, const char *file, int order) {
    char path[1024];
    quadrel_domain *domain = NULL;
    quadrel_options *options = quadrel_options_new();
    quadrel_mesh *mesh = NULL;
    p4est_connectivity_t *trees;
    p4est_geometry_t *geometry;
    p4est_t *alone, *together;
    double size = 0.0;
    size_t k;
    int processes;
    snprintf(path, sizeof path, "%s/%s", folder, file);
    OK(quadrel_domain_read(path, -1, &domain));
    OK(quadrel_options_set_order(options, order));
    OK(quadrel_options_set_relative_tolerance(options, 1e-3, QUADREL_NORM_L2));
    OK(quadrel_generate(domain, options, NULL, &mesh));
    if (mesh == NULL) return;
    for (k = 0; k < 2 * quadrel_mesh_node_count(mesh); ++k) size = fmax(size, fabs(quadrel_mesh_nodes(mesh)[k]));
    trees = quadrel_p4est_connectivity(mesh);
    geometry = quadrel_p4est_geometry(mesh);
    CHECK(trees != NULL && p4est_connectivity_is_valid(trees));
    CHECK((size_t)trees->num_trees == quadrel_mesh_element_count(mesh));
    joined(mesh, trees, geometry, size);
    alone = grown(sc_MPI_COMM_SELF, trees, mesh);
    together = grown(sc_MPI_COMM_WORLD, trees, mesh);
    CHECK(alone->global_num_quadrants == together->global_num_quadrants);
    CHECK(alone->global_num_quadrants > 2 * trees->num_trees);
    sc_MPI_Comm_size(sc_MPI_COMM_WORLD, &processes);
    if (together->mpirank == 0) {
        printf("%s: %ld trees, %ld quadrants on %d processes, %ld on the first\n", file, (long)trees->num_trees,
               (long)together->global_num_quadrants, processes, (long)together->local_num_quadrants);
    }
    CHECK(processes == 1 || together->local_num_quadrants < together->global_num_quadrants);
    p4est_destroy(together);
    p4est_destroy(alone);
    p4est_geometry_destroy(geometry);
    p4est_connectivity_destroy(trees);
    quadrel_mesh_free(mesh);
    quadrel_options_free(options);
    quadrel_domain_free(domain);
}

int main(int argc, char **argv) {
    if (argc != 2) return fprintf(stderr, "usage: forest FOLDER\n"), 2;
    if (sc_MPI_Init(&argc, &argv) != sc_MPI_SUCCESS) return 2;
    sc_init(sc_MPI_COMM_WORLD, 1, 1, NULL, SC_LP_ERROR);
    p4est_init(NULL, SC_LP_ERROR);
    CHECK(quadrel_p4est_connectivity(NULL) == NULL && quadrel_p4est_geometry(NULL) == NULL);
    check(argv[1], "hohq/NACA0012.control", 5);
    check(argv[1], "hohq/GingerbreadMan.control", 4);
    check(argv[1], "glyphs/DejaVuSans/u0038.svg", 7);
    sc_finalize();
    CHECK(sc_MPI_Finalize() == sc_MPI_SUCCESS);
    return failures != 0;
}
