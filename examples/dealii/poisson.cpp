// Laplace's equation with deal.II on a curved mesh of quadrel's, handed over as arrays: an annulus, the exact
// solution u = sin(kx) cosh(ky) given on its boundary. Prints the error for growing order p of the solution.
#include <deal.II/base/function_lib.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_tools.h>
#include <deal.II/fe/mapping_q_cache.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>
#include <deal.II/numerics/matrix_tools.h>
#include <deal.II/numerics/vector_tools.h>

#include <cmath>
#include <iostream>
#include <map>
#include <vector>

#include <quadrel.hpp>

using namespace dealii;

constexpr double PI = 3.14159265358979323846, WAVE_NUMBER = 2.2;

class Exact : public Function<2> {
 public:
  double value(const Point<2>& x, unsigned int = 0) const override { return std::sin(WAVE_NUMBER * x[0]) * std::cosh(WAVE_NUMBER * x[1]); }
};

// Cells with their boundary numbers. deal.II counts a cell's corners x before y.
void cells(const quadrel::Mesh& mesh, Triangulation<2>& triangulation) {
  std::vector<Point<2>> vertices;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) vertices.emplace_back(mesh.vertices()[2 * v], mesh.vertices()[2 * v + 1]);
  std::vector<CellData<2>> elements(mesh.element_count());
  const unsigned int corner[4] = {0, 1, 3, 2};
  for (std::size_t e = 0; e < elements.size(); ++e) {
    for (unsigned int k = 0; k < 4; ++k) elements[e].vertices[k] = static_cast<unsigned int>(mesh.elements()[4 * e + corner[k]]);
  }
  SubCellData boundary;
  for (std::size_t k = 0; k < mesh.edge_count(); ++k) {
    if (mesh.edge_boundaries()[k] < 0) continue;
    CellData<1> edge;
    for (unsigned int c = 0; c < 2; ++c) edge.vertices[c] = static_cast<unsigned int>(mesh.edge_vertices()[2 * k + c]);
    edge.boundary_id = static_cast<types::boundary_id>(mesh.edge_boundaries()[k]);
    boundary.boundary_lines.push_back(edge);
  }
  triangulation.create_triangulation(vertices, elements, boundary);
}

// The mesh's own nodes as the mapping: deal.II's support points are Gauss-Lobatto points too, in an order of its own.
// It may turn cells, so each cell's corners say where its element starts.
void curves(const quadrel::Mesh& mesh, const Triangulation<2>& triangulation, MappingQCache<2>& mapping) {
  const auto n = static_cast<unsigned int>(mesh.order()), row = n + 1;
  const std::vector<unsigned int> place = FETools::lexicographic_to_hierarchic_numbering<2>(n);
  mapping.initialize(triangulation, [&](const Triangulation<2>::cell_iterator& cell) {
    const std::size_t e = cell->index();
    const auto corner = [&](unsigned int k) { return static_cast<unsigned int>(mesh.elements()[4 * e + k]); };
    // The element's corners at the cell's (0, 0) and (1, 0).
    unsigned int first = 0;
    while (corner(first) != cell->vertex_index(0)) ++first;
    const bool mirrored = corner((first + 1) % 4) != cell->vertex_index(1);
    std::vector<Point<2>> points(row * row);
    for (unsigned int b = 0; b < row; ++b) {
      for (unsigned int a = 0; a < row; ++a) {
        // Steps along the element's side `first` and across it, then to its own (i, j).
        const unsigned int u = mirrored ? b : a, v = mirrored ? a : b;
        const unsigned int i[4] = {u, n - v, n - u, v}, j[4] = {v, u, n - v, n - u};
        const auto node = static_cast<std::size_t>(mesh.element_nodes()[(e * row + j[first]) * row + i[first]]);
        points[place[b * row + a]] = Point<2>(mesh.nodes()[2 * node], mesh.nodes()[2 * node + 1]);
      }
    }
    return points;
  });
}

double error(const Triangulation<2>& triangulation, const Mapping<2>& mapping, unsigned int mesh_order, unsigned int p) {
  const FE_Q<2> element(p);
  const QGauss<2> quadrature(p + mesh_order);
  DoFHandler<2> dofs(triangulation);
  dofs.distribute_dofs(element);
  DynamicSparsityPattern pattern(dofs.n_dofs());
  DoFTools::make_sparsity_pattern(dofs, pattern);
  SparsityPattern sparsity;
  sparsity.copy_from(pattern);
  SparseMatrix<double> matrix(sparsity);
  MatrixTools::create_laplace_matrix(mapping, dofs, quadrature, matrix);
  Vector<double> solution(dofs.n_dofs()), load(dofs.n_dofs());
  std::map<types::global_dof_index, double> values;
  const Exact exact;
  for (const types::boundary_id id : triangulation.get_boundary_ids()) VectorTools::interpolate_boundary_values(mapping, dofs, id, exact, values);
  MatrixTools::apply_boundary_values(values, matrix, solution, load);
  SolverControl control(20000, 1e-13 * load.l2_norm());
  PreconditionSSOR<SparseMatrix<double>> smoother;
  smoother.initialize(matrix);
  SolverCG<Vector<double>>(control).solve(matrix, solution, load, smoother);
  Vector<float> by_cell;
  VectorTools::integrate_difference(mapping, dofs, solution, exact, by_cell, quadrature, VectorTools::L2_norm);
  return VectorTools::compute_global_error(triangulation, by_cell, VectorTools::L2_norm);
}

int main() {
  quadrel::Domain annulus;
  annulus.begin(quadrel::Loop::Outer, "outside").arc({{0.0, 0.0}}, 1.0, 0.0, 2 * PI).end();
  annulus.begin(quadrel::Loop::Hole, "inside").arc({{0.0, 0.0}}, 0.4, 0.0, 2 * PI).end();
  const quadrel::Mesh mesh = quadrel::generate(annulus, quadrel::Options().order(10).relative_tolerance(1e-8).max_element_size(0.4));
  Triangulation<2> triangulation;
  cells(mesh, triangulation);
  MappingQCache<2> mapping(static_cast<unsigned int>(mesh.order()));
  curves(mesh, triangulation, mapping);
  double first = 0.0, last = 0.0;
  for (unsigned int p = 2; p <= 10; p += 2) {
    last = error(triangulation, mapping, 10, p);
    if (p == 2) first = last;
    std::cout << "p = " << p << ": " << last << std::endl;
  }
  return last < 1e-5 * first ? 0 : 1;
}
