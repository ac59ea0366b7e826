// What it costs that curves are callbacks: the Gingerbread man, all curves as native segments and all as C
// callbacks with the same points. argv[1]: its control file; argv[2]: most allowed as a factor.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "quadrel.hpp"

namespace {

using quadrel::Point;
constexpr double PI = 3.14159265358979323846;

// The periodic cubic spline with knots by chord length, as quadrel_domain_add_spline makes it.
class Spline {
 public:
  explicit Spline(const std::vector<Point>& points) : points_(points), knots_{0} {
    const std::size_t m = points.size() - 1;
    for (std::size_t i = 0; i < m; ++i) {
      knots_.push_back(knots_.back() + std::hypot(points[i + 1][0] - points[i][0], points[i + 1][1] - points[i][1]));
    }
    const double total = knots_.back();
    for (double& k : knots_) k /= total;
    // Slopes at the knots by Gauss and Seidel: the system is diagonally dominant.
    slopes_.assign(m + 1, Point{0, 0});
    for (int sweep = 0; sweep < 100; ++sweep) {
      for (std::size_t i = 0; i < m; ++i) {
        const std::size_t before = (i + m - 1) % m, after = (i + 1) % m;
        const double h0 = knots_[before + 1] - knots_[before], h1 = knots_[i + 1] - knots_[i];
        for (std::size_t c = 0; c < 2; ++c) {
          const double d0 = (points[i][c] - points[before][c]) / h0, d1 = (points[i + 1][c] - points[i][c]) / h1;
          slopes_[i][c] = (3 * (d0 * h1 + d1 * h0) - slopes_[before][c] * h1 - slopes_[after][c] * h0) / (2 * (h0 + h1));
        }
      }
      slopes_[m] = slopes_[0];
    }
  }
  // Value and derivative.
  void evaluate(double t, double* value, double* derivative) const {
    std::size_t low = 0, high = knots_.size() - 1;
    while (high - low > 1) {
      const std::size_t middle = (low + high) / 2;
      (knots_[middle] <= t ? low : high) = middle;
    }
    const double h = knots_[low + 1] - knots_[low], x = (t - knots_[low]) / h;
    for (std::size_t c = 0; c < 2; ++c) {
      const double p = points_[low][c], q = points_[low + 1][c], u = h * slopes_[low][c], v = h * slopes_[low + 1][c];
      const double a = 2 * p - 2 * q + u + v, b = 3 * q - 3 * p - 2 * u - v;
      if (value) value[c] = p + x * (u + x * (b + x * a));
      if (derivative) derivative[c] = (u + x * (2 * b + 3 * x * a)) / h;
    }
  }

 private:
  std::vector<Point> points_, slopes_;
  std::vector<double> knots_;
};

struct Circle {
  Point center;
  double radius;
};

int spline_point(void* user, double t, double* xy) {
  static_cast<Spline*>(user)->evaluate(t, xy, nullptr);
  return 0;
}

int spline_derivative(void* user, double t, double* xy) {
  static_cast<Spline*>(user)->evaluate(t, nullptr, xy);
  return 0;
}

int circle_point(void* user, double t, double* xy) {
  const Circle& c = *static_cast<Circle*>(user);
  xy[0] = c.center[0] + c.radius * std::cos(2 * PI * t);
  xy[1] = c.center[1] + c.radius * std::sin(2 * PI * t);
  return 0;
}

int circle_derivative(void* user, double t, double* xy) {
  const double radius = static_cast<Circle*>(user)->radius;
  xy[0] = -2 * PI * radius * std::sin(2 * PI * t);
  xy[1] = 2 * PI * radius * std::cos(2 * PI * t);
  return 0;
}

// The points of every SPLINE_DATA block: rows of t, x, y, z.
std::vector<std::vector<Point>> splines_of(const char* path) {
  std::ifstream file(path);
  std::vector<std::vector<Point>> splines;
  bool inside = false;
  for (std::string line; std::getline(file, line);) {
    double t, x, y;
    if (line.find("\\begin{SPLINE_DATA}") != std::string::npos) {
      splines.emplace_back();
      inside = true;
    } else if (line.find("\\end{SPLINE_DATA}") != std::string::npos) {
      inside = false;
    } else if (inside && std::istringstream(line) >> t >> x >> y) {
      splines.back().push_back({x, y});
    }
  }
  for (auto& points : splines) points.back() = points.front();
  return splines;
}

// Least processor time of some runs, in seconds.
double cost(const quadrel::Domain& domain, const quadrel::Options& options) {
  double least = 1e300;
  for (int run = 0; run < 3; ++run) {
    const std::clock_t start = std::clock();
    quadrel::generate(domain, options);
    least = std::min(least, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  return least;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const auto data = splines_of(argv[1]);
  std::vector<Spline> splines(data.begin(), data.end());
  std::vector<Circle> circles{{{0, 26.7}, 2.12}, {{0, 18.38}, 2.12}, {{-3.1, 47.1}, 1.5}, {{3.1, 47.1}, 1.5}};
  quadrel::Domain native, callbacks;
  for (std::size_t k = 0; k < data.size(); ++k) {
    const quadrel::Loop kind = k == 0 ? quadrel::Loop::Outer : quadrel::Loop::Hole;
    native.begin(kind).spline(data[k]).end();
    callbacks.begin(kind);
    if (quadrel_domain_add_curve(callbacks.get(), spline_point, spline_derivative, &splines[k], nullptr, nullptr) != QUADREL_OK) return 1;
    callbacks.end();
  }
  for (Circle& c : circles) {
    native.begin(quadrel::Loop::Hole).arc(c.center, c.radius, 0, 2 * PI).end();
    callbacks.begin(quadrel::Loop::Hole);
    if (quadrel_domain_add_curve(callbacks.get(), circle_point, circle_derivative, &c, nullptr, nullptr) != QUADREL_OK) return 1;
    callbacks.end();
  }
  quadrel::Options options;
  options.order(5).tolerance(1e-2);
  const double by_native = cost(native, options), by_callbacks = cost(callbacks, options);
  const double factor = by_callbacks / by_native, most = std::atof(argv[2]);
  std::cout << "native segments " << by_native << " s, callbacks " << by_callbacks << " s, factor " << factor << "; elements "
            << quadrel::generate(native, options).element_count() << " and "
            << quadrel::generate(callbacks, options).element_count() << "\n";
  return factor <= most ? 0 : 1;
}
