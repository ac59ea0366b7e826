/* A program of another project, in C. */
#include <stdio.h>

#include <quadrel.h>

int main(void) {
    const double corners[4][2] = {{0, 0}, {2, 0}, {2, 1}, {0, 1}};
    quadrel_domain *domain = quadrel_domain_new();
    quadrel_mesh *mesh = NULL;
    int k;
    quadrel_domain_begin_loop(domain, QUADREL_LOOP_OUTER, "wall");
    for (k = 0; k < 4; ++k) quadrel_domain_add_line(domain, corners[k], corners[(k + 1) % 4], NULL);
    quadrel_domain_end_loop(domain);
    if (quadrel_generate(domain, NULL, NULL, &mesh) != QUADREL_OK) {
        fprintf(stderr, "%s\n", quadrel_last_error_message());
        return 1;
    }
    printf("quadrel %s: %zu elements\n", quadrel_version_string(), quadrel_mesh_element_count(mesh));
    quadrel_mesh_free(mesh);
    quadrel_domain_free(domain);
    return 0;
}
