/* Meshes the unit disc, its boundary given as a function, and writes disc.vtu for ParaView.
 *
 * cc disc.c $(pkg-config --cflags --libs quadrel) -lm -o disc */
#include <math.h>
#include <stdio.h>

#include <quadrel.h>

/* The curve's point at t in [0, 1]; another function could give d/dt. */
static int circle(void *user, double t, double xy[2]) {
    const double radius = *(double *)user, angle = 6.283185307179586 * t;
    xy[0] = radius * cos(angle);
    xy[1] = radius * sin(angle);
    return 0;
}

int main(void) {
    double radius = 1.0, worst = 0.0;
    quadrel_domain *disc = quadrel_domain_new();
    quadrel_mesh *mesh = NULL;
    quadrel_domain_begin_loop(disc, QUADREL_LOOP_OUTER, "wall");
    quadrel_domain_add_curve(disc, circle, NULL, &radius, NULL, NULL);
    quadrel_domain_end_loop(disc);
    if (quadrel_generate(disc, NULL, NULL, &mesh) != QUADREL_OK ||
        quadrel_mesh_write(mesh, QUADREL_FORMAT_VTU, "disc.vtu") != QUADREL_OK) {
        fprintf(stderr, "%s\n", quadrel_last_error_message());
        return 1;
    }
    quadrel_mesh_quality_range(mesh, QUADREL_MEASURE_SCALED_JACOBIAN, &worst, NULL, NULL);
    printf("%zu elements of order %d, least scaled Jacobian %.3f\n", quadrel_mesh_element_count(mesh),
           (int)quadrel_mesh_order(mesh), worst);
    quadrel_mesh_free(mesh);
    quadrel_domain_free(disc);
    return 0;
}
