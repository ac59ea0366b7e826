/*
 * quadrel makes curved all-quadrilateral meshes of planar domains for spectral element methods.
 *
 * Describe the domain's boundary (or read it from a file), choose order and tolerance, generate, read the
 * mesh through its arrays or write it to a file. This header is the manual of the C interface; quadrel.hpp
 * is the same for C++17.
 *
 *     quadrel_domain *disc = quadrel_domain_new();
 *     quadrel_mesh *mesh = NULL;
 *     const double center[2] = {0.0, 0.0};
 *     quadrel_domain_begin_loop(disc, QUADREL_LOOP_OUTER, "wall");
 *     quadrel_domain_add_arc(disc, center, 1.0, 0.0, 6.283185307179586, NULL);
 *     quadrel_domain_end_loop(disc);
 *     if (quadrel_generate(disc, NULL, NULL, &mesh) != QUADREL_OK)
 *         fprintf(stderr, "%s\n", quadrel_last_error_message());
 *     quadrel_mesh_write(mesh, QUADREL_FORMAT_VTU, "disc.vtu");
 *     quadrel_mesh_free(mesh);
 *     quadrel_domain_free(disc);
 *
 * Ownership. quadrel_X_new, quadrel_domain_read and quadrel_generate hand an object to the caller;
 * quadrel_X_free takes it back and accepts NULL. Every const T * that a getter returns is a borrowed,
 * read-only view that lives until its object is freed (or, for stages, used in another run). A mesh needs
 * neither its domain nor its options any more.
 *
 * Errors. What can fail returns a quadrel_status and writes its outputs only on QUADREL_OK (stages
 * excepted: they are filled as far as generation came). A NULL argument is QUADREL_ERROR_NULL and an
 * unknown number QUADREL_ERROR_INVALID_ARGUMENT, never a crash. Getters answer 0 or NULL where there is
 * nothing, also for NULL. quadrel_last_error_message says in words what failed last on this thread and
 * quadrel_last_error_location where in the domain. A defect of quadrel itself is caught and becomes
 * QUADREL_ERROR_INTERNAL.
 *
 * Threads. There is no global state. Different objects may be used on different threads at once. One object
 * may be read (by functions that take it as const) on many threads at once, or changed on one. The mesh
 * depends on domain and options alone: the same input gives the same bits.
 *
 * Callbacks. They run on the thread that called quadrel, inside that call, one at a time. They must not
 * unwind or longjmp through quadrel, nor change the object they serve; they may call quadrel for other
 * objects. user is passed through as it is. A function that takes user together with a destroy
 * function calls destroy(user) exactly once: when user is needed no more, also if the call itself fails.
 *
 * Units. Lengths are in the caller's unit, angles in radians. Indices count from 0; -1 stands for none.
 * Numbers are passed as int32_t constants, never as C enumerations. [n][2] describes an array of n
 * pairs, without gaps: point k is at 2k and 2k + 1. Text is UTF-8 and ends with a zero byte.
 *
 * Meshes. Corners 0 to 3 of an element are counter-clockwise; side s joins corner s to corner (s + 1) % 4.
 * Nodes of an element are indexed [j][i], both from 0 to N: i grows along side 0 (from corner 0 to corner
 * 1), j along side 3 backwards (from corner 0 to corner 3); they are the images of the Gauss-Lobatto points
 * of the square [-1, 1] x [-1, 1]. Both elements at an edge share its nodes.
 */
#ifndef QUADREL_H
#define QUADREL_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/*
 * ---- Library and errors ----
 */

#define QUADREL_VERSION_MAJOR 0
#define QUADREL_VERSION_MINOR 1
#define QUADREL_VERSION_PATCH 0

/** What a call ended with. Numbers are never used again for something else; new ones may appear. */
typedef int32_t quadrel_status;

#define QUADREL_OK 0
/** a required pointer is NULL */
#define QUADREL_ERROR_NULL 1
/** a value out of range, not finite or unknown, text that is not UTF-8, or a call out of order */
#define QUADREL_ERROR_INVALID_ARGUMENT 2
/** a curve or size callback returned non-zero or a value that is not finite (a size: not above 0) */
#define QUADREL_ERROR_CALLBACK 3
/** the progress callback, or the one that takes a file's bytes, asked to stop */
#define QUADREL_ERROR_CANCELLED 4
/** consecutive segments do not join */
#define QUADREL_ERROR_OPEN_LOOP 10
/** boundary curves cross or touch, or one crosses itself */
#define QUADREL_ERROR_INTERSECTION 11
/** no outer loop, several, or a hole outside it or inside another hole */
#define QUADREL_ERROR_NESTING 12
/** an interior corner angle of 0 */
#define QUADREL_ERROR_CUSP 13
/** a segment or loop without extent, or the same twice */
#define QUADREL_ERROR_DEGENERATE 14
/** the domain could not be triangulated, or the caller's base triangulation is none of this domain */
#define QUADREL_ERROR_BASE_MESH 20
/** no cross field that fits the domain was found */
#define QUADREL_ERROR_CROSS_FIELD 21
/** tracing separatrices failed at every resolution tried */
#define QUADREL_ERROR_SEPARATRIX 22
/** no conforming layout at every resolution tried, or more elements than allowed */
#define QUADREL_ERROR_LAYOUT 23
/** the boundary tolerance could not be met */
#define QUADREL_ERROR_TOLERANCE 24
/** an element whose Jacobian could not be proven positive */
#define QUADREL_ERROR_INVALID_ELEMENT 25
/** a file could not be read or written */
#define QUADREL_ERROR_IO 30
/** a kind of file or a feature that quadrel does not handle */
#define QUADREL_ERROR_UNSUPPORTED 31
/** a file or expression that cannot be understood, with line and column */
#define QUADREL_ERROR_PARSE 32
/** a defect of quadrel (a caught panic): please report it */
#define QUADREL_ERROR_INTERNAL 99

/**
 * Version of the linked library: major * 10000 + minor * 100 + patch. Compare it with the header's
 * QUADREL_VERSION_MAJOR, _MINOR and _PATCH.
 */
uint32_t quadrel_version_number(void);

/** Version of the linked library as text, "0.1.0". Lives for ever. */
const char *quadrel_version_string(void);

/** Name of a status, "QUADREL_ERROR_LAYOUT"; "unknown status" for other numbers. Lives for ever. */
const char *quadrel_status_name(quadrel_status status);

/**
 * What failed last on this thread, in one sentence: cause, place, and what to do about it. Empty if nothing
 * has failed yet; never NULL. The pointer stays good while the thread lives; the text changes at the
 * next failure on this thread.
 */
const char *quadrel_last_error_message(void);

/**
 * Where in the domain the last failure of this thread lies: writes the point to xy and returns 1, or
 * returns 0 if it has no place. xy may be NULL.
 */
int quadrel_last_error_location(double xy[2]);

/*
 * ---- Domain: loops of curve segments ----
 *
 * A loop is begun, given its segments in order, and ended; either orientation will do. A segment with name
 * NULL bears its loop's name. Edges on segments of equal name form one boundary of the mesh.
 */

/** A domain: its boundary, loop by loop, or what was read from a file. */
typedef struct quadrel_domain quadrel_domain;

/** What a loop bounds. */
typedef int32_t quadrel_loop_kind;

/**
 * A curve: writes the point at t in [0, 1] (both included) to xy, or its derivative d/dt. Equal t must give
 * equal results. Returns 0, or non-zero to give up.
 */
typedef int (*quadrel_curve_fn)(void *user, double t, double *xy);

/** Called exactly once, when user is needed no more. */
typedef void (*quadrel_destroy_fn)(void *user);

/** the outer boundary; exactly one */
#define QUADREL_LOOP_OUTER 0
/** the boundary of a hole */
#define QUADREL_LOOP_HOLE 1
/** outer or hole by nesting (even-odd) among the loops of this kind */
#define QUADREL_LOOP_AUTO 3

/** A domain without loops. */
quadrel_domain *quadrel_domain_new(void);

/** Frees a domain; callbacks that nothing else needs are destroyed. */
void quadrel_domain_free(quadrel_domain *domain);

/** Begins a loop; kind is a QUADREL_LOOP number, name may be NULL. */
quadrel_status quadrel_domain_begin_loop(quadrel_domain *domain, quadrel_loop_kind kind, const char *name);

/**
 * Ends the loop that was begun. Joins and closure are checked with everything else by quadrel_domain_check
 * and quadrel_generate.
 */
quadrel_status quadrel_domain_end_loop(quadrel_domain *domain);

/** Adds a curve that the caller evaluates. derivative is d/dt and may be NULL: differences are used then. */
quadrel_status quadrel_domain_add_curve(quadrel_domain *domain,
                                        quadrel_curve_fn curve,
                                        quadrel_curve_fn derivative,
                                        void *user,
                                        quadrel_destroy_fn destroy,
                                        const char *name);

/** Adds the straight segment between two points. */
quadrel_status quadrel_domain_add_line(quadrel_domain *domain,
                                       const double from[2],
                                       const double to[2],
                                       const char *name);

/**
 * Adds a circular arc from start_angle to end_angle: counter-clockwise if end_angle is the larger one, at
 * most a full turn.
 */
quadrel_status quadrel_domain_add_arc(quadrel_domain *domain,
                                      const double center[2],
                                      double radius,
                                      double start_angle,
                                      double end_angle,
                                      const char *name);

/**
 * Adds an elliptic arc with the two half axes radii, the first turned by rotation from the x axis. The
 * angles are the ellipse's parameter: the point is center + R(rotation) (radii[0] cos a, radii[1] sin a).
 */
quadrel_status quadrel_domain_add_elliptic_arc(quadrel_domain *domain,
                                               const double center[2],
                                               const double radii[2],
                                               double rotation,
                                               double start_angle,
                                               double end_angle,
                                               const char *name);

/** Adds the Bezier curve with count control points [count][2]; its degree is count - 1, at most 64. */
quadrel_status quadrel_domain_add_bezier(quadrel_domain *domain,
                                         const double *control_points,
                                         size_t count,
                                         const char *name);

/**
 * Adds the twice continuously differentiable cubic spline through points [count][2], its knots by chord
 * length: periodic if the last point equals the first, else with natural ends.
 */
quadrel_status quadrel_domain_add_spline(quadrel_domain *domain,
                                         const double *points,
                                         size_t count,
                                         const char *name);

/**
 * Adds the curve (x(t), y(t)), t in [0, 1], given by two expressions: numbers, t, pi, + - * / ^ and **,
 * parentheses, sin cos tan asin acos atan sinh cosh tanh atanh exp log (natural) log10 sqrt abs. Its
 * derivative is exact.
 */
quadrel_status quadrel_domain_add_expression(quadrel_domain *domain,
                                             const char *x,
                                             const char *y,
                                             const char *name);

/** Largest gap between segments that is closed silently; by default 1e-4 of the domain's diagonal. */
quadrel_status quadrel_domain_set_join_tolerance(quadrel_domain *domain, double gap);

/** Checks what quadrel_generate checks first: loops closed, disjoint, nested, without cusps. */
quadrel_status quadrel_domain_check(const quadrel_domain *domain);

/*
 * ---- Domains from files ----
 *
 * HOHQMesh control files (.control) and SVG paths (.svg: M L H V Q C S T A Z; the y axis is turned up, loops
 * are outer or holes by the even-odd rule). A domain that was read is complete: it takes no more loops.
 */

/** What a text is. */
typedef int32_t quadrel_input_format;

/** a HOHQMesh control file */
#define QUADREL_INPUT_CONTROL 0
/** an SVG file */
#define QUADREL_INPUT_SVG 1

/**
 * Reads a .control or .svg file. component chooses one of the domains of a file that holds several,
 * counted from 0 by descending area; with -1 such a file is refused.
 */
quadrel_status quadrel_domain_read(const char *path, int32_t component, quadrel_domain **domain_out);

/**
 * Reads the text of such a file; format is a QUADREL_INPUT number. Data files that a control file names are
 * looked for in folder and the ones above it; folder may be NULL.
 */
quadrel_status quadrel_domain_read_string(const char *content,
                                          quadrel_input_format format,
                                          const char *folder,
                                          int32_t component,
                                          quadrel_domain **domain_out);

/** The polynomial order that the file asks for, or 0. It is not used unless it is set as an option. */
int32_t quadrel_domain_file_order(const quadrel_domain *domain);

/** The boundary tolerance that the file asks for, or 0. It is not used unless it is set as an option. */
double quadrel_domain_file_tolerance(const quadrel_domain *domain);

/*
 * ---- Options ----
 *
 * A new object holds the defaults; quadrel_generate takes NULL for them. A value out of range fails at once
 * and changes nothing.
 */

/** What steers the generation. */
typedef struct quadrel_options quadrel_options;

/** The norm of the boundary error e(s) of an edge, s the arc length. */
typedef int32_t quadrel_norm;

/** Which cross field. */
typedef int32_t quadrel_field;

/** How boundary edges are divided until the tolerance holds. */
typedef int32_t quadrel_subdivision;

/** What becomes of a domain's mirrors and rotations. */
typedef int32_t quadrel_symmetry;

/** How much work fewer elements are worth: a QUADREL_EFFORT number. */
typedef int32_t quadrel_effort;

/** (integral of |e|^2 ds)^(1/2); unit length^(3/2) */
#define QUADREL_NORM_L2 0
/** (integral of |e|^2 + L^2 |e'|^2 ds)^(1/2), L the edge's length; unit length^(3/2) */
#define QUADREL_NORM_H1 1
/** max |e|; unit length */
#define QUADREL_NORM_MAX 2
/** Laplace, then steps that keep singularities apart */
#define QUADREL_FIELD_DIFFUSED 0
/** Laplace alone */
#define QUADREL_FIELD_HARMONIC 1
/** where the error is the same on all edges of a chain; few elements */
#define QUADREL_SUBDIVISION_EQUAL_ERROR 0
/** at the middle; nothing is coarsened afterwards */
#define QUADREL_SUBDIVISION_HALVING 1
/** they count for nothing */
#define QUADREL_SYMMETRY_IGNORED 0
/** the mesh has them, to rounding, if such a mesh is found that is not clearly worse */
#define QUADREL_SYMMETRY_KEPT 1
/** About two thirds of the time, for about 5 % more elements. */
#define QUADREL_EFFORT_FAST 0
/** The default. */
#define QUADREL_EFFORT_DEFAULT 1
/** The best of four meshes: about four times the time, for about 6 % fewer elements. */
#define QUADREL_EFFORT_BEST 2

/** Options with their defaults. */
quadrel_options *quadrel_options_new(void);

/** Frees options. */
void quadrel_options_free(quadrel_options *options);

/** Polynomial order N of the elements, 1 to 32; default 5. */
quadrel_status quadrel_options_set_order(quadrel_options *options, int32_t order);

/**
 * Largest error of each boundary edge against the exact curve, in the unit of norm (a QUADREL_NORM number).
 * Default: relative 1e-5 in L2.
 */
quadrel_status quadrel_options_set_tolerance(quadrel_options *options, double tolerance, quadrel_norm norm);

/**
 * The same for the domain scaled to a bounding-box diagonal of 1 (of its least bounding box, so that turning
 * the domain changes nothing).
 */
quadrel_status quadrel_options_set_relative_tolerance(quadrel_options *options,
                                                      double tolerance,
                                                      quadrel_norm norm);

/**
 * Which cross field, a QUADREL_FIELD number; default QUADREL_FIELD_DIFFUSED. Where the mesh that comes of it has an
 * element below 0.6 of the best possible scaled Jacobian, or there is none, the other one is tried, too.
 */
quadrel_status quadrel_options_set_field(quadrel_options *options,
                                         quadrel_field field);

/** How boundary edges are divided, a QUADREL_SUBDIVISION number; default QUADREL_SUBDIVISION_EQUAL_ERROR. */
quadrel_status quadrel_options_set_subdivision(quadrel_options *options, quadrel_subdivision subdivision);

/**
 * What becomes of the domain's mirrors and rotations; default QUADREL_SYMMETRY_KEPT. A size function or a base
 * triangulation, which know nothing of them, switch it off. The statistics tell which the domain and the mesh have.
 */
quadrel_status quadrel_options_set_symmetry(quadrel_options *options,
                                            quadrel_symmetry symmetry);

/**
 * How much work fewer elements are worth, a QUADREL_EFFORT number; default QUADREL_EFFORT_DEFAULT. Validity, tolerance,
 * quality floor and sizes hold with any.
 */
quadrel_status quadrel_options_set_effort(quadrel_options *options,
                                          quadrel_effort effort);

/** Largest wanted size of the elements: the longer of the mean lengths of opposite sides; default 0: no limit. */
quadrel_status quadrel_options_set_max_element_size(quadrel_options *options, double size);

/** Wanted size of the base mesh's triangles; default 0: automatic. */
quadrel_status quadrel_options_set_base_mesh_size(quadrel_options *options, double size);

/** Share in (0, 1) of the best possible scaled Jacobian that coarsening takes no element below; default 0.8. */
quadrel_status quadrel_options_set_quality_floor(quadrel_options *options, double floor);

/** Most elements allowed, at least 1; default 1000000. A mesh that needs more is QUADREL_ERROR_LAYOUT. */
quadrel_status quadrel_options_set_max_elements(quadrel_options *options, size_t limit);

/*
 * ---- A base triangulation of the caller's own ----
 */

/**
 * Sets the base mesh that generation starts from, instead of making one; it is copied. Triangles are
 * counter-clockwise. Each border vertex has a place on the domain's boundary: boundary holds its number, its
 * loop and its segment in that loop (counted as they were added), parameters holds t in [0, 1]; a vertex
 * between two segments may be there once or for both. Every corner and every change of name needs a vertex,
 * and border edges should turn with the boundary by less than 0.3 rad: the mesh is not refined.
 *
 * It is checked against the domain by quadrel_generate: QUADREL_ERROR_BASE_MESH, with the place, if it does
 * not triangulate it. With three counts of 0 quadrel makes its own base mesh again (the default).
 *
 * Shapes: vertices [vertex_count][2], triangles [triangle_count][3] vertices, boundary
 * [boundary_count][3] vertex, loop, segment, and parameters [boundary_count].
 */
quadrel_status quadrel_options_set_base_triangulation(quadrel_options *options,
                                                      const double *vertices,
                                                      size_t vertex_count,
                                                      const int32_t *triangles,
                                                      size_t triangle_count,
                                                      const int32_t *boundary,
                                                      const double *parameters,
                                                      size_t boundary_count);

/*
 * ---- Element size ----
 */

/**
 * Writes the largest wanted element size at the point xy to size: a finite length above 0. Returns 0, or
 * non-zero to give up: quadrel_generate then returns QUADREL_ERROR_CALLBACK, as it does for other values.
 */
typedef int (*quadrel_size_fn)(void *user, const double *xy, double *size);

/**
 * Element size as a function of the place; where quadrel_options_set_max_element_size or the domain ask for
 * less, that holds. NULL: no limit (then too user is destroyed). It is called for points of the domain only.
 */
quadrel_status quadrel_options_set_size_function(quadrel_options *options,
                                                 quadrel_size_fn size,
                                                 void *user,
                                                 quadrel_destroy_fn destroy);

/*
 * ---- Progress ----
 */

/** The stages, in running order. */
typedef int32_t quadrel_stage;

/**
 * Called now and then with the stage that runs and the share of the whole run that is done, which grows from
 * 0 to 1. Returns 0, or non-zero to stop: quadrel_generate then returns QUADREL_ERROR_CANCELLED.
 */
typedef int (*quadrel_progress_fn)(void *user, quadrel_stage stage, double fraction);

/** before the first */
#define QUADREL_STAGE_NONE 0
/** boundary curves are checked and measured */
#define QUADREL_STAGE_DOMAIN 1
/** the domain is triangulated */
#define QUADREL_STAGE_BASE_MESH 2
/** crosses that follow the boundary are spread over the domain */
#define QUADREL_STAGE_CROSS_FIELD 3
/** its singularities are found */
#define QUADREL_STAGE_SINGULARITIES 4
/** separatrices are traced from singularities and corners */
#define QUADREL_STAGE_SEPARATRICES 5
/** the regions between them become conforming blocks */
#define QUADREL_STAGE_LAYOUT 6
/** edges are divided, and elements joined, as the tolerance allows */
#define QUADREL_STAGE_REFINE 7
/** elements are smoothed */
#define QUADREL_STAGE_SMOOTH 8
/** the curved elements are made and proven valid */
#define QUADREL_STAGE_MESH 9

/** Who is told how far the run is and may stop it; NULL: nobody (then too user is destroyed). */
quadrel_status quadrel_options_set_progress(quadrel_options *options,
                                            quadrel_progress_fn progress,
                                            void *user,
                                            quadrel_destroy_fn destroy);

/*
 * ---- Generation ----
 */

/** A finished mesh; it never changes. */
typedef struct quadrel_mesh quadrel_mesh;

/** What the stages of one run made. */
typedef struct quadrel_stages quadrel_stages;

/** An object for quadrel_generate to fill. */
quadrel_stages *quadrel_stages_new(void);

/** Frees stages. */
void quadrel_stages_free(quadrel_stages *stages);

/**
 * Makes the mesh of domain. options may be NULL: the defaults. stages may be NULL; else it forgets what it
 * held and is filled as far as generation came, also on failure. On QUADREL_OK mesh_out receives the mesh,
 * which is conforming, its Jacobians proven positive everywhere and its boundary edges within the tolerance;
 * on failure it receives nothing.
 */
quadrel_status quadrel_generate(const quadrel_domain *domain,
                                const quadrel_options *options,
                                quadrel_stages *stages,
                                quadrel_mesh **mesh_out);

/** Frees a mesh. */
void quadrel_mesh_free(quadrel_mesh *mesh);

/*
 * ---- Mesh ----
 *
 * Arrays are read-only and live as long as the mesh. A node that elements share is there once.
 */

/** Polynomial order N of the elements. */
int32_t quadrel_mesh_order(const quadrel_mesh *mesh);

/** Number of vertices. */
size_t quadrel_mesh_vertex_count(const quadrel_mesh *mesh);

/** Number of elements. */
size_t quadrel_mesh_element_count(const quadrel_mesh *mesh);

/** Number of edges. */
size_t quadrel_mesh_edge_count(const quadrel_mesh *mesh);

/** Number of nodes, shared ones counted once. */
size_t quadrel_mesh_node_count(const quadrel_mesh *mesh);

/** The vertices, [vertex][2]. */
const double *quadrel_mesh_vertices(const quadrel_mesh *mesh);

/** The corners of each element, [element][4] vertices, counter-clockwise. */
const int32_t *quadrel_mesh_elements(const quadrel_mesh *mesh);

/** The element across each side, [element][4] elements; -1 at the boundary. */
const int32_t *quadrel_mesh_element_neighbors(const quadrel_mesh *mesh);

/** The edge at each side, [element][4] edges. */
const int32_t *quadrel_mesh_element_edges(const quadrel_mesh *mesh);

/** The boundary at each side, [element][4] boundaries; -1 inside. */
const int32_t *quadrel_mesh_element_boundaries(const quadrel_mesh *mesh);

/** The region of the block layout that each element comes from, [element]. */
const int32_t *quadrel_mesh_element_blocks(const quadrel_mesh *mesh);

/** The ends of each edge, [edge][2] vertices; on the boundary with the domain to the left. */
const int32_t *quadrel_mesh_edge_vertices(const quadrel_mesh *mesh);

/** The elements to the left and to the right of each edge, [edge][2]; -1 outside the domain. */
const int32_t *quadrel_mesh_edge_elements(const quadrel_mesh *mesh);

/** Which side the edge is in each of these two, [edge][2], 0 to 3; -1 outside. */
const int32_t *quadrel_mesh_edge_sides(const quadrel_mesh *mesh);

/** The boundary of each edge, [edge]; -1 inside. */
const int32_t *quadrel_mesh_edge_boundaries(const quadrel_mesh *mesh);

/** The loop that each boundary edge lies on, [edge], counted as the loops were begun; -1 inside. */
const int32_t *quadrel_mesh_edge_loops(const quadrel_mesh *mesh);

/**
 * The segment of that loop at each end of a boundary edge, [edge][2], counted in each loop as the segments
 * were added; -1 inside. They differ where an edge runs over a joint of segments.
 */
const int32_t *quadrel_mesh_edge_segments(const quadrel_mesh *mesh);

/**
 * The parameter t on these segments at each end, [edge][2]: where the exact curve meets the vertex. It
 * falls along the edge where the loop was given with the domain to its right.
 */
const double *quadrel_mesh_edge_parameters(const quadrel_mesh *mesh);

/**
 * The nodes, [node][2]: the vertices first, then N - 1 of each edge from its first vertex to its second,
 * then (N - 1)^2 inside each element.
 */
const double *quadrel_mesh_nodes(const quadrel_mesh *mesh);

/** The nodes of each element, [element][j][i] with N + 1 of j and of i, i fastest. */
const int32_t *quadrel_mesh_element_nodes(const quadrel_mesh *mesh);

/** The Gauss-Lobatto points in [-1, 1] that the nodes are the images of, [N + 1]. */
const double *quadrel_mesh_reference_nodes(const quadrel_mesh *mesh);

/** Number of boundaries: of different names. */
size_t quadrel_mesh_boundary_count(const quadrel_mesh *mesh);

/** Name of a boundary; NULL if there is none of that number. */
const char *quadrel_mesh_boundary_name(const quadrel_mesh *mesh, int32_t boundary);

/**
 * The statistics of the run that made the mesh, as a JSON object: status, message, place, seconds (by stage,
 * and total), triangles, singularities, separatrices, blocks, elements, order, nodes, irregular (interior,
 * boundary), irregular_expected, scaled_jacobian (min, p1, mean), scaled_jacobian_ceiling, boundary_error
 * (max, loops), symmetry (domain, mesh: rotations, mirrors each; asymmetry), fallback, attempts, rounds,
 * warnings. The times are all in it that differs from run to run.
 */
const char *quadrel_mesh_statistics_json(const quadrel_mesh *mesh);

/*
 * ---- Quality ----
 *
 * Measures of whole elements: minima and maxima are over the curved element, not at its corners.
 */

/** What is measured. */
typedef int32_t quadrel_measure;

/** minimum of det J / (|x_xi| |x_eta|); 1 where the grid is square */
#define QUADREL_MEASURE_SCALED_JACOBIAN 0
/** least angle between the grid directions, in radians */
#define QUADREL_MEASURE_MIN_ANGLE 1
/** largest angle between the grid directions, in radians */
#define QUADREL_MEASURE_MAX_ANGLE 2
/** mean length of the longer pair of opposite sides by that of the shorter */
#define QUADREL_MEASURE_ASPECT_RATIO 3
/** length of the longest side by that of the shortest */
#define QUADREL_MEASURE_EDGE_RATIO 4
/** maximum of (|x_xi|^2 + |x_eta|^2) / (2 det J); 1 where the grid is square and equally spaced */
#define QUADREL_MEASURE_CONDITION 5
/** area, in the unit of length squared */
#define QUADREL_MEASURE_AREA 6
/** largest error of the element's boundary edges, in the norm of the tolerance; 0 without boundary edges */
#define QUADREL_MEASURE_BOUNDARY_ERROR 7
/** least det J by the largest */
#define QUADREL_MEASURE_JACOBIAN_RATIO 8

/**
 * Writes a measure (a QUADREL_MEASURE number) of every element to out [element]; count is the room there and
 * has to be the number of elements.
 */
quadrel_status quadrel_mesh_quality(const quadrel_mesh *mesh,
                                    quadrel_measure measure,
                                    double *out,
                                    size_t count);

/** Least, largest and mean value of a measure over all elements; min, max and mean may be NULL. */
quadrel_status quadrel_mesh_quality_range(const quadrel_mesh *mesh,
                                          quadrel_measure measure,
                                          double *min,
                                          double *max,
                                          double *mean);

/*
 * ---- Stages ----
 *
 * What each stage of a run made, for plots and diagnosis; filled also where generation fails.
 */

/** The last stage that finished. */
quadrel_stage quadrel_stages_reached(const quadrel_stages *stages);

/** Seconds spent in a stage; 0 for an unknown one. */
double quadrel_stages_seconds(const quadrel_stages *stages, quadrel_stage stage);

/**
 * The statistics of the run, with the keys of quadrel_mesh_statistics_json: what was not reached is null,
 * and status, message and place tell the failure. NULL before the first run.
 */
const char *quadrel_stages_statistics_json(const quadrel_stages *stages);

/** Number of vertices of the base mesh. */
size_t quadrel_stages_base_vertex_count(const quadrel_stages *stages);

/** Number of triangles of the base mesh. */
size_t quadrel_stages_base_triangle_count(const quadrel_stages *stages);

/** Vertices of the base mesh, [vertex][2]. */
const double *quadrel_stages_base_vertices(const quadrel_stages *stages);

/** Triangles of the base mesh, [triangle][3] vertices, counter-clockwise. */
const int32_t *quadrel_stages_base_triangles(const quadrel_stages *stages);

/** The cross field at the base vertices, [vertex][2]: (cos 4a, sin 4a) of the angle a of an arm, as solved. */
const double *quadrel_stages_cross_field(const quadrel_stages *stages);

/** Number of interior singularities. */
size_t quadrel_stages_singularity_count(const quadrel_stages *stages);

/** Where they are, [singularity][2]. */
const double *quadrel_stages_singularity_points(const quadrel_stages *stages);

/** Their valences, [singularity]: how many elements meet there, 3 or 5. */
const int32_t *quadrel_stages_singularity_valences(const quadrel_stages *stages);

/** Number of corners of the boundary. */
size_t quadrel_stages_corner_count(const quadrel_stages *stages);

/** Where they are, [corner][2]. */
const double *quadrel_stages_corner_points(const quadrel_stages *stages);

/** Their angles through the domain, [corner]. */
const double *quadrel_stages_corner_angles(const quadrel_stages *stages);

/**
 * How many elements the field wants at each corner, [corner]; 0 where it is so sharp that a triangle is left to
 * be repaired.
 */
const int32_t *quadrel_stages_corner_quads(const quadrel_stages *stages);

/** Number of separatrices. */
size_t quadrel_stages_separatrix_count(const quadrel_stages *stages);

/** Where each separatrix begins among the points, [separatrix + 1]; the last entry is their number. */
const size_t *quadrel_stages_separatrix_offsets(const quadrel_stages *stages);

/** The polylines of the separatrices, [point][2]. */
const double *quadrel_stages_separatrix_points(const quadrel_stages *stages);

/** Number of regions between the separatrices. */
size_t quadrel_stages_block_count(const quadrel_stages *stages);

/** Where the outline of each region begins among the points, [block + 1]. */
const size_t *quadrel_stages_block_offsets(const quadrel_stages *stages);

/** The outlines, counter-clockwise, [point][2]; the last point of each is its first. */
const double *quadrel_stages_block_points(const quadrel_stages *stages);

/** Number of sides of each region, [block]; T-junctions are no corners. */
const int32_t *quadrel_stages_block_sides(const quadrel_stages *stages);

/*
 * ---- Files ----
 */

/** A file format. */
typedef int32_t quadrel_format;

/** Takes count bytes of a file. Returns 0, or non-zero to stop. */
typedef int (*quadrel_write_fn)(void *user, const void *bytes, size_t count);

/** What a picture of the stages shows. */
typedef int32_t quadrel_picture;

/** VTK XML unstructured grid of Lagrange quadrilaterals (nodes equispaced), for ParaView and MFEM */
#define QUADREL_FORMAT_VTU 0
/** Gmsh 4.1 (nodes equispaced), orders 1 to 10 */
#define QUADREL_FORMAT_MSH 1
/** HOHQMesh's ISM-v2: corners, edges, curved sides */
#define QUADREL_FORMAT_ISM_V2 2
/** HOHQMesh's ISM-MM: corners, curved sides, a material for each element */
#define QUADREL_FORMAT_ISM_MM 3
/** Abaqus with HOHQMesh's curved sides in comments, for Trixi.jl */
#define QUADREL_FORMAT_INP 4
/** MFEM mesh v1.0, nodes at the Gauss-Lobatto points */
#define QUADREL_FORMAT_MFEM 5
/** a picture */
#define QUADREL_FORMAT_SVG 6
/** HOHQMesh's ISM: corners, curved sides */
#define QUADREL_FORMAT_ISM 7
/** the boundary and its junctions */
#define QUADREL_PICTURE_BOUNDARY 0
/** the base mesh */
#define QUADREL_PICTURE_TRIANGLES 1
/** the cross field */
#define QUADREL_PICTURE_CROSSES 2
/** interior singularities and corners */
#define QUADREL_PICTURE_SINGULARITIES 3
/** separatrices */
#define QUADREL_PICTURE_SEPARATRICES 4
/** regions between the separatrices */
#define QUADREL_PICTURE_REGIONS 5
/** blocks of the conforming layout */
#define QUADREL_PICTURE_BLOCKS 6
/** all stages reached side by side, and the mesh */
#define QUADREL_PICTURE_ALL 100

/**
 * Writes the mesh to a file, whole or not at all; format is a QUADREL_FORMAT number.
 * QUADREL_ERROR_UNSUPPORTED where the format cannot hold the mesh's order.
 */
quadrel_status quadrel_mesh_write(const quadrel_mesh *mesh, quadrel_format format, const char *path);

/**
 * Hands the bytes of that file to a function, piece by piece, until it has all or returns non-zero
 * (QUADREL_ERROR_CANCELLED).
 */
quadrel_status quadrel_mesh_write_to(const quadrel_mesh *mesh,
                                     quadrel_format format,
                                     quadrel_write_fn write,
                                     void *user);

/**
 * Writes a picture (SVG) of what a stage made; picture is a QUADREL_PICTURE number. The place of a failure is
 * circled. QUADREL_ERROR_UNSUPPORTED where generation did not come that far.
 */
quadrel_status quadrel_stages_write_svg(const quadrel_stages *stages,
                                        quadrel_picture picture,
                                        const char *path);

#ifdef __cplusplus
}
#endif

#endif /* QUADREL_H */
