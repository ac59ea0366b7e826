// MFEM solves Laplace's equation on our meshes, handed over as arrays and as files: convergence FOLDER [TABLE.csv],
// FOLDER is tests/domains. One mesh of order 10 for each domain, elements at most an eighth of the diagonal D; the
// solution's order p grows. The exact solution is u = sin(kx) cosh(ky), k = 2 pi / D.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <string>
#include <vector>

#include "../support/check.h"
#include "examples.hpp"
#include "laplace.hpp"
#include "mfem.hpp"
#include "mfem_mesh.hpp"

namespace {

constexpr int MESH_ORDER = 10;
constexpr double LARGEST_ELEMENT = 1.0 / 8;
// The error falls by the example's factor an order, on average, until it is this small.
constexpr double SMALL = 1e-9;
// What area and boundary length are measured for; the last stands for the exact domain.
constexpr double TOLERANCES[4] = {1e-2, 1e-4, 1e-6, 1e-8};

double diagonal(const quadrel::Mesh& mesh) {
  double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
  for (std::size_t k = 0; k < mesh.nodes().size(); ++k) {
    low[k % 2] = std::min(low[k % 2], mesh.nodes()[k]);
    high[k % 2] = std::max(high[k % 2], mesh.nodes()[k]);
  }
  return std::hypot(high[0] - low[0], high[1] - low[1]);
}

double area(mfem::Mesh& mesh) {
  double sum = 0.0;
  for (int e = 0; e < mesh.GetNE(); ++e) sum += mesh.GetElementVolume(e);
  return sum;
}

double boundary_length(mfem::Mesh& mesh) {
  double sum = 0.0;
  for (int k = 0; k < mesh.GetNBE(); ++k) {
    mfem::ElementTransformation& map = *mesh.GetBdrElementTransformation(k);
    const mfem::IntegrationRule& rule = mfem::IntRules.Get(mfem::Geometry::SEGMENT, 8 * MESH_ORDER);
    for (int q = 0; q < rule.GetNPoints(); ++q) {
      map.SetIntPoint(&rule.IntPoint(q));
      sum += rule.IntPoint(q).weight * map.Weight();
    }
  }
  return sum;
}

// The largest distance of points of elements from where the arrays have them.
double apart(mfem::Mesh& file, mfem::Mesh& arrays) {
  double worst = 0.0;
  mfem::Vector x(2), y(2);
  for (int e = 0; e < arrays.GetNE(); ++e) {
    for (int k = 0; k < 49; ++k) {
      const double places[7] = {0.0, 0.07, 0.21, 0.5, 0.55, 0.9, 1.0};
      mfem::IntegrationPoint at;
      at.Set2(places[k % 7], places[k / 7]);
      file.GetElementTransformation(e)->Transform(at, x);
      arrays.GetElementTransformation(e)->Transform(at, y);
      worst = std::max(worst, std::hypot(x[0] - y[0], x[1] - y[1]));
    }
  }
  return worst;
}

// Attributes where values are given: all, if the mesh does not tell boundaries apart.
mfem::Array<int> dirichlet(const mfem::Mesh& mesh, const quadrel::Mesh& own, const Example& example) {
  mfem::Array<int> marks(mesh.bdr_attributes.Max());
  for (int a = 0; a < marks.Size(); ++a) {
    const bool named = marks.Size() == static_cast<int>(own.boundary_count());
    marks[a] = !named || example.dirichlet.count(own.boundary_name(a)) != 0;
  }
  CHECK(marks.Max() == 1);
  return marks;
}

// Mean factor an order from the lowest to the first at which the error is small.
double mean_factor(const std::vector<Result>& results) {
  std::size_t last = 1;
  while (last + 1 < results.size() && results[last].error > SMALL) ++last;
  return std::pow(results[0].error / results[last].error, 1.0 / (results[last].p - results[0].p));
}

std::vector<Result> solved(mfem::Mesh& mesh, const quadrel::Mesh& own, const Example& example, std::initializer_list<int> orders) {
  std::vector<Result> results;
  for (int p : orders) results.push_back(solve(mesh, p, 2 * 3.14159265358979323846 / diagonal(own), dirichlet(mesh, own, example)));
  for (const Result& result : results) CHECK(result.p > 0);
  CHECK(mean_factor(results) >= example.factor);
  return results;
}

void table(const Example& example, const char* route, const std::vector<Result>& results, std::FILE* csv) {
  std::printf("  %-6s", route);
  for (const Result& result : results) {
    std::printf(" %d: %.1e", result.p, result.error);
    if (csv) std::fprintf(csv, "\"%s\",%s,%d,%d,%.6e\n", example.name.c_str(), route, result.p, result.unknowns, result.error);
  }
  std::printf("  factor %.1f\n", mean_factor(results));
}

void solutions(const Example& example, const quadrel::Mesh& mesh, std::FILE* csv) {
  mfem::Mesh arrays = mfem_mesh(mesh);
  std::printf("%s: %zu elements of order %d\n", example.name.c_str(), mesh.element_count(), mesh.order());
  const std::vector<Result> results = solved(arrays, mesh, example, {2, 3, 4, 5, 6, 7, 8, 9, 10});
  table(example, "arrays", results, csv);
  const struct {
    const char* route;
    quadrel::Format format;
    double rounding;
    bool names;
  } files[] = {{".mfem", quadrel::Format::Mfem, 1e-14, true}, {".msh", quadrel::Format::Msh, 1e-12, true}, {".vtu", quadrel::Format::Vtu, 1e-12, false}};
  for (const auto& file : files) {
    const std::string path = std::string("solver") + file.route;
    mesh.write(file.format, path);
    mfem::Mesh read(path.c_str(), 1, 1);
    CHECK(std::remove(path.c_str()) == 0);
    CHECK(read.GetNE() == arrays.GetNE() && read.GetNV() == arrays.GetNV() && read.GetNBE() == arrays.GetNBE());
    CHECK(read.bdr_attributes.Size() == (file.names ? arrays.bdr_attributes.Size() : 1));
    CHECK(apart(read, arrays) <= file.rounding * diagonal(mesh));
    const std::vector<Result> again = solved(read, mesh, example, {2, 6, 10});
    table(example, file.route, again, csv);
    // With boundaries told apart it is the same problem on the same mesh.
    for (const Result& result : again) {
      const double error = results[static_cast<std::size_t>(result.p - 2)].error;
      CHECK(!file.names || std::abs(result.error - error) <= 1e-3 * error + 1e-11);
    }
  }
}

// Area and boundary length come closer to those of a mesh that is finer by far, and to the exact ones of the annulus.
void lengths(const Example& example, std::FILE* csv) {
  double areas[4], boundaries[4];
  for (int k = 0; k < 4; ++k) {
    const quadrel::Mesh mesh = quadrel::generate(example.domain, quadrel::Options().order(MESH_ORDER).relative_tolerance(TOLERANCES[k]));
    mfem::Mesh arrays = mfem_mesh(mesh);
    areas[k] = area(arrays);
    boundaries[k] = boundary_length(arrays);
  }
  if (example.name == "annulus") {
    const double pi = 3.14159265358979323846;
    CHECK(std::abs(areas[3] / (pi * (1 - 0.16)) - 1) < 1e-9 && std::abs(boundaries[3] / (2.8 * pi) - 1) < 1e-9);
  }
  std::printf("  area and boundary length, relative errors:");
  for (int k = 0; k < 3; ++k) {
    const double a = std::abs(areas[k] / areas[3] - 1), b = std::abs(boundaries[k] / boundaries[3] - 1);
    std::printf("  %.0e: %.1e %.1e", TOLERANCES[k], a, b);
    if (csv) std::fprintf(csv, "\"%s\",area at %.0e,,,%.6e\n\"%s\",length at %.0e,,,%.6e\n", example.name.c_str(), TOLERANCES[k], a, example.name.c_str(), TOLERANCES[k], b);
    CHECK(a <= 10 * TOLERANCES[k] && b <= 100 * TOLERANCES[k]);
  }
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 && argc != 3) return std::fprintf(stderr, "usage: convergence FOLDER [TABLE.csv]\n"), 2;
  std::FILE* const csv = argc == 3 ? std::fopen(argv[2], "w") : nullptr;
  if (csv) std::fprintf(csv, "domain,route,p,unknowns,error\n");
  try {
    for (const Example& example : examples(argv[1])) {
      const double extent = diagonal(quadrel::generate(example.domain));
      quadrel::Options options;
      options.order(MESH_ORDER).relative_tolerance(example.tolerance).max_element_size(LARGEST_ELEMENT * extent);
      solutions(example, quadrel::generate(example.domain, options), csv);
      if (example.tolerance >= TOLERANCES[2]) lengths(example, csv);
    }
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    ++failures;
  }
  if (csv) std::fclose(csv);
  return failures != 0;
}
