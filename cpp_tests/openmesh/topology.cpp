// Meshes of twenty domains as OpenMesh sees them: 2-manifolds of the right Euler number, boundary loops and
// valences. OpenMesh gets nothing but vertices and corners; everything else that quadrel tells is compared with
// what OpenMesh makes of these. topology FOLDER: tests/domains.
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "../support/check.h"
#include "quadrel.hpp"

namespace {

struct Traits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
};
using Surface = OpenMesh::PolyMesh_ArrayKernelT<Traits>;

struct Example {
  const char* file;
  std::size_t holes;
};

// Holes counted in the files: chains of inner boundaries, paths inside paths.
const Example EXAMPLES[] = {
    {"hohq/GingerbreadMan.control", 6},
    {"hohq/NACA0012.control", 1},
    {"hohq/PacMan.control", 0},
    {"hohq/SplineGeometry.control", 0},
    {"hohq/EllipseAndFourCircles.control", 4},
    {"hohq/IceCreamConeCommented.control", 1},
    {"hohq/BlobAdapt.control", 0},
    {"hohq/Pill.control", 3},
    {"icons/mdi/alpha-b.svg", 2},
    {"mech/unit-circle.control", 0},
    {"mech/half-disc.control", 0},
    {"mech/l-shape.control", 0},
    {"mech/nema17-plate.control", 5},
    {"mech/tubes-hex-7.control", 7},
    {"mech/turek-hron-fsi.control", 1},
    {"mech/section-angle-50x5.control", 0},
    {"airfoils/naca2412.control", 1},
    {"glyphs/DejaVuSans/u0038.svg", 2},
    {"glyphs/LatinModernRoman/u0026.svg", 2},
    {"icons/mdi/alpha-d-circle-outline-2.svg", 1},
};
static_assert(sizeof EXAMPLES / sizeof *EXAMPLES == 20);

// A number of the statistics: what follows `key` in its first object `object`.
std::size_t counted(const std::string& json, const std::string& object, const std::string& key) {
  const std::size_t from = json.find("\"" + object + "\"");
  const std::size_t at = json.find("\"" + key + "\":", from);
  CHECK(from != std::string::npos && at != std::string::npos);
  return std::stoul(json.substr(at + key.size() + 3));
}

// How many elements the paper's table gives a corner; ties downwards.
unsigned by_table(double angle) {
  const double eighth = std::acos(-1.0) / 4;
  return 1u + (angle > 3 * eighth + 1e-6) + (angle > 5 * eighth + 1e-6) + (angle > 7 * eighth + 1e-6);
}

// OpenMesh refuses a face at an edge that has two faces already, and one that would make a vertex a junction of
// two sheets.
bool built(const quadrel::Mesh& mesh, Surface& surface) {
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    surface.add_vertex({mesh.vertices()[2 * v], mesh.vertices()[2 * v + 1], 0.0});
  }
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    std::vector<Surface::VertexHandle> corners;
    for (int k = 0; k < 4; ++k) corners.emplace_back(mesh.elements()[4 * e + k]);
    if (!surface.add_face(corners).is_valid()) return false;
  }
  return true;
}

void manifold(const Surface& surface, const quadrel::Mesh& mesh, std::size_t holes) {
  CHECK(surface.n_vertices() == mesh.vertex_count() && surface.n_faces() == mesh.element_count());
  CHECK(surface.n_edges() == mesh.edge_count());
  for (const auto v : surface.vertices()) CHECK(surface.is_manifold(v) && !surface.is_isolated(v));
  const long euler = static_cast<long>(surface.n_vertices()) - static_cast<long>(surface.n_edges()) + static_cast<long>(surface.n_faces());
  CHECK(euler == 1 - static_cast<long>(holes));

  // One piece.
  std::vector<bool> met(surface.n_faces(), false);
  std::vector<Surface::FaceHandle> open{Surface::FaceHandle(0)};
  std::size_t reached = 0;
  met[0] = true;
  while (!open.empty()) {
    const Surface::FaceHandle face = open.back();
    open.pop_back();
    ++reached;
    for (const auto other : surface.ff_range(face)) {
      if (met[other.idx()]) continue;
      met[other.idx()] = true;
      open.push_back(other);
    }
  }
  CHECK(reached == surface.n_faces());
}

// Sides: who is across, and which edges are the border.
void neighbors(const Surface& surface, const quadrel::Mesh& mesh) {
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    for (int s = 0; s < 4; ++s) {
      const Surface::VertexHandle a(mesh.elements()[4 * e + s]), b(mesh.elements()[4 * e + (s + 1) % 4]);
      const auto side = surface.find_halfedge(a, b);
      CHECK(side.is_valid() && side.face().idx() == static_cast<int>(e));
      const auto across = side.opp();
      CHECK((across.is_boundary() ? -1 : across.face().idx()) == mesh.element_neighbors()[4 * e + s]);
      CHECK(across.is_boundary() == (mesh.element_boundaries()[4 * e + s] >= 0));
    }
  }
}

// Each loop of OpenMesh's border is one loop of the domain, whole.
void loops(const Surface& surface, const quadrel::Mesh& mesh, std::size_t holes) {
  std::map<std::pair<int, int>, std::int32_t> loop_of;
  std::map<std::int32_t, std::size_t> edges_of;
  for (std::size_t e = 0; e < mesh.edge_count(); ++e) {
    if (mesh.edge_loops()[e] < 0) continue;
    loop_of[{mesh.edge_vertices()[2 * e], mesh.edge_vertices()[2 * e + 1]}] = mesh.edge_loops()[e];
    ++edges_of[mesh.edge_loops()[e]];
  }
  std::vector<bool> met(surface.n_halfedges(), false);
  std::size_t count = 0, outer = 0;
  std::set<std::int32_t> found;
  for (const auto start : surface.halfedges()) {
    if (!start.is_boundary() || met[start.idx()]) continue;
    ++count;
    std::set<std::int32_t> own;
    std::size_t length = 0;
    double area = 0;
    auto h = start;
    do {
      met[h.idx()] = true;
      ++length;
      // Outside of the border runs against quadrel's direction, which has the domain to the left.
      const auto known = loop_of.find({h.to().idx(), h.from().idx()});
      CHECK(known != loop_of.end());
      if (known != loop_of.end()) own.insert(known->second);
      const auto p = surface.point(h.to()), q = surface.point(h.from());
      area += 0.5 * (p[0] * q[1] - p[1] * q[0]);
      h = h.next();
    } while (h != start);
    CHECK(own.size() == 1);
    if (own.size() == 1) {
      CHECK(length == edges_of[*own.begin()]);
      found.insert(*own.begin());
    }
    outer += area > 0;
  }
  CHECK(count == holes + 1 && found.size() == count && outer == 1);
}

void valences(const Surface& surface, const quadrel::Mesh& mesh, const quadrel::Stages& stages) {
  // What the domain asks for: 4 inside, 2 on the border, at corners by their angle.
  std::vector<unsigned> expected;
  double x[2] = {HUGE_VAL, -HUGE_VAL};
  for (const auto v : surface.vertices()) {
    expected.push_back(v.is_boundary() ? 2 : 4);
    x[0] = std::min(x[0], surface.point(v)[0]);
    x[1] = std::max(x[1], surface.point(v)[0]);
  }
  for (std::size_t c = 0; c < stages.corner_angles().size(); ++c) {
    const Surface::Point corner(stages.corner_points()[2 * c], stages.corner_points()[2 * c + 1], 0.0);
    const auto distance = [&](Surface::VertexHandle v) { return (surface.point(v) - corner).norm(); };
    const auto nearest = *std::min_element(surface.vertices_begin(), surface.vertices_end(),
                                           [&](auto a, auto b) { return distance(a) < distance(b); });
    // Gaps in the files are closed to a point near by.
    CHECK(surface.is_boundary(nearest) && distance(nearest) < 1e-4 * (x[1] - x[0]));
    expected[nearest.idx()] = by_table(stages.corner_angles()[c]);
  }
  std::size_t inside = 0, border = 0;
  long index = 0, sum = 0;
  for (const auto v : surface.vertices()) {
    const unsigned elements = v.valence() - (v.is_boundary() ? 1 : 0);
    // The vertex of a lone element inside two others cannot be a valid one.
    CHECK(v.is_boundary() ? elements >= 1 : elements >= 3);
    CHECK(elements <= 8);
    (v.is_boundary() ? border : inside) += elements != expected[v.idx()];
    index += v.is_boundary() ? 2 - static_cast<long>(elements) : 4 - static_cast<long>(elements);
    sum += elements;
  }
  const std::string json = mesh.statistics_json();
  CHECK(inside == counted(json, "irregular", "interior"));
  CHECK(border == counted(json, "irregular", "boundary"));
  CHECK(sum == 4 * static_cast<long>(surface.n_faces()));
  const long euler = static_cast<long>(surface.n_vertices()) - static_cast<long>(surface.n_edges()) + static_cast<long>(surface.n_faces());
  CHECK(index == 4 * euler);
  std::printf(" irregular %zu inside, %zu on the border\n", inside, border);
}

// The checks above would be worth nothing if OpenMesh took everything.
void refuses() {
  Surface fan;
  std::vector<Surface::VertexHandle> v;
  for (int k = 0; k < 5; ++k) v.push_back(fan.add_vertex({double(k), double(k * k), 0.0}));
  CHECK(fan.add_face(v[0], v[1], v[2]).is_valid() && fan.add_face(v[1], v[0], v[3]).is_valid());
  CHECK(!fan.add_face(v[0], v[1], v[4]).is_valid());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: topology FOLDER\n"), 2;
  refuses();
  for (const Example& example : EXAMPLES) {
    const int before = failures;
    try {
      const quadrel::Domain domain = quadrel::Domain::read(std::string(argv[1]) + "/" + example.file);
      quadrel::Stages stages;
      const quadrel::Mesh mesh = quadrel::generate(domain, &stages);
      std::printf("%s: %zu elements,", example.file, mesh.element_count());
      Surface surface;
      if (!built(mesh, surface)) throw std::runtime_error("OpenMesh refuses an element");
      manifold(surface, mesh, example.holes);
      neighbors(surface, mesh);
      loops(surface, mesh, example.holes);
      valences(surface, mesh, stages);
    } catch (const std::exception& e) {
      std::fprintf(stderr, "%s: %s\n", example.file, e.what());
      ++failures;
    }
    if (failures > before) std::fprintf(stderr, "%s: see above\n", example.file);
  }
  return failures != 0;
}
