// The domains that solvers are tried on, each with the boundaries where values are given.
#ifndef QUADREL_TESTS_SOLVER_EXAMPLES_HPP
#define QUADREL_TESTS_SOLVER_EXAMPLES_HPP

#include <set>
#include <string>
#include <vector>

#include "quadrel.hpp"

struct Example {
  std::string name;
  quadrel::Domain domain;
  // On these boundaries values are given (Dirichlet), on the others the normal derivative (Neumann).
  std::set<std::string> dirichlet;
  // How much the error falls at least for one order more. 5 where boundaries are analytic. Where curvature jumps
  // inside edges (splines, outlines of letters), edges have high modes as large as the tolerance lets them, which
  // orders below the mesh's do not resolve.
  double factor;
};

inline quadrel::Domain annulus() {
  const double pi = 3.14159265358979323846;
  quadrel::Domain domain;
  domain.begin(quadrel::Loop::Outer, "outside").arc({0.3, -0.2}, 1.0, 0.0, 2 * pi).end();
  domain.begin(quadrel::Loop::Hole, "inside").arc({0.3, -0.2}, 0.4, 0.0, 2 * pi).end();
  return domain;
}

// `folder` is tests/domains.
inline std::vector<Example> examples(const std::string& folder) {
  std::vector<Example> list;
  list.push_back({"Gingerbread man", quadrel::Domain::read(folder + "/hohq/GingerbreadMan.control"), {"Body"}, 2.5});
  list.push_back({"NACA0012", quadrel::Domain::read(folder + "/hohq/NACA0012.control"), {"Bottom", "Right", "Top", "Left"}, 5.0});
  list.push_back({"annulus", annulus(), {"outside"}, 5.0});
  list.push_back({"letter", quadrel::Domain::read(folder + "/glyphs/DejaVuSans/u0038.svg"), {""}, 2.5});
  return list;
}

#endif
