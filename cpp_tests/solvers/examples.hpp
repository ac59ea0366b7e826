// The domains that solvers are tried on, each with the boundaries where values are given.
#ifndef QUADREL_TESTS_SOLVER_EXAMPLES_HPP
#define QUADREL_TESTS_SOLVER_EXAMPLES_HPP

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "quadrel.hpp"

struct Example {
  std::string name;
  quadrel::Domain domain;
  // On these boundaries values are given (Dirichlet), on the others the normal derivative (Neumann).
  std::set<std::string> dirichlet;
  // The mesh's relative boundary tolerance.
  double tolerance;
  // How much the error falls at least for one order more. 10 where boundaries are analytic. Where curvature jumps
  // inside edges (joints and knots that no vertex lies at), edges have high modes, which orders below the mesh's do
  // not resolve: elements there are divided further than the size asks, as far as that pays.
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
  const std::string letter = folder + "/glyphs/DejaVuSans/u0038.svg";
  const auto add = [&](const char* name, quadrel::Domain domain, std::set<std::string> dirichlet, double tolerance, double factor) {
    list.push_back({name, std::move(domain), std::move(dirichlet), tolerance, factor});
  };
  add("Gingerbread man", quadrel::Domain::read(folder + "/hohq/GingerbreadMan.control"), {"Body"}, 1e-6, 5.0);
  add("NACA0012", quadrel::Domain::read(folder + "/hohq/NACA0012.control"), {"Bottom", "Right", "Top", "Left"}, 1e-6, 10.0);
  add("annulus", annulus(), {"outside"}, 1e-6, 10.0);
  add("letter", quadrel::Domain::read(letter), {""}, 1e-6, 5.0);
  add("letter, tolerance 1e-9", quadrel::Domain::read(letter), {""}, 1e-9, 5.0);
  return list;
}

#endif
