// Callbacks: on the caller's thread only, `destroy` exactly once on every way, failing, not finite, throwing,
// cancelled at every stage; progress never goes back.
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>

#include "../support/check.h"
#include "../support/shapes.h"
#include "quadrel.hpp"

namespace {

using quadrel::Point;

// A circle that counts its calls and its end.
struct Circle {
  int calls = 0, destroyed = 0;
  int fail_at = -1;
  double failure_value = 0;  // written instead of x when not zero
  bool elsewhere = false;
  std::thread::id home = std::this_thread::get_id();
};

int circle_point(void* user, double t, double* xy) {
  auto& circle = *static_cast<Circle*>(user);
  if (std::this_thread::get_id() != circle.home || circle.destroyed > 0 || t < 0 || t > 1) circle.elsewhere = true;
  if (circle.calls++ == circle.fail_at) {
    if (circle.failure_value == 0) return 42;
    xy[0] = circle.failure_value;
    xy[1] = 0;
    return 0;
  }
  xy[0] = 3 + std::cos(2 * TEST_PI * t);
  xy[1] = std::sin(2 * TEST_PI * t);
  return 0;
}

int circle_derivative(void* user, double t, double* xy) {
  if (std::this_thread::get_id() != static_cast<Circle*>(user)->home) static_cast<Circle*>(user)->elsewhere = true;
  xy[0] = -2 * TEST_PI * std::sin(2 * TEST_PI * t);
  xy[1] = 2 * TEST_PI * std::cos(2 * TEST_PI * t);
  return 0;
}

void circle_destroy(void* user) { ++static_cast<Circle*>(user)->destroyed; }

quadrel_domain* new_disc(Circle& circle, bool derivative) {
  quadrel_domain* domain = quadrel_domain_new();
  OK(quadrel_domain_begin_loop(domain, QUADREL_LOOP_OUTER, nullptr));
  OK(quadrel_domain_add_curve(domain, circle_point, derivative ? circle_derivative : nullptr, &circle, circle_destroy, nullptr));
  OK(quadrel_domain_end_loop(domain));
  return domain;
}

void destroyed_once_after_success() {
  for (bool derivative : {false, true}) {
    Circle circle;
    quadrel_domain* disc = new_disc(circle, derivative);
    quadrel_mesh* mesh = nullptr;
    quadrel_stages* stages = quadrel_stages_new();
    OK(quadrel_generate(disc, nullptr, stages, &mesh));
    CHECK(circle.calls > 0 && circle.destroyed == 0);
    quadrel_domain_free(disc);
    // Neither mesh nor stages keep the curve.
    CHECK(circle.destroyed == 1 && !circle.elsewhere);
    quadrel_mesh_free(mesh);
    quadrel_stages_free(stages);
    CHECK(circle.destroyed == 1);
  }
}

void destroyed_once_if_the_call_fails() {
  Circle circle;
  quadrel_domain* domain = quadrel_domain_new();
  CHECK_STATUS(quadrel_domain_add_curve(domain, circle_point, nullptr, &circle, circle_destroy, nullptr),
               QUADREL_ERROR_INVALID_ARGUMENT);
  CHECK(circle.destroyed == 1);
  CHECK_STATUS(quadrel_domain_add_curve(nullptr, circle_point, nullptr, &circle, circle_destroy, nullptr), QUADREL_ERROR_NULL);
  CHECK(circle.destroyed == 2);
  OK(quadrel_domain_begin_loop(domain, QUADREL_LOOP_OUTER, nullptr));
  CHECK_STATUS(quadrel_domain_add_curve(domain, nullptr, nullptr, &circle, circle_destroy, nullptr), QUADREL_ERROR_NULL);
  CHECK(circle.destroyed == 3);
  CHECK_STATUS(quadrel_domain_add_curve(domain, circle_point, nullptr, &circle, circle_destroy, "\xff"),
               QUADREL_ERROR_INVALID_ARGUMENT);
  CHECK(circle.destroyed == 4);
  quadrel_domain_free(domain);
  CHECK(circle.destroyed == 4);
}

// Fails at the first call, in the middle and at the last one.
void failing_and_not_finite() {
  Circle counting;
  quadrel_domain* disc = new_disc(counting, true);
  quadrel_mesh* mesh = nullptr;
  OK(quadrel_generate(disc, nullptr, nullptr, &mesh));
  quadrel_mesh_free(mesh);
  quadrel_domain_free(disc);
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (double value : {0.0, nan, infinity}) {
    for (int at : {0, 1, counting.calls / 4, counting.calls / 2, counting.calls - 1}) {
      Circle circle;
      circle.fail_at = at;
      circle.failure_value = value;
      disc = new_disc(circle, true);
      mesh = nullptr;
      CHECK_STATUS(quadrel_generate(disc, nullptr, nullptr, &mesh), QUADREL_ERROR_CALLBACK);
      const std::string message = quadrel_last_error_message();
      CHECK(message.find("loop 0, segment 0 failed at t = ") != std::string::npos);
      if (value == 0) CHECK(message.find("42") != std::string::npos);
      CHECK(mesh == nullptr);
      quadrel_domain_free(disc);
      CHECK(circle.destroyed == 1);
    }
  }
}

// The exception of a caller's callable, its own type, leaves generate.
void exceptions_pass_through() {
  struct Mine : std::runtime_error {
    using runtime_error::runtime_error;
  };
  quadrel::Domain disc;
  bool armed = false;
  disc.begin(quadrel::Loop::Outer).curve([&](double t) -> Point {
    if (armed && t > 0.3) throw Mine("tape measure lost");
    return {std::cos(2 * TEST_PI * t), std::sin(2 * TEST_PI * t)};
  });
  disc.end();
  disc.check();
  armed = true;
  for (int again = 0; again < 2; ++again) {
    bool caught = false;
    try {
      quadrel::generate(disc);
    } catch (const Mine& e) {
      caught = std::string(e.what()) == "tape measure lost";
    }
    CHECK(caught);
  }
  armed = false;
  CHECK(quadrel::generate(disc).element_count() > 0);

  bool caught = false;
  quadrel::Options options;
  options.progress([](quadrel_stage stage, double) -> bool {
    if (stage == QUADREL_STAGE_LAYOUT) throw Mine("seen enough");
    return true;
  });
  try {
    quadrel::generate(disc, options);
  } catch (const Mine&) {
    caught = true;
  }
  CHECK(caught);

  caught = false;
  try {
    quadrel::generate(disc, quadrel::Options().size([](Point xy) -> double {
      if (xy[0] > 0) throw Mine("off the map");
      return 0.5;
    }));
  } catch (const Mine& e) {
    caught = std::string(e.what()) == "off the map";
  }
  CHECK(caught);

  caught = false;
  try {
    quadrel::generate(disc).write(quadrel::Format::Vtu, [](const void*, std::size_t) -> bool { throw Mine("disk full"); });
  } catch (const Mine&) {
    caught = true;
  }
  CHECK(caught);
}

// Progress grows from 0 to 1 through the stages; stopping at the first report of any stage works.
void progress_and_cancelling() {
  quadrel::Domain plate;
  plate.begin(quadrel::Loop::Outer).line({-2, -2}, {2, -2}).line({2, -2}, {2, 2}).line({2, 2}, {-2, 2}).line({-2, 2}, {-2, -2}).end();
  plate.begin(quadrel::Loop::Hole).arc({0, 0}, 1, 0, 2 * TEST_PI).end();
  std::map<quadrel_stage, int> reports;
  double last = 0;
  bool monotone = true;
  const auto home = std::this_thread::get_id();
  quadrel::Options options;
  options.progress([&](quadrel_stage stage, double share) {
    monotone = monotone && share >= last && share <= 1 && std::this_thread::get_id() == home;
    last = share;
    ++reports[stage];
    return true;
  });
  quadrel::generate(plate, options);
  CHECK(monotone && last == 1);
  CHECK(reports.size() == 9 && reports.begin()->first == QUADREL_STAGE_DOMAIN && reports.rbegin()->first == QUADREL_STAGE_MESH);
  for (const auto& [stop, count] : reports) {
    for (int nth : {1, count}) {
      int seen = 0;
      options.progress([&, stop = stop](quadrel_stage stage, double) { return stage != stop || ++seen < nth; });
      quadrel::Stages stages;
      try {
        quadrel::generate(plate, options, &stages);
        CHECK(!"not cancelled");
      } catch (const quadrel::Error& e) {
        CHECK(e.status() == QUADREL_ERROR_CANCELLED && !e.place());
        CHECK(stages.reached() <= stop || nth > 1);
      }
    }
  }
}


int go_on(void*, quadrel_stage, double) { return 0; }
void count_end(void* user) { ++*static_cast<int*>(user); }

void options_destroy_their_user_once() {
  int first = 0, second = 0, third = 0;
  quadrel_options* options = quadrel_options_new();
  OK(quadrel_options_set_progress(options, go_on, &first, count_end));
  CHECK(first == 0);
  OK(quadrel_options_set_progress(options, go_on, &second, count_end));
  CHECK(first == 1 && second == 0);
  OK(quadrel_options_set_order(options, 4));
  CHECK_STATUS(quadrel_options_set_order(options, 99), QUADREL_ERROR_INVALID_ARGUMENT);
  CHECK(second == 0);
  quadrel_domain* plate = new_plate();
  quadrel_mesh* mesh = nullptr;
  OK(quadrel_generate(plate, options, nullptr, &mesh));
  CHECK(second == 0);
  OK(quadrel_options_set_progress(options, nullptr, &third, count_end));
  CHECK(second == 1 && third == 1);
  quadrel_options_free(options);
  CHECK_STATUS(quadrel_options_set_progress(nullptr, go_on, &third, count_end), QUADREL_ERROR_NULL);
  CHECK(first == 1 && second == 1 && third == 2);
  quadrel_mesh_free(mesh);
  quadrel_domain_free(plate);
}

// A size function: on this thread, destroyed once on every way; failing and values that are no length.
struct Size {
  int calls = 0, destroyed = 0, fail_at = -1;
  double value = 0.5;
  bool elsewhere = false;
  std::thread::id home = std::this_thread::get_id();
};

int size_at(void* user, const double* xy, double* size) {
  auto& own = *static_cast<Size*>(user);
  if (std::this_thread::get_id() != own.home || own.destroyed > 0 || std::hypot(xy[0], xy[1]) > 3) own.elsewhere = true;
  *size = own.value;
  return own.calls++ == own.fail_at ? 42 : 0;
}

void size_destroy(void* user) { ++static_cast<Size*>(user)->destroyed; }

void sizes_are_asked_for() {
  quadrel_domain* plate = new_plate();
  for (int fail_at : {-1, 0, 20}) {
    Size size;
    size.fail_at = fail_at;
    quadrel_options* options = quadrel_options_new();
    OK(quadrel_options_set_size_function(options, size_at, &size, size_destroy));
    quadrel_mesh* mesh = nullptr;
    const quadrel_status status = quadrel_generate(plate, options, nullptr, &mesh);
    CHECK(status == (fail_at < 0 ? QUADREL_OK : QUADREL_ERROR_CALLBACK) && (mesh != nullptr) == (status == QUADREL_OK));
    if (status != QUADREL_OK) {
      double place[2];
      CHECK(std::string(quadrel_last_error_message()).find("42") != std::string::npos);
      CHECK(quadrel_last_error_location(place) == 1 && std::hypot(place[0], place[1]) < 3);
    }
    CHECK(size.calls > 0 && size.destroyed == 0 && !size.elsewhere);
    quadrel_options_free(options);
    CHECK(size.destroyed == 1);
    quadrel_mesh_free(mesh);
  }
  for (double value : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Size size;
    size.value = value;
    quadrel_options* options = quadrel_options_new();
    OK(quadrel_options_set_size_function(options, size_at, &size, size_destroy));
    quadrel_mesh* mesh = nullptr;
    CHECK_STATUS(quadrel_generate(plate, options, nullptr, &mesh), QUADREL_ERROR_CALLBACK);
    OK(quadrel_options_set_size_function(options, nullptr, nullptr, nullptr));
    CHECK(size.destroyed == 1 && mesh == nullptr);
    quadrel_options_free(options);
  }
  Size size;
  CHECK_STATUS(quadrel_options_set_size_function(nullptr, size_at, &size, size_destroy), QUADREL_ERROR_NULL);
  CHECK(size.destroyed == 1);
  quadrel_domain_free(plate);
}

// A callback may use quadrel for other objects; the outer error stays the one reported.
void nested_calls() {
  quadrel::Domain disc;
  int inner_failures = 0;
  disc.begin(quadrel::Loop::Outer).curve([&](double t) -> Point {
    inner_failures += quadrel_domain_check(nullptr) == QUADREL_ERROR_NULL;
    return {std::cos(2 * TEST_PI * t), std::sin(2 * TEST_PI * t)};
  });
  disc.end();
  CHECK(quadrel::generate(disc).element_count() > 0);
  CHECK(inner_failures > 0);
}

}  // namespace

int main() {
  destroyed_once_after_success();
  destroyed_once_if_the_call_fails();
  failing_and_not_finite();
  exceptions_pass_through();
  progress_and_cancelling();
  options_destroy_their_user_once();
  sizes_are_asked_for();
  nested_calls();
  return failures != 0;
}
