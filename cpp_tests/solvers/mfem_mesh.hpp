// A mesh of quadrel's as an mfem::Mesh, from the arrays of the C interface.
#ifndef QUADREL_TESTS_MFEM_MESH_HPP
#define QUADREL_TESTS_MFEM_MESH_HPP

#include <cstddef>

#include "mfem.hpp"
#include "quadrel.hpp"

// Elements have attribute 1, boundary edges the number of their boundary from 1; the nodes are the mesh's own, at
// the Gauss-Lobatto points, given element by element.
inline mfem::Mesh mfem_mesh(const quadrel::Mesh& mesh) {
  const auto count = [](std::size_t n) { return static_cast<int>(n); };
  mfem::Mesh result(2, count(mesh.vertex_count()), count(mesh.element_count()));
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) result.AddVertex(mesh.vertices()[2 * v], mesh.vertices()[2 * v + 1]);
  for (std::size_t e = 0; e < mesh.element_count(); ++e) result.AddQuad(mesh.elements().data() + 4 * e);
  for (std::size_t k = 0; k < mesh.edge_count(); ++k) {
    const int boundary = mesh.edge_boundaries()[k];
    if (boundary >= 0) result.AddBdrSegment(mesh.edge_vertices().data() + 2 * k, boundary + 1);
  }
  result.FinalizeQuadMesh(1, 0, false);
  const int order = mesh.order();
  result.SetCurvature(order, true, 2, mfem::Ordering::byVDIM);
  mfem::GridFunction& nodes = *result.GetNodes();
  for (std::size_t k = 0; k < mesh.element_nodes().size(); ++k) {
    const auto node = static_cast<std::size_t>(mesh.element_nodes()[k]);
    for (std::size_t c = 0; c < 2; ++c) nodes[count(2 * k + c)] = mesh.nodes()[2 * node + c];
  }
  return result;
}

#endif
