// quadrel_vtk.hpp - a mesh as a vtkUnstructuredGrid, without a file between. Header only.
//
//     vtkSmartPointer<vtkUnstructuredGrid> grid = quadrel::vtk_grid(mesh);
//
// One VTK_LAGRANGE_QUADRILATERAL an element, of the mesh's order, in the plane z = 0: the same grid as the .vtu
// file. Needs VTK 9's CommonCore and CommonDataModel. The grid owns its data; the mesh may go.
//
// Cell data: scaled_jacobian and jacobian_ratio (the measures of these names in quadrel.h), block, boundary
// (the boundary's number at each of the four sides, -1 inside), and boundary_name (its name there, empty inside).
#ifndef QUADREL_VTK_HPP
#define QUADREL_VTK_HPP

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>

#include "quadrel.hpp"

namespace quadrel {

namespace detail {

// Values at equispaced points in [-1, 1] of the polynomial given at `nodes`: [point][node].
inline std::vector<double> to_equispaced(View<double> nodes) {
  const std::size_t row = nodes.size();
  // Barycentric weights.
  std::vector<double> weights(row, 1.0);
  for (std::size_t i = 0; i < row; ++i) {
    for (std::size_t k = 0; k < row; ++k) {
      if (k != i) weights[i] /= nodes[i] - nodes[k];
    }
  }
  std::vector<double> matrix(row * row, 0.0);
  for (std::size_t a = 0; a < row; ++a) {
    double* values = matrix.data() + a * row;
    const double x = 2.0 * static_cast<double>(a) / static_cast<double>(row - 1) - 1.0;
    double sum = 0.0;
    std::size_t at = row;
    for (std::size_t i = 0; i < row; ++i) {
      // Nodes of symmetric rules agree with equispaced points at the ends and in the middle, up to rounding.
      if (std::abs(x - nodes[i]) < 1e-14) {
        at = i;
        break;
      }
      values[i] = weights[i] / (x - nodes[i]);
      sum += values[i];
    }
    for (std::size_t i = 0; i < row; ++i) values[i] = at < row ? (i == at ? 1.0 : 0.0) : values[i] / sum;
  }
  return matrix;
}

// VTK's place of node (i, j) among the (n + 1)^2 of a cell: corners, sides bottom, right, top, left (all with
// growing i or j), then the inside with i fastest.
inline std::size_t vtk_place(std::size_t n, std::size_t i, std::size_t j) {
  const bool x = i == 0 || i == n, y = j == 0 || j == n;
  const std::size_t inside = n - 1;
  if (x && y) return j == 0 ? (i == 0 ? 0 : 1) : (i == 0 ? 3 : 2);
  if (y) return 4 + (j == 0 ? 0 : 2 * inside) + i - 1;
  if (x) return 4 + (i == 0 ? 3 * inside : inside) + j - 1;
  return 4 + 4 * inside + (j - 1) * inside + i - 1;
}

// VTK's nodes are equispaced: the mesh's, interpolated anew and numbered as in the mesh.
inline std::vector<double> equispaced_nodes(const quadrel_mesh* mesh) {
  const auto n = static_cast<std::size_t>(quadrel_mesh_order(mesh));
  const std::size_t row = n + 1, inside = n - 1;
  const std::vector<double> matrix = to_equispaced({quadrel_mesh_reference_nodes(mesh), row});
  const double* const nodes = quadrel_mesh_nodes(mesh);
  const std::size_t vertices = quadrel_mesh_vertex_count(mesh), edges = quadrel_mesh_edge_count(mesh);
  // Vertices stay.
  std::vector<double> points(nodes, nodes + 2 * quadrel_mesh_node_count(mesh));
  // Edges by themselves, so that it does not matter from which side they are seen.
  std::vector<std::size_t> own(row);
  for (std::size_t edge = 0; edge < edges; ++edge) {
    const std::int32_t* const ends = quadrel_mesh_edge_vertices(mesh) + 2 * edge;
    own[0] = static_cast<std::size_t>(ends[0]);
    own[n] = static_cast<std::size_t>(ends[1]);
    for (std::size_t k = 1; k < n; ++k) own[k] = vertices + edge * inside + k - 1;
    for (std::size_t a = 1; a < n; ++a) {
      for (std::size_t c = 0; c < 2; ++c) {
        double sum = 0.0;
        for (std::size_t k = 0; k < row; ++k) sum += matrix[a * row + k] * nodes[2 * own[k] + c];
        points[2 * own[a] + c] = sum;
      }
    }
  }
  std::vector<double> half(row * row);
  for (std::size_t element = 0; element < quadrel_mesh_element_count(mesh); ++element) {
    const std::int32_t* const numbers = quadrel_mesh_element_nodes(mesh) + element * row * row;
    for (std::size_t c = 0; c < 2; ++c) {
      for (std::size_t j = 0; j < row; ++j) {
        for (std::size_t a = 1; a < n; ++a) {
          double sum = 0.0;
          for (std::size_t i = 0; i < row; ++i) sum += matrix[a * row + i] * nodes[2 * static_cast<std::size_t>(numbers[j * row + i]) + c];
          half[j * row + a] = sum;
        }
      }
      for (std::size_t b = 1; b < n; ++b) {
        for (std::size_t a = 1; a < n; ++a) {
          double sum = 0.0;
          for (std::size_t j = 0; j < row; ++j) sum += matrix[b * row + j] * half[j * row + a];
          points[2 * static_cast<std::size_t>(numbers[b * row + a]) + c] = sum;
        }
      }
    }
  }
  return points;
}

}  // namespace detail

// The mesh as a grid; throws quadrel::Error if mesh is NULL.
inline vtkSmartPointer<vtkUnstructuredGrid> vtk_grid(const quadrel_mesh* mesh) {
  const std::size_t elements = quadrel_mesh_element_count(mesh);
  std::vector<double> scaled(elements), ratios(elements);
  detail::check(quadrel_mesh_quality(mesh, QUADREL_MEASURE_SCALED_JACOBIAN, scaled.data(), elements));
  detail::check(quadrel_mesh_quality(mesh, QUADREL_MEASURE_JACOBIAN_RATIO, ratios.data(), elements));
  const auto n = static_cast<std::size_t>(quadrel_mesh_order(mesh));
  const std::size_t row = n + 1;
  const auto count = [](std::size_t value) { return static_cast<vtkIdType>(value); };

  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(count(quadrel_mesh_node_count(mesh)));
  const std::vector<double> nodes = detail::equispaced_nodes(mesh);
  for (std::size_t k = 0; k < quadrel_mesh_node_count(mesh); ++k) points->SetPoint(count(k), nodes[2 * k], nodes[2 * k + 1], 0.0);
  grid->SetPoints(points);

  vtkNew<vtkIdTypeArray> offsets, connectivity;
  offsets->SetNumberOfValues(count(elements + 1));
  connectivity->SetNumberOfValues(count(elements * row * row));
  const std::int32_t* const numbers = quadrel_mesh_element_nodes(mesh);
  for (std::size_t e = 0; e < elements; ++e) {
    offsets->SetValue(count(e), count(e * row * row));
    for (std::size_t j = 0; j < row; ++j) {
      for (std::size_t i = 0; i < row; ++i) {
        connectivity->SetValue(count(e * row * row + detail::vtk_place(n, i, j)), numbers[e * row * row + j * row + i]);
      }
    }
  }
  offsets->SetValue(count(elements), count(elements * row * row));
  vtkNew<vtkCellArray> cells;
  cells->SetData(offsets, connectivity);
  grid->SetCells(VTK_LAGRANGE_QUADRILATERAL, cells);

  vtkNew<vtkDoubleArray> scaled_jacobian, jacobian_ratio;
  vtkNew<vtkIntArray> block, boundary;
  scaled_jacobian->SetName("scaled_jacobian");
  jacobian_ratio->SetName("jacobian_ratio");
  block->SetName("block");
  boundary->SetName("boundary");
  boundary->SetNumberOfComponents(4);
  scaled_jacobian->SetNumberOfTuples(count(elements));
  jacobian_ratio->SetNumberOfTuples(count(elements));
  block->SetNumberOfTuples(count(elements));
  boundary->SetNumberOfTuples(count(elements));
  for (std::size_t e = 0; e < elements; ++e) {
    scaled_jacobian->SetValue(count(e), scaled[e]);
    jacobian_ratio->SetValue(count(e), ratios[e]);
    block->SetValue(count(e), quadrel_mesh_element_blocks(mesh)[e]);
    for (std::size_t s = 0; s < 4; ++s) boundary->SetValue(count(4 * e + s), quadrel_mesh_element_boundaries(mesh)[4 * e + s]);
  }
  grid->GetCellData()->SetScalars(scaled_jacobian);
  grid->GetCellData()->AddArray(jacobian_ratio);
  grid->GetCellData()->AddArray(block);
  grid->GetCellData()->AddArray(boundary);
  vtkNew<vtkStringArray> names;
  names->SetName("boundary_name");
  names->SetNumberOfComponents(4);
  for (std::size_t k = 0; k < 4 * elements; ++k) {
    const char* const name = quadrel_mesh_boundary_name(mesh, quadrel_mesh_element_boundaries(mesh)[k]);
    names->InsertNextValue(name ? name : "");
  }
  grid->GetCellData()->AddArray(names);
  return grid;
}

inline vtkSmartPointer<vtkUnstructuredGrid> vtk_grid(const Mesh& mesh) { return vtk_grid(mesh.get()); }

}  // namespace quadrel

#endif  // QUADREL_VTK_HPP
