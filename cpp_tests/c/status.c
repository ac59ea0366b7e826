/* Every status that a caller can provoke, with its message and place; NULL and unknown numbers. */
#include <math.h>
#include <string.h>

#include "../support/check.h"
#include "../support/shapes.h"

/* The status of checking a polygon. */
static quadrel_status polygon_status(const double *corners, size_t count) {
    quadrel_domain *domain = quadrel_domain_new();
    quadrel_status status;
    add_polygon(domain, QUADREL_LOOP_OUTER, corners, count, NULL);
    status = quadrel_domain_check(domain);
    quadrel_domain_free(domain);
    return status;
}

static int near(double a, double b) { return fabs(a - b) < 1e-6; }

static void domains_that_are_refused(void) {
    const double bow_tie[8] = {0, 0, 4, 4, 0, 4, 4, 0};
    const double needle[6] = {0, 0, 1, 0, 2, 0};
    double at[2] = {-7, -7};
    quadrel_domain *domain;

    CHECK_STATUS(polygon_status(bow_tie, 4), QUADREL_ERROR_INTERSECTION);
    CHECK(quadrel_last_error_location(at) == 1 && near(at[0], 2) && near(at[1], 2));
    CHECK(strstr(quadrel_last_error_message(), "cross") != NULL);
    CHECK(quadrel_last_error_location(NULL) == 1);
    CHECK(polygon_status(needle, 3) != QUADREL_OK);

    /* Open by a whole side. */
    domain = quadrel_domain_new();
    {
        const double a[2] = {0, 0}, b[2] = {1, 0}, c[2] = {1, 1};
        OK(quadrel_domain_begin_loop(domain, QUADREL_LOOP_OUTER, "open"));
        OK(quadrel_domain_add_line(domain, a, b, NULL));
        OK(quadrel_domain_add_line(domain, b, c, NULL));
        OK(quadrel_domain_end_loop(domain));
    }
    CHECK_STATUS(quadrel_domain_check(domain), QUADREL_ERROR_OPEN_LOOP);
    CHECK(quadrel_last_error_location(at) == 1);
    OK(quadrel_domain_set_join_tolerance(domain, 0.5));
    CHECK_STATUS(quadrel_domain_check(domain), QUADREL_ERROR_OPEN_LOOP);
    quadrel_domain_free(domain);

    /* No loop; a hole outside. */
    domain = quadrel_domain_new();
    CHECK_STATUS(quadrel_domain_check(domain), QUADREL_ERROR_NESTING);
    CHECK(quadrel_last_error_location(at) == 0);
    add_circle(domain, QUADREL_LOOP_OUTER, 0, 0, 1, NULL);
    add_circle(domain, QUADREL_LOOP_HOLE, 5, 0, 1, NULL);
    CHECK_STATUS(quadrel_domain_check(domain), QUADREL_ERROR_NESTING);
    quadrel_domain_free(domain);

    /* Two half circles that touch from inside: a cusp. */
    domain = quadrel_domain_new();
    {
        const double large[2] = {2, 0}, small[2] = {1, 0}, end[2] = {2, 0}, far_end[2] = {4, 0};
        OK(quadrel_domain_begin_loop(domain, QUADREL_LOOP_OUTER, NULL));
        OK(quadrel_domain_add_arc(domain, large, 2, 0, TEST_PI, NULL));
        OK(quadrel_domain_add_arc(domain, small, 1, TEST_PI, 0, NULL));
        OK(quadrel_domain_add_line(domain, end, far_end, NULL));
        OK(quadrel_domain_end_loop(domain));
    }
    CHECK_STATUS(quadrel_domain_check(domain), QUADREL_ERROR_CUSP);
    CHECK(quadrel_last_error_location(at) == 1 && near(at[0], 0) && near(at[1], 0));
    quadrel_domain_free(domain);

    /* A segment without extent. */
    domain = quadrel_domain_new();
    {
        const double a[2] = {0, 0}, b[2] = {1, 0}, c[2] = {1, 1};
        OK(quadrel_domain_begin_loop(domain, QUADREL_LOOP_OUTER, NULL));
        OK(quadrel_domain_add_line(domain, a, b, NULL));
        OK(quadrel_domain_add_line(domain, b, b, NULL));
        OK(quadrel_domain_add_line(domain, b, c, NULL));
        OK(quadrel_domain_add_line(domain, c, a, NULL));
        OK(quadrel_domain_end_loop(domain));
    }
    CHECK_STATUS(quadrel_domain_check(domain), QUADREL_ERROR_DEGENERATE);
    quadrel_domain_free(domain);
}

static void arguments_out_of_range(void) {
    quadrel_domain *domain = quadrel_domain_new();
    const double p[2] = {0, 0}, q[2] = {1, 0}, bad[2] = {0, HUGE_VAL}, radii[2] = {1, -1};
    const double twice[4] = {0, 0, 0, 0};
    const char *before = quadrel_last_error_message();

    CHECK_STATUS(quadrel_domain_add_line(domain, p, q, NULL), QUADREL_ERROR_INVALID_ARGUMENT);
    CHECK_STATUS(quadrel_domain_end_loop(domain), QUADREL_ERROR_INVALID_ARGUMENT);
    CHECK_STATUS(quadrel_domain_begin_loop(domain, 2, NULL), QUADREL_ERROR_INVALID_ARGUMENT);
    CHECK_STATUS(quadrel_domain_begin_loop(domain, -2147483647 - 1, NULL), QUADREL_ERROR_INVALID_ARGUMENT);
    CHECK_STATUS(quadrel_domain_begin_loop(domain, QUADREL_LOOP_OUTER, "\xff"), QUADREL_ERROR_INVALID_ARGUMENT);
    OK(quadrel_domain_begin_loop(domain, QUADREL_LOOP_AUTO, "wall"));
    CHECK_STATUS(quadrel_domain_begin_loop(domain, QUADREL_LOOP_OUTER, NULL), QUADREL_ERROR_INVALID_ARGUMENT);
    CHECK_STATUS(quadrel_domain_end_loop(domain), QUADREL_ERROR_INVALID_ARGUMENT);
    OK(quadrel_domain_begin_loop(domain, QUADREL_LOOP_OUTER, NULL));
    CHECK_STATUS(quadrel_domain_add_line(domain, p, bad, NULL), QUADREL_ERROR_INVALID_ARGUMENT);
    CHECK_STATUS(quadrel_domain_add_arc(domain, p, -1, 0, 1, NULL), QUADREL_ERROR_INVALID_ARGUMENT);
    CHECK_STATUS(quadrel_domain_add_arc(domain, p, 1, 0, 7, NULL), QUADREL_ERROR_INVALID_ARGUMENT);
    CHECK_STATUS(quadrel_domain_add_elliptic_arc(domain, p, radii, 0, 0, 1, NULL), QUADREL_ERROR_INVALID_ARGUMENT);
    CHECK_STATUS(quadrel_domain_add_bezier(domain, twice, 1, NULL), QUADREL_ERROR_INVALID_ARGUMENT);
    CHECK_STATUS(quadrel_domain_add_bezier(domain, NULL, 0, NULL), QUADREL_ERROR_INVALID_ARGUMENT);
    CHECK_STATUS(quadrel_domain_add_bezier(domain, twice, (size_t)-1, NULL), QUADREL_ERROR_INVALID_ARGUMENT);
    CHECK_STATUS(quadrel_domain_add_spline(domain, twice, 2, NULL), QUADREL_ERROR_INVALID_ARGUMENT);
    CHECK_STATUS(quadrel_domain_set_join_tolerance(domain, -1), QUADREL_ERROR_INVALID_ARGUMENT);
    CHECK_STATUS(quadrel_domain_add_expression(domain, "cos(t", "0", NULL), QUADREL_ERROR_PARSE);
    CHECK(strstr(quadrel_last_error_message(), "of x, line 1, column") != NULL);
    CHECK_STATUS(quadrel_domain_check(domain), QUADREL_ERROR_INVALID_ARGUMENT);
    CHECK(before == quadrel_last_error_message());
    quadrel_domain_free(domain);
}

static void null_everywhere(void) {
    quadrel_domain *domain = quadrel_domain_new(), *read = NULL;
    const double p[2] = {0, 0};
    quadrel_mesh *mesh = NULL;

    quadrel_domain_free(NULL);
    quadrel_options_free(NULL);
    quadrel_stages_free(NULL);
    quadrel_mesh_free(NULL);
    CHECK_STATUS(quadrel_domain_begin_loop(NULL, QUADREL_LOOP_OUTER, NULL), QUADREL_ERROR_NULL);
    CHECK(strcmp(quadrel_last_error_message(), "the domain is NULL") == 0);
    CHECK_STATUS(quadrel_domain_end_loop(NULL), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_domain_check(NULL), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_domain_set_join_tolerance(NULL, 1), QUADREL_ERROR_NULL);
    OK(quadrel_domain_begin_loop(domain, QUADREL_LOOP_OUTER, NULL));
    CHECK_STATUS(quadrel_domain_add_line(domain, NULL, p, NULL), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_domain_add_line(domain, p, NULL, NULL), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_domain_add_arc(domain, NULL, 1, 0, 1, NULL), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_domain_add_elliptic_arc(domain, p, NULL, 0, 0, 1, NULL), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_domain_add_bezier(domain, NULL, 3, NULL), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_domain_add_spline(domain, NULL, 3, NULL), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_domain_add_expression(domain, NULL, "t", NULL), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_domain_add_expression(domain, "t", NULL, NULL), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_domain_add_curve(domain, NULL, NULL, NULL, NULL, NULL), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_domain_read(NULL, -1, &read), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_domain_read("x.svg", -1, NULL), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_domain_read_string(NULL, QUADREL_INPUT_SVG, NULL, -1, &read), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_domain_read_string("", QUADREL_INPUT_SVG, NULL, -1, NULL), QUADREL_ERROR_NULL);
    CHECK(quadrel_domain_file_order(NULL) == 0 && quadrel_domain_file_tolerance(NULL) == 0);
    CHECK(quadrel_domain_file_order(domain) == 0 && quadrel_domain_file_tolerance(domain) == 0);
    CHECK_STATUS(quadrel_generate(NULL, NULL, NULL, &mesh), QUADREL_ERROR_NULL);
    CHECK_STATUS(quadrel_generate(domain, NULL, NULL, NULL), QUADREL_ERROR_NULL);
    CHECK(mesh == NULL && read == NULL);
    quadrel_domain_free(domain);
}

static void files_that_cannot_be_read(void) {
    quadrel_domain *domain = NULL;
    const char *two = "<svg><path d='M0 0H1V1H0Z M3 0H5V2H3Z'/></svg>";

    CHECK_STATUS(quadrel_domain_read("no such file.svg", -1, &domain), QUADREL_ERROR_IO);
    CHECK(strstr(quadrel_last_error_message(), "no such file.svg") != NULL);
    CHECK_STATUS(quadrel_domain_read_string("<svg", QUADREL_INPUT_SVG, NULL, -1, &domain), QUADREL_ERROR_PARSE);
    CHECK_STATUS(quadrel_domain_read_string("<svg/>", 7, NULL, -1, &domain), QUADREL_ERROR_INVALID_ARGUMENT);
    CHECK_STATUS(quadrel_domain_read_string(two, QUADREL_INPUT_SVG, NULL, -1, &domain), QUADREL_ERROR_NESTING);
    CHECK_STATUS(quadrel_domain_read_string(two, QUADREL_INPUT_SVG, NULL, -2, &domain), QUADREL_ERROR_INVALID_ARGUMENT);
    CHECK(domain == NULL);
    OK(quadrel_domain_read_string(two, QUADREL_INPUT_SVG, NULL, 1, &domain));
    /* It is complete. */
    CHECK_STATUS(quadrel_domain_begin_loop(domain, QUADREL_LOOP_HOLE, NULL), QUADREL_ERROR_INVALID_ARGUMENT);
    OK(quadrel_domain_check(domain));
    quadrel_domain_free(domain);
}

static void library(void) {
    CHECK(quadrel_version_number() ==
          QUADREL_VERSION_MAJOR * 10000 + QUADREL_VERSION_MINOR * 100 + QUADREL_VERSION_PATCH);
    CHECK(quadrel_version_string()[0] == '0' + QUADREL_VERSION_MAJOR);
    CHECK(strcmp(quadrel_status_name(QUADREL_ERROR_LAYOUT), "QUADREL_ERROR_LAYOUT") == 0);
    CHECK(strcmp(quadrel_status_name(12345), "unknown status") == 0);
    CHECK(quadrel_last_error_message()[0] == '\0');
    CHECK(quadrel_last_error_location(NULL) == 0);
}

int main(void) {
    library();
    domains_that_are_refused();
    arguments_out_of_range();
    null_everywhere();
    files_that_cannot_be_read();
    return failures != 0;
}
