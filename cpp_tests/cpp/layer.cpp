// quadrel.hpp: every member, against the C interface.
#include <cmath>
#include <cstdio>
#include <string>
#include <type_traits>
#include <utility>

#include "../support/check.h"
#include "../support/shapes.h"
#include "quadrel.hpp"

namespace {

using quadrel::Point;

static_assert(!std::is_copy_constructible_v<quadrel::Mesh> && std::is_nothrow_move_constructible_v<quadrel::Mesh>);
static_assert(!std::is_copy_constructible_v<quadrel::Domain> && std::is_nothrow_move_constructible_v<quadrel::Domain>);
static_assert(std::is_base_of_v<std::runtime_error, quadrel::Error>);

template <class Work>
quadrel_status thrown(Work work) {
  try {
    work();
  } catch (const quadrel::Error& e) {
    CHECK(std::string(e.name()) == quadrel_status_name(e.status()) && e.what()[0] != '\0');
    return e.status();
  }
  return QUADREL_OK;
}

quadrel::Domain everything() {
  quadrel::Domain domain;
  domain.begin(quadrel::Loop::Outer, std::string("wall"));
  domain.line({0, 0}, {4, 0}, "bottom").arc({4, 1}, 1, -TEST_PI / 2, TEST_PI / 2);
  domain.bezier({{4, 2}, {3.8, 2.2}, {3.3, 2}, {3, 2}}).elliptic_arc({2, 2}, {1, 0.5}, 0, 0, TEST_PI);
  domain.spline({{1, 2}, {0.7, 2.2}, {0.3, 2.1}, {0, 2}}).expression("-0.2*sin(pi*t)", "2*(1 - t)", "left").end();
  domain.begin(quadrel::Loop::Hole, "hole");
  domain.curve([](double t) { return Point{2 + 0.3 * std::cos(2 * TEST_PI * t), 1 + 0.3 * std::sin(2 * TEST_PI * t)}; },
               [](double t) { return Point{-0.6 * TEST_PI * std::sin(2 * TEST_PI * t), 0.6 * TEST_PI * std::cos(2 * TEST_PI * t)}; });
  domain.end();
  domain.join_tolerance(1e-6).check();
  return domain;
}

void meshes() {
  const quadrel::Domain domain = everything();
  quadrel::Options options;
  options.order(4).relative_tolerance(1e-4, quadrel::Norm::H1).tolerance(1e-3, quadrel::Norm::Max);
  options.field(quadrel::Field::Diffused).subdivision(quadrel::Subdivision::EqualError).symmetry(true).effort(quadrel::Effort::Default);
  options.max_element_size(2).base_mesh_size(0).quality_floor(0.4).max_elements(5000);
  quadrel::Stages stages;
  quadrel::Mesh mesh = quadrel::generate(domain, options, &stages);
  CHECK(mesh.order() == 4 && mesh.boundary_count() == 4 && mesh.element_count() > 0);
  CHECK(mesh.vertex_count() + mesh.element_count() == mesh.edge_count());
  CHECK(mesh.vertices().size() == 2 * mesh.vertex_count() && mesh.nodes().size() == 2 * mesh.node_count());
  CHECK(mesh.elements().size() == 4 * mesh.element_count() && mesh.element_neighbors().size() == mesh.elements().size());
  CHECK(mesh.element_edges().size() == mesh.element_boundaries().size());
  CHECK(mesh.element_blocks().size() == mesh.element_count());
  CHECK(mesh.edge_vertices().size() == 2 * mesh.edge_count() && mesh.edge_elements().size() == mesh.edge_sides().size());
  CHECK(mesh.edge_boundaries().size() == mesh.edge_loops().size());
  CHECK(mesh.edge_segments().size() == mesh.edge_parameters().size());
  CHECK(mesh.element_nodes().size() == 25 * mesh.element_count() && mesh.reference_nodes().size() == 5);
  std::int32_t largest = 0;
  for (std::int32_t node : mesh.element_nodes()) largest = node > largest ? node : largest;
  CHECK(static_cast<std::size_t>(largest) + 1 == mesh.node_count());
  bool has_hole = false;
  for (std::int32_t b = 0; b < 4; ++b) has_hole = has_hole || mesh.boundary_name(b) == "hole";
  CHECK(has_hole && mesh.boundary_name(4).empty());
  const quadrel::Range range = mesh.quality_range(QUADREL_MEASURE_BOUNDARY_ERROR);
  CHECK(range.max > 0 && range.max <= 1e-3 && mesh.quality(QUADREL_MEASURE_AREA).size() == mesh.element_count());
  CHECK(mesh.statistics_json() == stages.statistics_json());
  mesh.write(quadrel::Format::Svg, "layer.svg");
  CHECK(std::remove("layer.svg") == 0);
  CHECK(thrown([&] { mesh.write(quadrel::Format::Vtu, "no/such/folder/x.vtu"); }) == QUADREL_ERROR_IO);
  for (quadrel::Format format : {quadrel::Format::Vtu, quadrel::Format::Msh, quadrel::Format::Ism, quadrel::Format::IsmV2,
                                 quadrel::Format::IsmMm, quadrel::Format::Inp, quadrel::Format::Mfem, quadrel::Format::Svg}) {
    CHECK(thrown([&] { mesh.write(format, [](const void*, std::size_t) { return false; }); }) == QUADREL_ERROR_CANCELLED);
    CHECK(thrown([&] { mesh.write(format, "/dev/full"); }) == QUADREL_ERROR_IO);
  }
  const quadrel::Mesh high = quadrel::generate(domain, quadrel::Options().order(11).relative_tolerance(1e-3));
  CHECK(thrown([&] { high.write(quadrel::Format::Msh, "layer.msh"); }) == QUADREL_ERROR_UNSUPPORTED);
  CHECK(std::remove("layer.msh") != 0);

  CHECK(stages.reached() == QUADREL_STAGE_MESH && stages.seconds(QUADREL_STAGE_LAYOUT) >= 0);
  CHECK(stages.base_vertices().size() == stages.cross_field().size() && !stages.base_triangles().empty());
  CHECK(stages.singularity_points().size() == 2 * stages.singularity_valences().size());
  CHECK(stages.corner_points().size() == 2 * stages.corner_quads().size() && stages.corner_angles().size() == stages.corner_quads().size());
  CHECK(stages.blocks().size() == stages.block_sides().size() && stages.separatrices().size() > 0);
  CHECK(2 * stages.blocks().offsets[stages.blocks().size()] == stages.blocks().points.size());
  stages.write_svg(QUADREL_PICTURE_ALL, "layer.svg");
  CHECK(std::remove("layer.svg") == 0);

  quadrel::Mesh moved = std::move(mesh);
  CHECK(moved.element_count() > 0);
}

// The disc on a base mesh of rings made here.
void own_base_mesh() {
  constexpr std::int32_t sectors = 48, rings = 10;
  std::vector<Point> points{{0, 0}};
  std::vector<std::array<std::int32_t, 3>> triangles, boundary;
  std::vector<double> parameters;
  const auto at = [](std::int32_t ring, std::int32_t k) { return 1 + (ring - 1) * sectors + (k + sectors) % sectors; };
  for (std::int32_t ring = 1; ring <= rings; ++ring) {
    for (std::int32_t k = 0; k < sectors; ++k) {
      const double t = static_cast<double>(k) / sectors, radius = static_cast<double>(ring) / rings;
      points.push_back({radius * std::cos(2 * TEST_PI * t), radius * std::sin(2 * TEST_PI * t)});
      if (ring == 1) {
        triangles.push_back({0, at(1, k), at(1, k + 1)});
      } else {
        triangles.push_back({at(ring - 1, k), at(ring, k), at(ring, k + 1)});
        triangles.push_back({at(ring - 1, k), at(ring, k + 1), at(ring - 1, k + 1)});
      }
      if (ring == rings) {
        boundary.push_back({at(ring, k), 0, 0});
        parameters.push_back(t);
      }
    }
  }
  quadrel::Domain disc;
  disc.begin(quadrel::Loop::Outer).arc({0, 0}, 1, 0, 2 * TEST_PI).end();
  quadrel::Stages stages;
  quadrel::Options options;
  options.base_triangulation(points, triangles, boundary, parameters);
  const quadrel::Mesh mesh = quadrel::generate(disc, options, &stages);
  CHECK(mesh.element_count() <= 12 && stages.base_vertices().size() == 2 * points.size());
  CHECK(stages.singularity_valences().size() == 4);
  for (std::int32_t valence : stages.singularity_valences()) CHECK(valence == 3);
  for (std::size_t i = 0; i < points.size(); ++i) CHECK(std::abs(stages.base_vertices()[2 * i] - points[i][0]) < 1e-12);

  boundary[0][2] = 1;
  options.base_triangulation(points, triangles, boundary, parameters);
  CHECK(thrown([&] { quadrel::generate(disc, options); }) == QUADREL_ERROR_INVALID_ARGUMENT);
  boundary[0] = {-1, 0, 0};
  options.base_triangulation(points, triangles, boundary, parameters);
  CHECK(thrown([&] { quadrel::generate(disc, options); }) == QUADREL_ERROR_INVALID_ARGUMENT);
  boundary.erase(boundary.begin());
  parameters.erase(parameters.begin());
  options.base_triangulation(points, triangles, boundary, parameters);
  CHECK(thrown([&] { quadrel::generate(disc, options, &stages); }) == QUADREL_ERROR_BASE_MESH);
  CHECK(stages.reached() == QUADREL_STAGE_DOMAIN);
  options.base_triangulation({}, {}, {}, {});
  CHECK(quadrel::generate(disc, options).element_count() > 0);
}

void errors() {
  quadrel::Domain bow_tie;
  bow_tie.begin(quadrel::Loop::Outer).line({0, 0}, {4, 4}).line({4, 4}, {0, 4}).line({0, 4}, {4, 0}).line({4, 0}, {0, 0}).end();
  try {
    quadrel::generate(bow_tie);
    CHECK(!"refused");
  } catch (const quadrel::Error& e) {
    CHECK(e.status() == QUADREL_ERROR_INTERSECTION && e.place().has_value());
    CHECK(e.place() && std::abs((*e.place())[0] - 2) < 1e-6);
  }
  CHECK(thrown([] { quadrel::Options().order(0); }) == QUADREL_ERROR_INVALID_ARGUMENT);
  CHECK(thrown([] { quadrel::Domain::read("none.svg"); }) == QUADREL_ERROR_IO);
  CHECK(thrown([] { quadrel::Domain().end(); }) == QUADREL_ERROR_INVALID_ARGUMENT);
  quadrel::Stages stages;
  CHECK(stages.statistics_json().empty() && stages.separatrices().size() == 0 && stages.base_vertices().empty());
}

void files() {
  const quadrel::Domain square = quadrel::Domain::parse("<svg><path d='M0 0H1V1H0Z'/></svg>", quadrel::Input::Svg);
  CHECK(!square.file_order() && !square.file_tolerance());
  CHECK(quadrel::generate(square).element_count() > 0);
}

}  // namespace

int main() {
  meshes();
  own_base_mesh();
  errors();
  files();
  return failures != 0;
}
