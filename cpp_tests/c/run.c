/* Options and what they do, stages, every kind of segment, domains from files. argv[1]: tests/domains. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../support/check.h"
#include "../support/shapes.h"

static void options_out_of_range(void) {
    quadrel_options *o = quadrel_options_new();
    const quadrel_status bad = QUADREL_ERROR_INVALID_ARGUMENT;
    CHECK_STATUS(quadrel_options_set_order(o, 0), bad);
    CHECK_STATUS(quadrel_options_set_order(o, -1), bad);
    CHECK_STATUS(quadrel_options_set_order(o, 33), bad);
    CHECK_STATUS(quadrel_options_set_tolerance(o, 0, QUADREL_NORM_L2), bad);
    CHECK_STATUS(quadrel_options_set_tolerance(o, -1, QUADREL_NORM_L2), bad);
    CHECK_STATUS(quadrel_options_set_tolerance(o, sqrt(-1.0), QUADREL_NORM_L2), bad);
    CHECK_STATUS(quadrel_options_set_tolerance(o, 1, 3), bad);
    CHECK_STATUS(quadrel_options_set_relative_tolerance(o, HUGE_VAL, QUADREL_NORM_L2), bad);
    CHECK_STATUS(quadrel_options_set_relative_tolerance(o, 1, -1), bad);
    CHECK_STATUS(quadrel_options_set_field(o, 2), bad);
    CHECK_STATUS(quadrel_options_set_subdivision(o, 2147483647), bad);
    CHECK_STATUS(quadrel_options_set_symmetry(o, 2), bad);
    CHECK_STATUS(quadrel_options_set_effort(o, 3), bad);
    CHECK_STATUS(quadrel_options_set_max_element_size(o, -1), bad);
    CHECK_STATUS(quadrel_options_set_base_mesh_size(o, HUGE_VAL), bad);
    CHECK_STATUS(quadrel_options_set_quality_floor(o, 0), bad);
    CHECK_STATUS(quadrel_options_set_quality_floor(o, 1), bad);
    CHECK_STATUS(quadrel_options_set_max_elements(o, 0), bad);
    {
        const double p[2] = {0, 0};
        const int32_t t[3] = {0, 0, 0};
        CHECK_STATUS(quadrel_options_set_base_triangulation(o, NULL, 1, t, 1, t, p, 1), QUADREL_ERROR_NULL);
        CHECK_STATUS(quadrel_options_set_base_triangulation(o, p, 1, NULL, 1, t, p, 1), QUADREL_ERROR_NULL);
        CHECK_STATUS(quadrel_options_set_base_triangulation(o, p, 1, t, 1, NULL, p, 1), QUADREL_ERROR_NULL);
        CHECK_STATUS(quadrel_options_set_base_triangulation(o, p, 1, t, 1, t, NULL, 1), QUADREL_ERROR_NULL);
        CHECK_STATUS(quadrel_options_set_base_triangulation(o, p, (size_t)-1, t, 1, t, p, 1), bad);
        CHECK_STATUS(quadrel_options_set_base_triangulation(NULL, p, 1, t, 1, t, p, 1), QUADREL_ERROR_NULL);
        OK(quadrel_options_set_base_triangulation(o, NULL, 0, NULL, 0, NULL, NULL, 0));
    }
    OK(quadrel_options_set_max_element_size(o, 0));
    OK(quadrel_options_set_base_mesh_size(o, 0));
    OK(quadrel_options_set_progress(o, NULL, NULL, NULL));
    OK(quadrel_options_set_size_function(o, NULL, NULL, NULL));
    quadrel_options_free(o);

    CHECK_STATUS(quadrel_options_set_order(NULL, 1), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_options_set_tolerance(NULL, 1, 0), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_options_set_relative_tolerance(NULL, 1, 0), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_options_set_field(NULL, 0), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_options_set_subdivision(NULL, 0), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_options_set_symmetry(NULL, 1), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_options_set_effort(NULL, 1), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_options_set_max_element_size(NULL, 1), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_options_set_base_mesh_size(NULL, 1), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_options_set_quality_floor(NULL, 0.5), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_options_set_max_elements(NULL, 1), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_options_set_progress(NULL, NULL, NULL, NULL), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_options_set_size_function(NULL, NULL, NULL, NULL), QUADREL_ERROR_NULL);
}

/* Small elements at the left; fails outside of the plate. */
static int size_at(void *user, const double *xy, double *size) {
    if (user) return 8;
    if (xy[0] < -2.01 || xy[0] > 2.01 || xy[1] < -2.01 || xy[1] > 2.01) return 7;
    *size = xy[0] < 0 ? 0.4 : 2;
    return 0;
}

/* Elements of the plate under options; 0 on failure. */
static size_t elements(const quadrel_options *options) {
    quadrel_domain *plate = new_plate();
    quadrel_mesh *mesh = NULL;
    size_t count;
    OK(quadrel_generate(plate, options, NULL, &mesh));
    count = quadrel_mesh_element_count(mesh);
    quadrel_mesh_free(mesh);
    quadrel_domain_free(plate);
    return count;
}

/* Whether the statistics of the plate's mesh under options tell its symmetries. */
static int looks_for_symmetry(const quadrel_options *options) {
    quadrel_domain *plate = new_plate();
    quadrel_mesh *mesh = NULL;
    const char *symmetry;
    int looks;
    OK(quadrel_generate(plate, options, NULL, &mesh));
    symmetry = strstr(quadrel_mesh_statistics_json(mesh), "\"symmetry\":");
    CHECK(symmetry != NULL);
    looks = symmetry != NULL && strstr(symmetry, "\"mirrors\":") != NULL;
    quadrel_mesh_free(mesh);
    quadrel_domain_free(plate);
    return looks;
}

static void options_do_something(void) {
    quadrel_options *o = quadrel_options_new();
    quadrel_norm norm;
    size_t usual = elements(NULL);
    CHECK(usual > 0 && elements(o) == usual);
    OK(quadrel_options_set_max_element_size(o, 0.5));
    CHECK(elements(o) > usual);
    quadrel_options_free(o);

    o = quadrel_options_new();
    OK(quadrel_options_set_size_function(o, size_at, NULL, NULL));
    {
        /* Half of the plate is 16 / 2 - pi / 2 = 6.4 large: 40 elements of 0.4 squared. */
        const size_t graded = elements(o);
        CHECK(graded > 40 && graded > usual);
        OK(quadrel_options_set_size_function(o, NULL, NULL, NULL));
        CHECK(elements(o) == usual);
    }
    quadrel_options_free(o);

    o = quadrel_options_new();
    CHECK(looks_for_symmetry(o));
    OK(quadrel_options_set_symmetry(o, QUADREL_SYMMETRY_IGNORED));
    CHECK(!looks_for_symmetry(o));
    OK(quadrel_options_set_symmetry(o, QUADREL_SYMMETRY_KEPT));
    CHECK(looks_for_symmetry(o));
    quadrel_options_free(o);

    for (norm = QUADREL_NORM_L2; norm <= QUADREL_NORM_MAX; ++norm) {
        o = quadrel_options_new();
        OK(quadrel_options_set_relative_tolerance(o, 1e-4, norm));
        OK(quadrel_options_set_base_mesh_size(o, 0.3));
        OK(quadrel_options_set_quality_floor(o, 0.5));
        CHECK(elements(o) > 0);
        quadrel_options_free(o);
    }
    o = quadrel_options_new();
    OK(quadrel_options_set_field(o, QUADREL_FIELD_HARMONIC));
    OK(quadrel_options_set_subdivision(o, QUADREL_SUBDIVISION_HALVING));
    CHECK(elements(o) >= usual);
    quadrel_options_free(o);
}

static void stages_of_a_run(void) {
    quadrel_domain *plate = new_plate();
    quadrel_options *options = quadrel_options_new();
    quadrel_stages *stages = quadrel_stages_new();
    quadrel_mesh *mesh = NULL;
    quadrel_picture picture;
    quadrel_stage stage;
    size_t k, corners;
    double sum = 0;

    CHECK(quadrel_stages_reached(stages) == QUADREL_STAGE_NONE && quadrel_stages_block_count(stages) == 0);
    CHECK(quadrel_stages_statistics_json(stages) == NULL && quadrel_stages_base_vertices(stages) == NULL);
    CHECK_STATUS(quadrel_stages_write_svg(stages, QUADREL_PICTURE_ALL, "s.svg"), QUADREL_ERROR_UNSUPPORTED);

    OK(quadrel_generate(plate, NULL, stages, &mesh));
    CHECK(quadrel_stages_reached(stages) == QUADREL_STAGE_MESH);
    for (stage = QUADREL_STAGE_DOMAIN; stage <= QUADREL_STAGE_MESH; ++stage) sum += quadrel_stages_seconds(stages, stage);
    CHECK(sum > 0 && quadrel_stages_seconds(stages, 0) == 0 && quadrel_stages_seconds(stages, 77) == 0);
    CHECK(quadrel_stages_seconds(stages, -2147483647 - 1) == 0);
    CHECK(quadrel_stages_base_vertex_count(stages) > 10);
    for (k = 0; k < 3 * quadrel_stages_base_triangle_count(stages); ++k) {
        const int32_t v = quadrel_stages_base_triangles(stages)[k];
        CHECK(v >= 0 && (size_t)v < quadrel_stages_base_vertex_count(stages));
    }
    /* On the straight walls, away from the corners, the crosses are upright: cos 4a = 1, sin 4a = 0. */
    for (k = 0; k < quadrel_stages_base_vertex_count(stages); ++k) {
        const double *p = quadrel_stages_base_vertices(stages) + 2 * k, *u = quadrel_stages_cross_field(stages) + 2 * k;
        if (fabs(fabs(p[0]) - 2) < 1e-9 && fabs(p[1]) < 1) CHECK(fabs(u[0] - 1) < 1e-6 && fabs(u[1]) < 1e-6);
    }
    corners = quadrel_stages_corner_count(stages);
    CHECK(corners == 4);
    for (k = 0; k < corners; ++k) {
        const double *p = quadrel_stages_corner_points(stages) + 2 * k;
        CHECK(fabs(fabs(p[0]) - 2) < 1e-6 && fabs(fabs(p[1]) - 2) < 1e-6);
        CHECK(fabs(quadrel_stages_corner_angles(stages)[k] - TEST_PI / 2) < 1e-6);
        CHECK(quadrel_stages_corner_quads(stages)[k] == 1);
    }
    /* The index theorem: 4 = corners, so 4-valent-minus-5-valent points balance the hole. */
    sum = 0;
    for (k = 0; k < quadrel_stages_singularity_count(stages); ++k) {
        sum += 4 - quadrel_stages_singularity_valences(stages)[k];
        CHECK(fabs(quadrel_stages_singularity_points(stages)[2 * k]) < 2);
    }
    CHECK(sum == -4);
    CHECK(quadrel_stages_separatrix_count(stages) >= 1);
    CHECK(quadrel_stages_separatrix_offsets(stages)[0] == 0);
    CHECK(quadrel_stages_block_count(stages) >= 1);
    for (k = 0; k < quadrel_stages_block_count(stages); ++k) {
        const size_t *at = quadrel_stages_block_offsets(stages) + k;
        const double *points = quadrel_stages_block_points(stages);
        CHECK(at[1] > at[0] + 3);
        CHECK(fabs(points[2 * at[0]] - points[2 * (at[1] - 1)]) < 1e-9);
        CHECK(quadrel_stages_block_sides(stages)[k] >= 3);
    }
    CHECK(quadrel_stages_separatrix_points(stages) != NULL);
    CHECK(strcmp(quadrel_stages_statistics_json(stages), quadrel_mesh_statistics_json(mesh)) == 0);
    for (picture = QUADREL_PICTURE_BOUNDARY; picture <= QUADREL_PICTURE_BLOCKS; ++picture) {
        OK(quadrel_stages_write_svg(stages, picture, "s.svg"));
    }
    OK(quadrel_stages_write_svg(stages, QUADREL_PICTURE_ALL, "s.svg"));
    CHECK(remove("s.svg") == 0);
    CHECK_STATUS(quadrel_stages_write_svg(stages, 55, "s.svg"), QUADREL_ERROR_INVALID_ARGUMENT);
    CHECK_STATUS(quadrel_stages_write_svg(stages, -1, "s.svg"), QUADREL_ERROR_INVALID_ARGUMENT);
    CHECK_STATUS(quadrel_stages_write_svg(stages, 0, NULL), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_stages_write_svg(NULL, 0, "s.svg"), QUADREL_ERROR_NULL);
    quadrel_mesh_free(mesh);

    /* A failure keeps what was reached, and no mesh is given out. */
    mesh = NULL;
    OK(quadrel_options_set_max_elements(options, 1));
    CHECK_STATUS(quadrel_generate(plate, options, stages, &mesh), QUADREL_ERROR_LAYOUT);
    CHECK(mesh == NULL && quadrel_stages_reached(stages) >= QUADREL_STAGE_LAYOUT);
    CHECK(strstr(quadrel_stages_statistics_json(stages), "\"status\": \"layout\"") != NULL);
    quadrel_stages_free(stages);
    quadrel_options_free(options);
    quadrel_domain_free(plate);
}

/* A tolerance below rounding is refused, with a place on the boundary. */
static void tolerance_below_rounding(void) {
    quadrel_domain *plate = new_plate();
    quadrel_options *o = quadrel_options_new();
    quadrel_mesh *mesh = NULL;
    double at[2] = {0, 0};
    OK(quadrel_options_set_relative_tolerance(o, 1e-18, QUADREL_NORM_L2));
    CHECK_STATUS(quadrel_generate(plate, o, NULL, &mesh), QUADREL_ERROR_TOLERANCE);
    CHECK(!mesh && strstr(quadrel_last_error_message(), "tolerance"));
    CHECK(quadrel_last_error_location(at) && fabs(at[0]) <= 2 && fabs(at[1]) <= 2);
    quadrel_options_free(o);
    quadrel_domain_free(plate);
}

static void no_stages(void) {
    CHECK(quadrel_stages_reached(NULL) == QUADREL_STAGE_NONE && quadrel_stages_seconds(NULL, 1) == 0);
    CHECK(!quadrel_stages_statistics_json(NULL) && !quadrel_stages_base_vertex_count(NULL));
    CHECK(!quadrel_stages_base_triangle_count(NULL) && !quadrel_stages_base_vertices(NULL));
    CHECK(!quadrel_stages_base_triangles(NULL) && !quadrel_stages_cross_field(NULL));
    CHECK(!quadrel_stages_singularity_count(NULL) && !quadrel_stages_singularity_points(NULL));
    CHECK(!quadrel_stages_singularity_valences(NULL) && !quadrel_stages_corner_count(NULL));
    CHECK(!quadrel_stages_corner_points(NULL) && !quadrel_stages_corner_angles(NULL) && !quadrel_stages_corner_quads(NULL));
    CHECK(!quadrel_stages_separatrix_count(NULL) && !quadrel_stages_separatrix_offsets(NULL));
    CHECK(!quadrel_stages_separatrix_points(NULL) && !quadrel_stages_block_count(NULL));
    CHECK(!quadrel_stages_block_offsets(NULL) && !quadrel_stages_block_points(NULL) && !quadrel_stages_block_sides(NULL));
}

/* A loop of one segment of every kind. */
static void every_segment(void) {
    quadrel_domain *domain = quadrel_domain_new();
    quadrel_mesh *mesh = NULL;
    double area = 0;
    const double a[2] = {0, 0}, b[2] = {4, 0}, center[2] = {4, 1}, ellipse[2] = {2, 2}, radii[2] = {1, 0.5};
    const double bezier[8] = {4, 2, 3.8, 2.2, 3.3, 2, 3, 2}, spline[8] = {1, 2, 0.7, 2.2, 0.3, 2.1, 0, 2};
    OK(quadrel_domain_begin_loop(domain, QUADREL_LOOP_OUTER, "wall"));
    OK(quadrel_domain_add_line(domain, a, b, "bottom"));
    OK(quadrel_domain_add_arc(domain, center, 1, -TEST_PI / 2, TEST_PI / 2, NULL));
    OK(quadrel_domain_add_bezier(domain, bezier, 4, NULL));
    OK(quadrel_domain_add_elliptic_arc(domain, ellipse, radii, 0, 0, TEST_PI, NULL));
    OK(quadrel_domain_add_spline(domain, spline, 4, NULL));
    OK(quadrel_domain_add_expression(domain, "-0.2*sin(pi*t)", "2*(1 - t)", "left"));
    OK(quadrel_domain_end_loop(domain));
    OK(quadrel_domain_check(domain));
    OK(quadrel_generate(domain, NULL, NULL, &mesh));
    CHECK(quadrel_mesh_boundary_count(mesh) == 3);
    OK(quadrel_mesh_quality_range(mesh, QUADREL_MEASURE_AREA, NULL, NULL, &area));
    CHECK(area * (double)quadrel_mesh_element_count(mesh) > 9.5);
    quadrel_mesh_free(mesh);
    quadrel_domain_free(domain);
}

static void domains_from_files(const char *folder) {
    char path[1024];
    quadrel_domain *domain = NULL;
    quadrel_mesh *mesh = NULL;
    snprintf(path, sizeof path, "%s/hohq/PacMan.control", folder);
    OK(quadrel_domain_read(path, -1, &domain));
    OK(quadrel_domain_check(domain));
    CHECK(quadrel_domain_file_order(domain) > 0);
    CHECK(quadrel_domain_file_tolerance(domain) >= 0);
    OK(quadrel_generate(domain, NULL, NULL, &mesh));
    quadrel_mesh_free(mesh);
    quadrel_domain_free(domain);
    OK(quadrel_domain_read_string("<svg><path d='M0 0H3V2H0Z'/></svg>", QUADREL_INPUT_SVG, NULL, -1, &domain));
    mesh = NULL;
    OK(quadrel_generate(domain, NULL, NULL, &mesh));
    CHECK(quadrel_mesh_element_count(mesh) >= 1);
    quadrel_mesh_free(mesh);
    quadrel_domain_free(domain);
}

int main(int argc, char **argv) {
    options_out_of_range();
    options_do_something();
    stages_of_a_run();
    tolerance_below_rounding();
    no_stages();
    every_segment();
    if (argc > 1) domains_from_files(argv[1]);
    return failures != 0;
}
