// Laplace's equation on a mesh with MFEM; the exact solution is u = sin(kx) cosh(ky).
#ifndef QUADREL_TESTS_LAPLACE_HPP
#define QUADREL_TESTS_LAPLACE_HPP

#include <cmath>

#include "mfem.hpp"

struct Result {
  int p, unknowns;
  double error;
};

// Relative L2 error of the solution of order p; `dirichlet` marks attributes from 1, p is -1 in the result where the
// linear solver did not converge.
inline Result solve(mfem::Mesh& mesh, int p, double k, mfem::Array<int> dirichlet) {
  const int geometry = mesh.GetNodes() ? mesh.GetNodes()->FESpace()->GetMaxElementOrder() : 1;
  mfem::FunctionCoefficient exact([k](const mfem::Vector& x) { return std::sin(k * x[0]) * std::cosh(k * x[1]); });
  mfem::VectorFunctionCoefficient gradient(2, [k](const mfem::Vector& x, mfem::Vector& g) {
    g[0] = k * std::cos(k * x[0]) * std::cosh(k * x[1]);
    g[1] = k * std::sin(k * x[0]) * std::sinh(k * x[1]);
  });
  mfem::Array<int> neumann(dirichlet.Size());
  for (int a = 0; a < neumann.Size(); ++a) neumann[a] = 1 - dirichlet[a];
  // Exact for what is polynomial on elements with curved sides; the rest is smooth.
  const mfem::IntegrationRule& inside = mfem::IntRules.Get(mfem::Geometry::SQUARE, 2 * p + 2 * geometry);
  const mfem::IntegrationRule& along = mfem::IntRules.Get(mfem::Geometry::SEGMENT, 2 * p + 2 * geometry);
  mfem::H1_FECollection collection(p, 2);
  mfem::FiniteElementSpace space(&mesh, &collection);
  mfem::BilinearForm stiffness(&space);
  stiffness.AddDomainIntegrator(new mfem::DiffusionIntegrator(&inside));
  stiffness.EnableStaticCondensation();
  stiffness.Assemble();
  mfem::LinearForm load(&space);
  auto* flux = new mfem::BoundaryNormalLFIntegrator(gradient);
  flux->SetIntRule(&along);
  load.AddBoundaryIntegrator(flux, neumann);
  load.Assemble();
  mfem::GridFunction u(&space);
  u = 0.0;
  u.ProjectBdrCoefficient(exact, dirichlet);
  mfem::Array<int> essential;
  space.GetEssentialTrueDofs(dirichlet, essential);
  mfem::SparseMatrix matrix;
  mfem::Vector x, b;
  stiffness.FormLinearSystem(essential, u, load, matrix, x, b);
  mfem::GSSmoother smoother(matrix);
  mfem::CGSolver solver;
  solver.SetRelTol(1e-12);
  solver.SetMaxIter(20000);
  solver.SetPreconditioner(smoother);
  solver.SetOperator(matrix);
  solver.Mult(b, x);
  stiffness.RecoverFEMSolution(x, load, u);
  const mfem::IntegrationRule* rules[mfem::Geometry::NumGeom] = {};
  rules[mfem::Geometry::SQUARE] = &inside;
  const double error = u.ComputeL2Error(exact, rules);
  u = 0.0;
  return {solver.GetConverged() ? p : -1, space.GetTrueVSize(), error / u.ComputeL2Error(exact, rules)};
}

#endif
