/* Small domains for the tests. */
#ifndef QUADREL_TESTS_SHAPES_H
#define QUADREL_TESTS_SHAPES_H

#include <stddef.h>

#include "quadrel.h"

#define TEST_PI 3.14159265358979323846

/* A loop of straight segments through count corners. */
static inline void add_polygon(quadrel_domain *domain, quadrel_loop_kind kind, const double *corners, size_t count,
                        const char *name) {
    size_t k;
    quadrel_domain_begin_loop(domain, kind, name);
    for (k = 0; k < count; ++k) {
        quadrel_domain_add_line(domain, corners + 2 * k, corners + 2 * ((k + 1) % count), NULL);
    }
    quadrel_domain_end_loop(domain);
}

static inline void add_circle(quadrel_domain *domain, quadrel_loop_kind kind, double x, double y, double radius,
                       const char *name) {
    const double center[2] = {x, y};
    quadrel_domain_begin_loop(domain, kind, name);
    quadrel_domain_add_arc(domain, center, radius, 0.0, 2.0 * TEST_PI, NULL);
    quadrel_domain_end_loop(domain);
}

/* A square of side 4 with a round hole in the middle. */
static inline quadrel_domain *new_plate(void) {
    const double corners[8] = {-2.0, -2.0, 2.0, -2.0, 2.0, 2.0, -2.0, 2.0};
    quadrel_domain *domain = quadrel_domain_new();
    add_polygon(domain, QUADREL_LOOP_OUTER, corners, 4, "square");
    add_circle(domain, QUADREL_LOOP_HOLE, 0.0, 0.0, 1.0, "hole");
    return domain;
}

#endif
