// What VTK reads, evaluates and measures is the mesh: grid FOLDER, tests/domains.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <vtkCell.h>
#include <vtkDataArray.h>
#include <vtkMeshQuality.h>
#include <vtkXMLUnstructuredGridReader.h>

#include "../support/check.h"
#include "quadrel_vtk.hpp"

namespace {

struct Example {
  const char* file;
  int order;
};
const Example EXAMPLES[] = {
    {"hohq/PacMan.control", 1},         {"hohq/SplineGeometry.control", 2}, {"mech/unit-circle.control", 3},
    {"hohq/NACA0012.control", 4},       {"hohq/GingerbreadMan.control", 5}, {"mech/nema17-plate.control", 6},
    {"glyphs/DejaVuSans/u0038.svg", 7}, {"hohq/BlobAdapt.control", 12},
};

double diagonal(const quadrel::Mesh& mesh) {
  double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
  for (std::size_t k = 0; k < 2 * mesh.node_count(); ++k) {
    low[k % 2] = std::min(low[k % 2], mesh.nodes()[k]);
    high[k % 2] = std::max(high[k % 2], mesh.nodes()[k]);
  }
  return std::hypot(high[0] - low[0], high[1] - low[1]);
}

// The Lagrange polynomials of the mesh's nodes at x in [-1, 1], as they are defined.
std::vector<double> basis(const quadrel::Mesh& mesh, double x) {
  const auto nodes = mesh.reference_nodes();
  std::vector<double> values(nodes.size(), 1.0);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      if (k != i) values[i] *= (x - nodes[k]) / (nodes[i] - nodes[k]);
    }
  }
  return values;
}

// The element's own interpolation, by these.
quadrel::Point interpolated(const quadrel::Mesh& mesh, std::size_t element, const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t row = x.size();
  quadrel::Point sum{0.0, 0.0};
  for (std::size_t j = 0; j < row; ++j) {
    for (std::size_t i = 0; i < row; ++i) {
      const auto node = static_cast<std::size_t>(mesh.element_nodes()[(element * row + j) * row + i]);
      sum[0] += x[i] * y[j] * mesh.nodes()[2 * node];
      sum[1] += x[i] * y[j] * mesh.nodes()[2 * node + 1];
    }
  }
  return sum;
}

vtkSmartPointer<vtkUnstructuredGrid> read(const std::string& path) {
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  CHECK(reader->CanReadFile(path.c_str()) == 1);
  reader->SetFileName(path.c_str());
  reader->Update();
  CHECK(reader->GetErrorCode() == 0);
  return reader->GetOutput();
}

// The arrays are those of the C interface.
void arrays(vtkUnstructuredGrid* grid, const quadrel::Mesh& mesh) {
  const auto cells = static_cast<vtkIdType>(mesh.element_count());
  CHECK(grid->GetNumberOfCells() == cells && grid->GetNumberOfPoints() == static_cast<vtkIdType>(mesh.node_count()));
  vtkCellData* const data = grid->GetCellData();
  CHECK(data->GetNumberOfArrays() == 5 && data->GetScalars() == data->GetArray("scaled_jacobian"));
  const char* const names[4] = {"scaled_jacobian", "jacobian_ratio", "block", "boundary"};
  const int types[4] = {VTK_DOUBLE, VTK_DOUBLE, VTK_INT, VTK_INT};
  for (int k = 0; k < 4; ++k) {
    vtkDataArray* const array = data->GetArray(names[k]);
    CHECK(array && array->GetDataType() == types[k] && array->GetNumberOfTuples() == cells);
    CHECK(array && array->GetNumberOfComponents() == (k == 3 ? 4 : 1));
    if (!array || array->GetNumberOfTuples() != cells) return;
  }
  const std::vector<double> scaled = mesh.quality(QUADREL_MEASURE_SCALED_JACOBIAN), ratio = mesh.quality(QUADREL_MEASURE_JACOBIAN_RATIO);
  for (vtkIdType c = 0; c < cells; ++c) {
    const auto e = static_cast<std::size_t>(c);
    CHECK(data->GetArray("scaled_jacobian")->GetComponent(c, 0) == scaled[e]);
    CHECK(data->GetArray("jacobian_ratio")->GetComponent(c, 0) == ratio[e]);
    CHECK(data->GetArray("block")->GetComponent(c, 0) == mesh.element_blocks()[e]);
    for (int s = 0; s < 4; ++s) CHECK(data->GetArray("boundary")->GetComponent(c, s) == mesh.element_boundaries()[4 * e + static_cast<std::size_t>(s)]);
  }
  const auto boundaries = vtkStringArray::SafeDownCast(data->GetAbstractArray("boundary_name"));
  CHECK(boundaries && boundaries->GetNumberOfComponents() == 4 && boundaries->GetNumberOfValues() == 4 * cells);
  for (vtkIdType k = 0; boundaries && k < boundaries->GetNumberOfValues(); ++k) {
    CHECK(boundaries->GetValue(k) == mesh.boundary_name(mesh.element_boundaries()[static_cast<std::size_t>(k)]));
  }
}

// VTK evaluates its cells where the mesh evaluates its elements; so VTK's nodes are in the order it wants.
double evaluated(vtkUnstructuredGrid* grid, const quadrel::Mesh& mesh) {
  double worst = 0.0;
  std::vector<double> weights((mesh.reference_nodes().size()) * mesh.reference_nodes().size());
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    vtkCell* const cell = grid->GetCell(static_cast<vtkIdType>(e));
    CHECK(cell->GetCellType() == VTK_LAGRANGE_QUADRILATERAL);
    for (int k = 0; k < 81; ++k) {
      // Vertices, sides and inside; nowhere symmetric to the diagonals.
      const double places[9] = {0.0, 0.07, 0.21, 0.38, 0.5, 0.55, 0.71, 0.9, 1.0};
      const double parametric[3] = {places[k % 9], places[k / 9], 0.0};
      double x[3];
      int part = 0;
      cell->EvaluateLocation(part, parametric, x, weights.data());
      const quadrel::Point own = interpolated(mesh, e, basis(mesh, 2 * parametric[0] - 1), basis(mesh, 2 * parametric[1] - 1));
      worst = std::max(worst, std::max(std::hypot(x[0] - own[0], x[1] - own[1]), std::abs(x[2])));
    }
  }
  return worst;
}

// Verdict's least scaled Jacobian over each element's pieces x pieces linear quadrilaterals: those that it is cut into,
// or small ones at as many places, up to its sides.
enum class Pieces { Whole, Small };

std::vector<double> verdict(const quadrel::Mesh& mesh, int pieces, Pieces kind) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkUnstructuredGrid> grid;
  grid->SetPoints(points);
  // Both ends of each piece, in one direction.
  const double half = kind == Pieces::Small ? 1e-4 : 1.0 / pieces;
  std::vector<std::vector<double>> ends;
  for (int k = 0; k < pieces; ++k) {
    const double centre = (1 - half) * (2.0 * k / (pieces - 1) - 1);
    for (double end : {centre - half, centre + half}) ends.push_back(basis(mesh, end));
  }
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    for (std::size_t y = 0; y < ends.size(); y += 2) {
      for (std::size_t x = 0; x < ends.size(); x += 2) {
        vtkIdType corners[4];
        for (std::size_t c = 0; c < 4; ++c) {
          const quadrel::Point p = interpolated(mesh, e, ends[x + (c == 1 || c == 2)], ends[y + (c >= 2)]);
          corners[c] = points->InsertNextPoint(p[0], p[1], 0.0);
        }
        grid->InsertNextCell(VTK_QUAD, 4, corners);
      }
    }
  }
  vtkNew<vtkMeshQuality> quality;
  quality->SetInputData(grid);
  quality->SetQuadQualityMeasureToScaledJacobian();
  quality->SaveCellQualityOn();
  quality->Update();
  vtkDataArray* const values = quality->GetOutput()->GetCellData()->GetArray("Quality");
  CHECK(values && values->GetNumberOfTuples() == grid->GetNumberOfCells());
  std::vector<double> least(mesh.element_count(), HUGE_VAL);
  if (!values) return least;
  for (vtkIdType k = 0; k < values->GetNumberOfTuples(); ++k) {
    double& own = least[static_cast<std::size_t>(k / (pieces * pieces))];
    own = std::min(own, values->GetComponent(k, 0));
  }
  return least;
}

// The largest distance from 1 of the ratio of two measures.
double apart(const std::vector<double>& measured, const std::vector<double>& ours) {
  double worst = 0.0;
  for (std::size_t e = 0; e < ours.size(); ++e) worst = std::max(worst, std::abs(measured[e] / ours[e] - 1));
  return worst;
}

// Cells, connectivity, types and arrays are the same; points up to rounding.
double difference(vtkUnstructuredGrid* a, vtkUnstructuredGrid* b) {
  CHECK(a->GetNumberOfPoints() == b->GetNumberOfPoints() && a->GetNumberOfCells() == b->GetNumberOfCells());
  if (a->GetNumberOfPoints() != b->GetNumberOfPoints() || a->GetNumberOfCells() != b->GetNumberOfCells()) return HUGE_VAL;
  CHECK(a->GetPoints()->GetDataType() == VTK_DOUBLE && b->GetPoints()->GetDataType() == VTK_DOUBLE);
  double worst = 0.0;
  for (vtkIdType p = 0; p < a->GetNumberOfPoints(); ++p) {
    double x[3], y[3];
    a->GetPoint(p, x);
    b->GetPoint(p, y);
    for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(x[c] - y[c]));
  }
  for (vtkIdType c = 0; c < a->GetNumberOfCells(); ++c) {
    vtkNew<vtkIdList> own, other;
    a->GetCellPoints(c, own);
    b->GetCellPoints(c, other);
    bool same = a->GetCellType(c) == b->GetCellType(c) && own->GetNumberOfIds() == other->GetNumberOfIds();
    for (vtkIdType k = 0; same && k < own->GetNumberOfIds(); ++k) same = own->GetId(k) == other->GetId(k);
    CHECK(same);
  }
  return worst;
}

void check(const Example& example, const std::string& folder) {
  const quadrel::Domain domain = quadrel::Domain::read(folder + "/" + example.file);
  const quadrel::Mesh mesh = quadrel::generate(domain, quadrel::Options().order(example.order).relative_tolerance(1e-4));
  CHECK(mesh.order() == example.order);
  const std::string path = "vtk_order_" + std::to_string(example.order) + ".vtu";
  mesh.write(quadrel::Format::Vtu, path);
  const auto file = read(path);
  const auto direct = quadrel::vtk_grid(mesh);
  arrays(file, mesh);
  arrays(direct, mesh);
  // Nodes interpolated from Gauss-Lobatto to equispaced points and back lose digits with the order: at order 12
  // VTK's basis alone amplifies roundings by 90.
  const double rounding = 1e-15 * diagonal(mesh) * (mesh.order() <= 7 ? 10 : 1000);
  const double differ = difference(file, direct), from_file = evaluated(file, mesh), from_memory = evaluated(direct, mesh);
  CHECK(differ <= rounding && from_file <= rounding && from_memory <= rounding);
  // Small pieces show the measure itself. The sides of the pieces that an element is cut into stand off the curved ones'
  // directions in proportion to their length, by up to 7 per cent at 32 x 32 where curvature is large: a
  // first-order part, which Richardson's extrapolation from 64 x 64 takes off.
  const std::vector<double> ours = mesh.quality(QUADREL_MEASURE_SCALED_JACOBIAN);
  // Between 32 places the measure of an element of order 12 varies by more than is allowed for.
  const double small = apart(verdict(mesh, mesh.order() <= 7 ? 32 : 64, Pieces::Small), ours);
  const std::vector<double> pieces = verdict(mesh, 32, Pieces::Whole), halves = verdict(mesh, 64, Pieces::Whole);
  std::vector<double> extrapolated(ours.size());
  for (std::size_t e = 0; e < ours.size(); ++e) extrapolated[e] = 2 * halves[e] - pieces[e];
  const double limit = apart(extrapolated, ours), coarse = apart(pieces, ours), fine = apart(verdict(mesh, 128, Pieces::Whole), ours);
  std::printf("%s, order %d: %zu elements; file and memory differ by %.1e, from the mesh by %.1e and %.1e; Verdict's scaled Jacobian on small pieces by %.2f %%, cut into 32 x 32 by %.2f %%, extrapolated %.2f %%, 128 x 128 by %.2f %%\n",
              example.file, example.order, mesh.element_count(), differ, from_file, from_memory, 100 * small, 100 * coarse, 100 * limit, 100 * fine);
  CHECK(small <= 0.02 && limit <= 0.02 && fine <= 0.02 && fine <= 0.35 * coarse + 1e-12);
  CHECK(std::remove(path.c_str()) == 0);
}

void no_mesh() {
  quadrel_status status = QUADREL_OK;
  try {
    quadrel::vtk_grid(nullptr);
  } catch (const quadrel::Error& e) {
    status = e.status();
  }
  CHECK(status == QUADREL_ERROR_NULL);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: grid FOLDER\n"), 2;
  no_mesh();
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
