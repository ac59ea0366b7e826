/* The mesh's arrays agree with each other and with what is known of a plate with a hole; quality; files. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../support/check.h"
#include "../support/shapes.h"

#define ORDER 4
#define ROW (ORDER + 1)

static void topology(const quadrel_mesh *mesh) {
    const size_t vertices = quadrel_mesh_vertex_count(mesh), edges = quadrel_mesh_edge_count(mesh);
    const size_t elements = quadrel_mesh_element_count(mesh);
    const int32_t *corners = quadrel_mesh_elements(mesh), *neighbors = quadrel_mesh_element_neighbors(mesh);
    const int32_t *own_edges = quadrel_mesh_element_edges(mesh), *sides = quadrel_mesh_edge_sides(mesh);
    const int32_t *ends = quadrel_mesh_edge_vertices(mesh), *beside = quadrel_mesh_edge_elements(mesh);
    const int32_t *boundaries = quadrel_mesh_element_boundaries(mesh);
    const int32_t *edge_boundaries = quadrel_mesh_edge_boundaries(mesh);
    size_t e, border = 0;
    int s;

    /* One hole: Euler's number is 0. */
    CHECK(elements > 0 && vertices + elements == edges);
    for (e = 0; e < elements; ++e) {
        for (s = 0; s < 4; ++s) {
            const int32_t edge = own_edges[4 * e + s];
            const int right = beside[2 * edge] != (int32_t)e;
            CHECK(beside[2 * edge + right] == (int32_t)e && sides[2 * edge + right] == s);
            CHECK(neighbors[4 * e + s] == beside[2 * edge + 1 - right]);
            CHECK(ends[2 * edge + right] == corners[4 * e + s]);
            CHECK(ends[2 * edge + 1 - right] == corners[4 * e + (s + 1) % 4]);
            CHECK(boundaries[4 * e + s] == edge_boundaries[edge]);
            CHECK((neighbors[4 * e + s] == -1) == (boundaries[4 * e + s] >= 0));
        }
        CHECK(quadrel_mesh_element_blocks(mesh)[e] >= 0);
    }
    for (e = 0; e < edges; ++e) border += beside[2 * e + 1] == -1;
    CHECK(border >= 8);
}

static void names(const quadrel_mesh *mesh) {
    size_t b, found = 0;
    CHECK(quadrel_mesh_boundary_count(mesh) == 2);
    for (b = 0; b < 2; ++b) {
        const char *name = quadrel_mesh_boundary_name(mesh, (int32_t)b);
        found += strcmp(name, "square") == 0 || strcmp(name, "hole") == 0;
    }
    CHECK(found == 2);
    CHECK(quadrel_mesh_boundary_name(mesh, 2) == NULL && quadrel_mesh_boundary_name(mesh, -1) == NULL);
}

static void nodes(const quadrel_mesh *mesh) {
    const double *at = quadrel_mesh_nodes(mesh), *vertices = quadrel_mesh_vertices(mesh);
    const double *reference = quadrel_mesh_reference_nodes(mesh);
    const int32_t *own = quadrel_mesh_element_nodes(mesh), *corners = quadrel_mesh_elements(mesh);
    const size_t elements = quadrel_mesh_element_count(mesh), inside = ORDER - 1;
    size_t e;

    CHECK(quadrel_mesh_order(mesh) == ORDER);
    CHECK(reference[0] == -1 && reference[ORDER] == 1 && fabs(reference[ORDER / 2]) < 1e-15);
    CHECK(quadrel_mesh_node_count(mesh) == quadrel_mesh_vertex_count(mesh) +
                                               inside * quadrel_mesh_edge_count(mesh) + inside * inside * elements);
    CHECK(memcmp(at, vertices, 2 * quadrel_mesh_vertex_count(mesh) * sizeof *at) == 0);
    for (e = 0; e < elements; ++e) {
        const int32_t *mine = own + e * ROW * ROW;
        CHECK(mine[0] == corners[4 * e] && mine[ORDER] == corners[4 * e + 1]);
        CHECK(mine[ROW * ROW - 1] == corners[4 * e + 2] && mine[ROW * ORDER] == corners[4 * e + 3]);
    }
}

/* Boundary edges tell where on the caller's curves their vertices are. */
static void places(const quadrel_mesh *mesh) {
    const double *vertices = quadrel_mesh_vertices(mesh), *t = quadrel_mesh_edge_parameters(mesh);
    const int32_t *loops = quadrel_mesh_edge_loops(mesh), *segments = quadrel_mesh_edge_segments(mesh);
    const int32_t *ends = quadrel_mesh_edge_vertices(mesh), *beside = quadrel_mesh_edge_elements(mesh);
    size_t e, k;
    for (e = 0; e < quadrel_mesh_edge_count(mesh); ++e) {
        CHECK((loops[e] == -1) == (beside[2 * e + 1] != -1));
        if (loops[e] != 1) continue;
        for (k = 0; k < 2; ++k) {
            const double *p = vertices + 2 * ends[2 * e + k], angle = 2 * TEST_PI * t[2 * e + k];
            CHECK(segments[2 * e + k] == 0);
            CHECK(fabs(p[0] - cos(angle)) < 1e-9 && fabs(p[1] - sin(angle)) < 1e-9);
        }
    }
}

static void quality(const quadrel_mesh *mesh) {
    const size_t count = quadrel_mesh_element_count(mesh);
    double *value = malloc(count * sizeof *value), min = 0, max = 0, mean = 0;
    quadrel_measure m;
    size_t e;
    for (m = QUADREL_MEASURE_SCALED_JACOBIAN; m <= QUADREL_MEASURE_JACOBIAN_RATIO; ++m) {
        double low = HUGE_VAL, high = -HUGE_VAL, sum = 0;
        OK(quadrel_mesh_quality(mesh, m, value, count));
        OK(quadrel_mesh_quality_range(mesh, m, &min, &max, &mean));
        for (e = 0; e < count; ++e) {
            low = fmin(low, value[e]);
            high = fmax(high, value[e]);
            sum += value[e];
        }
        CHECK(low == min && high == max && fabs(sum / (double)count - mean) < 1e-12);
        if (m == QUADREL_MEASURE_SCALED_JACOBIAN) CHECK(min > 0.4 && max <= 1);
        if (m == QUADREL_MEASURE_AREA) CHECK(fabs(sum - (16 - TEST_PI)) < 1e-3);
        if (m == QUADREL_MEASURE_MIN_ANGLE) CHECK(min > 0 && max <= TEST_PI / 2 + 1e-9);
        if (m == QUADREL_MEASURE_MAX_ANGLE) CHECK(min >= TEST_PI / 2 - 1e-9 && max < TEST_PI);
        if (m == QUADREL_MEASURE_ASPECT_RATIO || m == QUADREL_MEASURE_EDGE_RATIO || m == QUADREL_MEASURE_CONDITION)
            CHECK(min >= 1 - 1e-12 && max < 20);
        if (m == QUADREL_MEASURE_BOUNDARY_ERROR) CHECK(min >= 0 && max > 0 && max <= 1e-3);
    }
    OK(quadrel_mesh_quality_range(mesh, 0, NULL, NULL, NULL));
    CHECK_STATUS(quadrel_mesh_quality(mesh, 99, value, count), QUADREL_ERROR_INVALID_ARGUMENT);
    CHECK_STATUS(quadrel_mesh_quality(mesh, -1, value, count), QUADREL_ERROR_INVALID_ARGUMENT);
    CHECK_STATUS(quadrel_mesh_quality(mesh, 0, value, count - 1), QUADREL_ERROR_INVALID_ARGUMENT);
    CHECK_STATUS(quadrel_mesh_quality(mesh, 0, NULL, count), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_mesh_quality(NULL, 0, value, count), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_mesh_quality_range(NULL, 0, &min, &max, &mean), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_mesh_quality_range(mesh, 99, &min, &max, &mean), QUADREL_ERROR_INVALID_ARGUMENT);
    free(value);
}

static int count_bytes(void *user, const void *bytes, size_t count) {
    CHECK(bytes != NULL && count > 0);
    *(size_t *)user += count;
    return 0;
}

static int refuse_bytes(void *user, const void *bytes, size_t count) {
    (void)bytes;
    (void)count;
    ++*(size_t *)user;
    return 1;
}

static void files(const quadrel_mesh *mesh) {
    const quadrel_format formats[8] = {QUADREL_FORMAT_VTU,    QUADREL_FORMAT_MSH, QUADREL_FORMAT_ISM,  QUADREL_FORMAT_ISM_V2,
                                       QUADREL_FORMAT_ISM_MM, QUADREL_FORMAT_INP, QUADREL_FORMAT_MFEM, QUADREL_FORMAT_SVG};
    int k;
    for (k = 0; k < 8; ++k) {
        size_t streamed = 0, calls = 0;
        FILE *file;
        OK(quadrel_mesh_write(mesh, formats[k], "plate.out"));
        OK(quadrel_mesh_write_to(mesh, formats[k], count_bytes, &streamed));
        file = fopen("plate.out", "rb");
        CHECK(file != NULL);
        if (file != NULL) {
            fseek(file, 0, SEEK_END);
            CHECK((size_t)ftell(file) == streamed && streamed > 100);
            fclose(file);
        }
        CHECK_STATUS(quadrel_mesh_write_to(mesh, formats[k], refuse_bytes, &calls), QUADREL_ERROR_CANCELLED);
        CHECK(calls == 1);
    }
    remove("plate.out");
    CHECK_STATUS(quadrel_mesh_write(mesh, QUADREL_FORMAT_VTU, "no/such/folder/a.vtu"), QUADREL_ERROR_IO);
    CHECK_STATUS(quadrel_mesh_write(mesh, 99, "a.msh"), QUADREL_ERROR_INVALID_ARGUMENT);
    CHECK_STATUS(quadrel_mesh_write(mesh, QUADREL_FORMAT_VTU, NULL), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_mesh_write(NULL, QUADREL_FORMAT_VTU, "a.vtu"), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_mesh_write_to(mesh, QUADREL_FORMAT_VTU, NULL, NULL), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_mesh_write_to(NULL, QUADREL_FORMAT_VTU, count_bytes, NULL), QUADREL_ERROR_NULL);
}

static void nothing(void) {
    CHECK(quadrel_mesh_order(NULL) == 0 && quadrel_mesh_vertex_count(NULL) == 0);
    CHECK(quadrel_mesh_element_count(NULL) == 0 && quadrel_mesh_edge_count(NULL) == 0);
    CHECK(quadrel_mesh_node_count(NULL) == 0 && quadrel_mesh_boundary_count(NULL) == 0);
    CHECK(!quadrel_mesh_vertices(NULL) && !quadrel_mesh_elements(NULL) && !quadrel_mesh_element_neighbors(NULL));
    CHECK(!quadrel_mesh_element_edges(NULL) && !quadrel_mesh_element_boundaries(NULL));
    CHECK(!quadrel_mesh_element_blocks(NULL) && !quadrel_mesh_edge_vertices(NULL) && !quadrel_mesh_edge_elements(NULL));
    CHECK(!quadrel_mesh_edge_sides(NULL) && !quadrel_mesh_edge_boundaries(NULL) && !quadrel_mesh_edge_loops(NULL));
    CHECK(!quadrel_mesh_edge_segments(NULL) && !quadrel_mesh_edge_parameters(NULL) && !quadrel_mesh_nodes(NULL));
    CHECK(!quadrel_mesh_element_nodes(NULL) && !quadrel_mesh_reference_nodes(NULL));
    CHECK(!quadrel_mesh_boundary_name(NULL, 0) && !quadrel_mesh_statistics_json(NULL));
}

int main(void) {
    quadrel_domain *plate = new_plate();
    quadrel_options *options = quadrel_options_new();
    quadrel_mesh *mesh = NULL;
    OK(quadrel_options_set_order(options, ORDER));
    OK(quadrel_options_set_tolerance(options, 1e-3, QUADREL_NORM_L2));
    OK(quadrel_generate(plate, options, NULL, &mesh));
    /* The mesh needs neither. */
    quadrel_domain_free(plate);
    quadrel_options_free(options);
    if (mesh != NULL) {
        topology(mesh);
        names(mesh);
        nodes(mesh);
        places(mesh);
        quality(mesh);
        files(mesh);
        CHECK(strstr(quadrel_mesh_statistics_json(mesh), "\"status\": \"ok\"") != NULL);
        CHECK(strstr(quadrel_mesh_statistics_json(mesh), "\"warnings\": [") != NULL);
    }
    quadrel_mesh_free(mesh);
    nothing();
    return failures != 0;
}
