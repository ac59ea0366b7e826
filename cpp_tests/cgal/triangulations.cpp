// CGAL as the reference triangulator: quadrel's base triangulation is constrained Delaunay, and its border that of
// the domain; on CGAL's own triangulation of the domain quadrel finds the same singularities.
// triangulations FOLDER: tests/domains.
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesh_size_criteria_2.h>
#include <CGAL/Delaunay_mesh_vertex_base_2.h>
#include <CGAL/Delaunay_mesher_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <list>
#include <map>
#include <string>
#include <vector>

#include "../support/check.h"
#include "quadrel.hpp"

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_2;
using Vertex = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel, CGAL::Delaunay_mesh_vertex_base_2<Kernel>>;
using Face = CGAL::Delaunay_mesh_face_base_2<Kernel>;
// Constraints that cross throw.
using Cdt = CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<Vertex, Face>,
                                                       CGAL::No_constraint_intersection_tag>;
using Criteria = CGAL::Delaunay_mesh_size_criteria_2<Cdt>;
using Triangle = std::array<std::int32_t, 3>;

struct Example {
  const char* file;
  std::size_t holes;
  // How far chords may stand off the boundary, by the domain's size, for CGAL to have it: less than 0.3 rad of turn.
  double chords;
  // The domain is the same from every side: what the field looks like is decided up to a rotation alone.
  bool round;
};
const Example EXAMPLES[] = {
    {"mech/unit-circle.control", 0, 1e-4, true}, {"mech/half-disc.control", 0, 1e-4, false},
    {"hohq/GingerbreadMan.control", 6, 1e-4, false}, {"hohq/NACA0012.control", 1, 3e-6, false},
    {"hohq/PacMan.control", 0, 1e-4, false}, {"hohq/SplineGeometry.control", 0, 1e-4, false},
};

struct Triangles {
  std::vector<quadrel::Point> points;
  std::vector<Triangle> triangles;
};

Point cgal(const quadrel::Point& p) { return {p[0], p[1]}; }
double distance(const quadrel::Point& a, const quadrel::Point& b) { return std::hypot(a[0] - b[0], a[1] - b[1]); }

Triangles base_of(const quadrel::Stages& stages) {
  Triangles result;
  for (std::size_t k = 0; k < stages.base_vertices().size(); k += 2) {
    result.points.push_back({stages.base_vertices()[k], stages.base_vertices()[k + 1]});
  }
  for (std::size_t k = 0; k < stages.base_triangles().size(); k += 3) {
    const std::int32_t* t = stages.base_triangles().data() + k;
    result.triangles.push_back({t[0], t[1], t[2]});
  }
  return result;
}

// The triangle to the left of each directed edge, and its corner across.
using Sides = std::map<std::pair<int, int>, std::pair<std::size_t, int>>;

Sides sides_of(const Triangles& mesh) {
  Sides sides;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const Triangle& v = mesh.triangles[t];
      CHECK(sides.emplace(std::make_pair(v[k], v[(k + 1) % 3]), std::make_pair(t, v[(k + 2) % 3])).second);
    }
  }
  return sides;
}

// The border's loops, the domain to the left.
std::vector<std::vector<int>> border_of(const Sides& sides) {
  std::map<int, int> next;
  for (const auto& side : sides) {
    if (!sides.count({side.first.second, side.first.first})) CHECK(next.emplace(side.first.first, side.first.second).second);
  }
  std::vector<std::vector<int>> loops;
  while (!next.empty()) {
    loops.emplace_back();
    for (auto at = next.begin(); at != next.end();) {
      loops.back().push_back(at->first);
      const int to = at->second;
      next.erase(at);
      at = next.find(to);
    }
  }
  return loops;
}

double area_of(const std::vector<Point>& loop) { return CGAL::Polygon_2<Kernel>(loop.begin(), loop.end()).area(); }

// How many loops are around each face: odd inside the domain.
std::map<Cdt::Face_handle, int> nesting(const Cdt& cdt) {
  std::map<Cdt::Face_handle, int> level;
  std::list<Cdt::Edge> border;
  const auto flood = [&](Cdt::Face_handle start, int own) {
    std::vector<Cdt::Face_handle> open{start};
    level.emplace(start, own);
    while (!open.empty()) {
      const Cdt::Face_handle face = open.back();
      open.pop_back();
      for (int k = 0; k < 3; ++k) {
        const Cdt::Face_handle other = face->neighbor(k);
        if (face->is_constrained(k)) {
          border.emplace_back(face, k);
        } else if (level.emplace(other, own).second) {
          open.push_back(other);
        }
      }
    }
  };
  flood(cdt.infinite_face(), 0);
  while (!border.empty()) {
    const Cdt::Edge edge = border.front();
    border.pop_front();
    const Cdt::Face_handle other = edge.first->neighbor(edge.second);
    if (!level.count(other)) flood(other, level[edge.first] + 1);
  }
  return level;
}

// How far a point lies inside the circle of three others, as CGAL decides it (exactly): not at all; so little that
// the vertices' coordinates, which were rounded on the way to the caller's frame, do not tell; or indeed.
enum class Inside { No, Rounding, Yes };

Inside in_circle(const quadrel::Point& a, const quadrel::Point& b, const quadrel::Point& c, const quadrel::Point& d, double rounding) {
  const Point p = cgal(a), q = cgal(b), r = cgal(c), s = cgal(d);
  if (CGAL::side_of_oriented_circle(p, q, r, s) != CGAL::ON_POSITIVE_SIDE) return Inside::No;
  // The in-circle determinant, and what moving all four points by `rounding` can change it: its derivative by a
  // point is 4 x the area of the others' triangle x the radius.
  const auto row = [&](const quadrel::Point& x) {
    const double u = x[0] - d[0], v = x[1] - d[1];
    return std::array<double, 3>{u, v, u * u + v * v};
  };
  const auto x = row(a), y = row(b), z = row(c);
  const double det = x[0] * (y[1] * z[2] - y[2] * z[1]) - x[1] * (y[0] * z[2] - y[2] * z[0]) + x[2] * (y[0] * z[1] - y[1] * z[0]);
  const double area = 2 * (std::abs(CGAL::area(p, q, r)) + std::abs(CGAL::area(p, q, s)));
  const double radius = std::sqrt(CGAL::squared_radius(p, q, r));
  return std::abs(det) <= 4 * area * radius * rounding ? Inside::Rounding : Inside::Yes;
}

void constrained_delaunay(const Triangles& mesh) {
  const Sides sides = sides_of(mesh);
  const auto loops = border_of(sides);
  double size = 0;
  for (const quadrel::Point& p : mesh.points) size = std::max({size, std::abs(p[0]), std::abs(p[1])});
  const double rounding = 4 * 2.3e-16 * size;

  for (const Triangle& t : mesh.triangles) {
    CHECK(CGAL::orientation(cgal(mesh.points[t[0]]), cgal(mesh.points[t[1]]), cgal(mesh.points[t[2]])) == CGAL::LEFT_TURN);
  }
  std::size_t inner = 0, rounded = 0;
  for (const auto& side : sides) {
    const auto other = sides.find({side.first.second, side.first.first});
    if (other == sides.end()) continue;
    ++inner;
    const Triangle& t = mesh.triangles[side.second.first];
    const Inside inside = in_circle(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[other->second.second], rounding);
    CHECK(inside != Inside::Yes);
    rounded += inside == Inside::Rounding;
  }

  // CGAL's triangulation of our vertices and border: as many triangles, the same ones but for cocircular vertices.
  Cdt cdt;
  std::vector<Cdt::Vertex_handle> handles;
  for (std::size_t k = 0; k < mesh.points.size(); ++k) {
    handles.push_back(cdt.insert(cgal(mesh.points[k])));
    handles.back()->info() = static_cast<int>(k);
  }
  CHECK(cdt.number_of_vertices() == mesh.points.size());
  for (const auto& loop : loops) {
    for (std::size_t k = 0; k < loop.size(); ++k) cdt.insert_constraint(handles[loop[k]], handles[loop[(k + 1) % loop.size()]]);
  }
  CHECK(cdt.is_valid());
  const auto level = nesting(cdt);
  std::size_t count = 0, same = 0;
  for (auto face = cdt.finite_faces_begin(); face != cdt.finite_faces_end(); ++face) {
    if (level.at(face) % 2 == 0) continue;
    ++count;
    const auto ours = sides.find({face->vertex(0)->info(), face->vertex(1)->info()});
    same += ours != sides.end() && ours->second.second == face->vertex(2)->info();
  }
  CHECK(count == mesh.triangles.size());
  CHECK(2 * rounded + same >= count);
  std::printf("  base mesh: %zu triangles, of which CGAL has %zu; %zu of %zu inner sides within rounding\n", count, same, rounded, inner);
}

// A vertex of the boundary, and which place it has there.
struct Place {
  quadrel::Point point;
  std::int32_t loop, segment;
  double t;
};

// An edge of the boundary between two such, the domain to the left.
struct Chord {
  Place from, to;
};

// The boundary in chords of about `size` or less and within `tolerance` of the curve, by the domain's size: those of a
// fine mesh of straight elements, in order.
std::vector<std::vector<Chord>> boundary_of(const quadrel::Domain& domain, double size, double tolerance) {
  quadrel::Options options;
  options.order(1).max_element_size(size).relative_tolerance(tolerance, quadrel::Norm::Max).subdivision(quadrel::Subdivision::Halving);
  const quadrel::Mesh mesh = quadrel::generate(domain, options);
  std::map<int, std::pair<int, Chord>> next;
  for (std::size_t e = 0; e < mesh.edge_count(); ++e) {
    if (mesh.edge_loops()[e] < 0) continue;
    const auto end = [&](std::size_t k) {
      const auto v = static_cast<std::size_t>(mesh.edge_vertices()[2 * e + k]);
      return Place{{mesh.vertices()[2 * v], mesh.vertices()[2 * v + 1]}, mesh.edge_loops()[e], mesh.edge_segments()[2 * e + k], mesh.edge_parameters()[2 * e + k]};
    };
    next[mesh.edge_vertices()[2 * e]] = {mesh.edge_vertices()[2 * e + 1], Chord{end(0), end(1)}};
  }
  std::vector<std::vector<Chord>> loops;
  while (!next.empty()) {
    loops.emplace_back();
    for (auto at = next.begin(); at != next.end();) {
      loops.back().push_back(at->second.second);
      const int to = at->second.first;
      next.erase(at);
      at = next.find(to);
    }
  }
  return loops;
}

// A mesh whose sides on the boundary are within 1e-7 of the curve, by the domain's size. It is here for these sides
// alone, so the first order will do that has one.
quadrel::Mesh close_mesh(const quadrel::Domain& domain) {
  for (int order = 8;; --order) {
    quadrel::Options options;
    options.order(order).relative_tolerance(1e-7, quadrel::Norm::Max).subdivision(quadrel::Subdivision::Halving);
    try {
      return quadrel::generate(domain, options);
    } catch (const quadrel::Error&) {
      if (order == 3) throw;
    }
  }
}

// The boundary's loops: the sides of such a mesh, 32 chords each.
std::vector<std::vector<quadrel::Point>> curves_of(const quadrel::Domain& domain) {
  const quadrel::Mesh mesh = close_mesh(domain);
  const auto nodes = mesh.reference_nodes();
  const std::size_t chords = 32, inside = nodes.size() - 2;
  std::map<std::int32_t, std::pair<std::int32_t, std::vector<quadrel::Point>>> next;
  for (std::size_t e = 0; e < mesh.edge_count(); ++e) {
    if (mesh.edge_loops()[e] < 0) continue;
    const std::int32_t from = mesh.edge_vertices()[2 * e], to = mesh.edge_vertices()[2 * e + 1];
    std::vector<std::size_t> own{static_cast<std::size_t>(from)};
    for (std::size_t k = 0; k < inside; ++k) own.push_back(mesh.vertex_count() + e * inside + k);
    own.push_back(static_cast<std::size_t>(to));
    std::vector<quadrel::Point> points;
    for (std::size_t c = 0; c < chords; ++c) {
      const double x = 2.0 * static_cast<double>(c) / static_cast<double>(chords) - 1.0;
      quadrel::Point sum{0, 0};
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        double basis = 1;
        for (std::size_t k = 0; k < nodes.size(); ++k) {
          if (k != i) basis *= (x - nodes[k]) / (nodes[i] - nodes[k]);
        }
        for (std::size_t k = 0; k < 2; ++k) sum[k] += basis * mesh.nodes()[2 * own[i] + k];
      }
      points.push_back(sum);
    }
    next[from] = {to, points};
  }
  std::vector<std::vector<quadrel::Point>> loops;
  while (!next.empty()) {
    loops.emplace_back();
    for (auto at = next.begin(); at != next.end();) {
      loops.back().insert(loops.back().end(), at->second.second.begin(), at->second.second.end());
      const std::int32_t to = at->second.first;
      next.erase(at);
      at = next.find(to);
    }
  }
  return loops;
}

double to_chord(const quadrel::Point& p, const quadrel::Point& a, const quadrel::Point& b) {
  const double x = b[0] - a[0], y = b[1] - a[1], u = p[0] - a[0], v = p[1] - a[1];
  const double share = std::max(0.0, std::min(1.0, (u * x + v * y) / (x * x + y * y)));
  return std::hypot(u - share * x, v - share * y);
}

// The border is simple polygons, one for each loop of the domain, inscribed in it.
void border(const Triangles& mesh, const quadrel::Stages& stages, const std::vector<std::vector<quadrel::Point>>& curves, std::size_t holes) {
  const auto loops = border_of(sides_of(mesh));
  CHECK(loops.size() == holes + 1 && curves.size() == holes + 1);
  std::size_t outer = 0;
  double area = 0, exact = 0, size = 0;
  std::vector<std::pair<quadrel::Point, quadrel::Point>> edges, chords;
  for (const auto& loop : loops) {
    std::vector<Point> points;
    for (int v : loop) points.push_back(cgal(mesh.points[static_cast<std::size_t>(v)]));
    CHECK(CGAL::is_simple_2(points.begin(), points.end()));
    outer += CGAL::orientation_2(points.begin(), points.end()) == CGAL::COUNTERCLOCKWISE;
    area += area_of(points);
    for (std::size_t k = 0; k < points.size(); ++k) {
      const Point &p = points[k], &q = points[(k + 1) % points.size()];
      edges.push_back({{p.x(), p.y()}, {q.x(), q.y()}});
      size = std::max(size, distance(edges.front().first, edges.back().first));
    }
  }
  CHECK(outer == 1);
  for (const auto& curve : curves) {
    std::vector<Point> points;
    for (std::size_t k = 0; k < curve.size(); ++k) {
      points.push_back(cgal(curve[k]));
      chords.emplace_back(curve[k], curve[(k + 1) % curve.size()]);
    }
    exact += area_of(points);
  }
  CHECK(std::abs(area / exact - 1) < 0.005);

  // The distance from one to the other, by the length of the edge.
  double border_off = 0, curve_off = 0;
  for (const auto& edge : edges) {
    double least = HUGE_VAL;
    for (const auto& chord : chords) least = std::min(least, to_chord(edge.first, chord.first, chord.second));
    border_off = std::max(border_off, least / distance(edge.first, edge.second));
  }
  for (const auto& chord : chords) {
    double least = HUGE_VAL;
    for (const auto& edge : edges) least = std::min(least, to_chord(chord.first, edge.first, edge.second) / distance(edge.first, edge.second));
    curve_off = std::max(curve_off, least);
  }
  // A chord turns by 0.21 rad at most, so its arc is 0.21 / 8 of it high; refinement may have quartered it.
  CHECK(border_off < 0.106 && curve_off < 0.106);
  for (std::size_t c = 0; c < stages.corner_angles().size(); ++c) {
    const quadrel::Point corner{stages.corner_points()[2 * c], stages.corner_points()[2 * c + 1]};
    // Vertices are moved to a fine grid.
    CHECK(std::any_of(edges.begin(), edges.end(), [&](const auto& e) { return distance(e.first, corner) < 1e-7 * size; }));
  }
  std::printf("  border: vertices %.2g of an edge off the curve, the curve %.2g off the edges, area %.2g too small\n", border_off, curve_off,
              1 - area / exact);
}

// CGAL's triangulation of the domain, and the options that take it for the base mesh.
Triangles triangulated(const std::vector<std::vector<Chord>>& boundary, double size, quadrel::Options& options) {
  Cdt cdt;
  std::vector<Place> places;
  std::map<std::pair<int, int>, Chord> chords;
  for (const auto& loop : boundary) {
    std::vector<Cdt::Vertex_handle> handles;
    for (const Chord& c : loop) {
      handles.push_back(cdt.insert(cgal(c.from.point)));
      handles.back()->info() = static_cast<int>(places.size());
      places.push_back(c.from);
    }
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const auto a = handles[k], b = handles[(k + 1) % loop.size()];
      cdt.insert_constraint(a, b);
      chords[{a->info(), b->info()}] = loop[k];
    }
  }
  // A seed in a hole tells CGAL not to fill it; several do no harm.
  std::vector<Point> seeds;
  for (const auto& face : nesting(cdt)) {
    if (face.second == 2) seeds.push_back(CGAL::centroid(cdt.triangle(face.first)));
  }
  const std::size_t given = cdt.number_of_vertices();
  CGAL::Delaunay_mesher_2<Cdt, Criteria> mesher(cdt, Criteria(0.125, size));
  mesher.set_seeds(seeds.begin(), seeds.end());
  std::map<Cdt::Vertex_handle, int> original;
  for (auto v = cdt.finite_vertices_begin(); v != cdt.finite_vertices_end(); ++v) original[v] = v->info();
  mesher.refine_mesh();

  Triangles mesh;
  std::map<Cdt::Vertex_handle, int> number;
  std::map<int, Cdt::Vertex_handle> next;
  for (auto v = cdt.finite_vertices_begin(); v != cdt.finite_vertices_end(); ++v) {
    number[v] = static_cast<int>(mesh.points.size());
    mesh.points.push_back({v->point().x(), v->point().y()});
  }
  std::vector<Cdt::Vertex_handle> handle(mesh.points.size());
  for (const auto& v : number) handle[static_cast<std::size_t>(v.second)] = v.first;
  for (auto face = cdt.finite_faces_begin(); face != cdt.finite_faces_end(); ++face) {
    if (!face->is_in_domain()) continue;
    Triangle t;
    for (int k = 0; k < 3; ++k) t[static_cast<std::size_t>(k)] = number[face->vertex(k)];
    mesh.triangles.push_back(t);
  }

  // Where CGAL has split a chord, its vertices have the parameter at that share of the chord.
  std::vector<std::array<std::int32_t, 3>> vertices;
  std::vector<double> parameters;
  const auto add = [&](int v, const Place& p, double t) {
    vertices.push_back({v, p.loop, p.segment});
    parameters.push_back(t);
  };
  std::size_t split = 0;
  for (const auto& loop : border_of(sides_of(mesh))) {
    const std::size_t n = loop.size();
    const auto old = [&](std::size_t k) { return original.find(handle[static_cast<std::size_t>(loop[k % n])]); };
    std::size_t first = 0;
    while (first < n && old(first) == original.end()) ++first;
    CHECK(first < n);
    for (std::size_t k = first; k < first + n;) {
      std::size_t to = k + 1;
      while (old(to) == original.end()) ++to;
      const auto chord = chords.find({old(k)->second, old(to)->second});
      CHECK(chord != chords.end());
      if (chord == chords.end()) return mesh;
      const Place &a = chord->second.from, &b = chord->second.to;
      add(loop[k % n], a, a.t);
      // Parameters are those of one segment, going one way.
      CHECK(to == k + 1 || (a.segment == b.segment && std::abs(a.t - b.t) < 0.5));
      for (std::size_t i = k + 1; i < to; ++i, ++split) {
        const double share = distance(mesh.points[static_cast<std::size_t>(loop[i % n])], a.point) / distance(a.point, b.point);
        add(loop[i % n], a, a.t + share * (b.t - a.t));
      }
      k = to;
    }
  }
  options.base_triangulation(mesh.points, mesh.triangles, vertices, parameters);
  std::printf("  CGAL: %zu boundary vertices, %zu chords split, %zu vertices, %zu triangles\n", given, split, mesh.points.size(), mesh.triangles.size());
  return mesh;
}

struct Singularity {
  quadrel::Point point;
  std::int32_t valence;
  // Longest edge of the triangle it is in.
  double edge;
};

std::vector<Singularity> singularities_of(const quadrel::Stages& stages) {
  const Triangles mesh = base_of(stages);
  std::vector<Singularity> result;
  for (std::size_t k = 0; k < stages.singularity_valences().size(); ++k) {
    const quadrel::Point p{stages.singularity_points()[2 * k], stages.singularity_points()[2 * k + 1]};
    double edge = 0;
    for (const Triangle& t : mesh.triangles) {
      const Kernel::Triangle_2 triangle(cgal(mesh.points[t[0]]), cgal(mesh.points[t[1]]), cgal(mesh.points[t[2]]));
      if (triangle.bounded_side(cgal(p)) == CGAL::ON_UNBOUNDED_SIDE) continue;
      for (int i = 0; i < 3; ++i) edge = std::max(edge, distance(mesh.points[t[i]], mesh.points[t[(i + 1) % 3]]));
    }
    CHECK(edge > 0);
    result.push_back({p, stages.singularity_valences()[k], edge});
  }
  return result;
}

// Pairs of the same valence, the closest first; the largest distance in edges.
double match(const std::vector<Singularity>& ours, const std::vector<Singularity>& theirs) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    for (std::size_t k = 0; k < theirs.size(); ++k) {
      if (ours[i].valence != theirs[k].valence) continue;
      pairs.emplace_back(distance(ours[i].point, theirs[k].point) / std::max(ours[i].edge, theirs[k].edge), i, k);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<bool> met(ours.size(), false), seen(theirs.size(), false);
  std::size_t count = 0;
  double worst = 0;
  for (const auto& [apart, i, k] : pairs) {
    if (met[i] || seen[k]) continue;
    met[i] = seen[k] = true;
    worst = std::max(worst, apart);
    ++count;
  }
  return count == ours.size() && count == theirs.size() ? worst : HUGE_VAL;
}

// The larger set without as many three-five pairs as it has too many, the closest ones first, if they are at most two
// edges apart: what places are compared to. The Gingerbread man's face is nearly symmetric, its three-valent
// point above the mouth on either side of the axis; base meshes of 4,000 to 45,000 triangles have one there, or two
// and a five-valent point between.
std::vector<Singularity> without_pairs(std::vector<Singularity> set, std::size_t count) {
  while (set.size() >= count + 2) {
    double closest = 2;
    std::size_t a = 0, b = 0;
    for (std::size_t i = 0; i < set.size(); ++i) {
      for (std::size_t k = 0; k < set.size(); ++k) {
        const double apart = distance(set[i].point, set[k].point) / std::max(set[i].edge, set[k].edge);
        if (set[i].valence == 3 && set[k].valence == 5 && apart <= closest) closest = apart, a = i, b = k;
      }
    }
    if (a == b) break;
    std::printf("  a three- and a five-valent point %.2f edges apart count as none\n", closest);
    set.erase(set.begin() + static_cast<std::ptrdiff_t>(std::max(a, b)));
    set.erase(set.begin() + static_cast<std::ptrdiff_t>(std::min(a, b)));
  }
  return set;
}

// The best match of all rotations about the origin that bring one of theirs to the direction of one of ours.
double match_rotated(const std::vector<Singularity>& ours, const std::vector<Singularity>& theirs) {
  double best = HUGE_VAL;
  if (theirs.empty()) return match(ours, theirs);
  for (const Singularity& own : ours) {
    const double angle = std::atan2(own.point[1], own.point[0]) - std::atan2(theirs[0].point[1], theirs[0].point[0]);
    std::vector<Singularity> turned = theirs;
    for (Singularity& s : turned) {
      s.point = {std::cos(angle) * s.point[0] - std::sin(angle) * s.point[1], std::sin(angle) * s.point[0] + std::cos(angle) * s.point[1]};
    }
    best = std::min(best, match(ours, turned));
  }
  return best;
}

void check(const Example& example, const std::string& folder) {
  std::printf("%s\n", example.file);
  const quadrel::Domain domain = quadrel::Domain::read(folder + "/" + example.file);
  quadrel::Stages own, given;
  quadrel::generate(domain, {}, &own);
  const Triangles base = base_of(own);
  double size = 0;
  for (const Triangle& t : base.triangles) size += distance(base.points[t[0]], base.points[t[1]]) / static_cast<double>(base.triangles.size());
  constrained_delaunay(base);
  const auto boundary = boundary_of(domain, size, example.chords);
  border(base, own, curves_of(domain), example.holes);

  quadrel::Options options;
  const Triangles theirs = triangulated(boundary, size, options);
  const quadrel::Mesh mesh = quadrel::generate(domain, options, &given);
  const Triangles used = base_of(given);
  CHECK(used.triangles == theirs.triangles);
  const auto all = singularities_of(own), all_theirs = singularities_of(given);
  const auto ours = without_pairs(all, all_theirs.size()), found = without_pairs(all_theirs, all.size());
  const double apart = example.round ? match_rotated(ours, found) : match(ours, found);
  CHECK(ours.size() == found.size() && apart <= 2);
  std::printf("  %zu singularities, on CGAL's triangulation %zu; %.2f edges apart; mesh of %zu elements\n", ours.size(), found.size(), apart,
              mesh.element_count());
  if (!(apart <= 2)) {
    for (const auto& list : {ours, found}) {
      for (const Singularity& s : list) std::printf("    valence %d at (%.5g, %.5g), edge %.3g\n", s.valence, s.point[0], s.point[1], s.edge);
      std::printf("    --\n");
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: triangulations FOLDER\n"), 2;
  for (const Example& example : EXAMPLES) {
    try {
      check(example, argv[1]);
    } catch (const std::exception& e) {
      std::fprintf(stderr, "%s: %s\n", example.file, e.what());
      ++failures;
    }
  }
  return failures != 0;
}
