// Steps on a device against those of the processor, and how long they take: builds, compares and
// times in one call, without Python.
//   mpm_device_check compare [STEPS [NAME]]  every material, basis, transfer and scheme, or those
//                                            with a name that begins so
//   mpm_device_check time [MILLIONS ...]     nanoseconds per particle and step, by kernel
//   mpm_device_check one NAME                a short run, for compute-sanitizer
//   mpm_device_check trace BASIS TRANSFER SCHEME STEPS [SPEED]   what differs first
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <map>

#include "mpm/run/advance.hpp"
#include "mpm/run/use_device.hpp"
#include "problems.hpp"

namespace mpm::testing {
namespace {

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

constexpr double never = 1e30;

template <int D>
std::int64_t make_steps(Simulation<D>& simulation, std::int64_t steps) {
  const std::int64_t made = advance(simulation, steps, never, nullptr);
  if (simulation.failure) throw std::runtime_error(simulation.failure->message);
  return made;
}

/// A particle that takes part, by its body and its number there.
struct Particle {
  std::size_t pool;
  std::uint32_t row;
};

/// Those of all bodies, in the order of the bodies and of their numbers.
template <int D>
std::vector<Particle> particles_of(const Simulation<D>& simulation) {
  const Domain<D>& domain = simulation.domain;
  std::map<std::pair<int, std::uint32_t>, Particle> by_number;
  for (const Patch<D>& patch : domain.grid.patches) {
    const std::size_t pool = pool_number(domain.bodies, patch.body);
    for (const std::uint32_t row : domain.pools[pool].rows(patch))
      by_number[{patch.body, domain.pools[pool].id[row]}] = {pool, row};
  }
  std::vector<Particle> particles;
  for (const auto& [number, particle] : by_number) particles.push_back(particle);
  return particles;
}

struct Difference {
  std::size_t numbers = 0, other = 0;  // of the particles; that are not the same to the bit
  double largest = 0.0;                // over the largest of the column
  double ledger = 0.0;                 // of the largest term
  std::string column;
};

template <int D>
Difference difference(const Simulation<D>& x, const Simulation<D>& y) {
  Difference found;
  const std::vector<Particle> of_x = particles_of(x), of_y = particles_of(y);
  if (of_x.size() != of_y.size()) throw std::runtime_error("there are other particles");
  // By material, as each has its own columns.
  std::map<std::pair<std::size_t, int>, std::pair<double, double>> columns;  // most, scale
  for (std::size_t k = 0; k < of_x.size(); ++k) {
    const Columns& first = x.domain.pools[of_x[k].pool].columns;
    const Columns& second = y.domain.pools[of_y[k].pool].columns;
    for (int c = 0; c < first.component_count(); ++c) {
      const double p = first.value(c, of_x[k].row), q = second.value(c, of_y[k].row);
      auto& [most, scale] = columns[{of_x[k].pool, c}];
      ++found.numbers;
      if (p != q) ++found.other;
      scale = std::max(scale, std::abs(p));
      most = std::max(most, p == q ? 0.0 : std::abs(p - q));
      if (!std::isfinite(q)) most = std::numeric_limits<double>::infinity();
    }
  }
  for (const auto& [column, largest] : columns) {
    const double relative =
        largest.first / std::max(largest.second, std::numeric_limits<double>::min());
    if (!(relative > found.largest)) continue;
    found.largest = relative;
    for (const ColumnInfo& info : x.domain.pools[column.first].columns.infos())
      if (column.second >= info.first && column.second < info.first + info.components)
        found.column = info.name;
  }
  const Ledger &a = x.domain.ledger, &b = y.domain.ledger;
  const double scale = std::max({a.kinetic, std::abs(a.internal), a.start});
  for (const auto& [p, q] : {std::pair{a.kinetic, b.kinetic},
                             {a.internal, b.internal},
                             {a.plastic, b.plastic},
                             {a.viscous, b.viscous},
                             {a.external, b.external},
                             {a.friction, b.friction},
                             {a.contact, b.contact},
                             {a.eroded, b.eroded},
                             {a.numerical(), b.numerical()},
                             {a.residual(), b.residual()}})
    found.ledger = std::max(found.ledger, std::abs(p - q) / scale);
  const auto vector = [&](const Vector3& p, const Vector3& q, double of) {
    found.ledger = std::max(found.ledger, norm(p - q) / std::max(of, 1e-300));
  };
  const AngularImpulses &p = a.angular.impulses, &q = b.angular.impulses;
  const double moments = norm(p.walls) + norm(p.gravity) + norm(p.mapped);
  vector(p.walls, q.walls, moments);
  vector(p.gravity, q.gravity, moments);
  vector(p.mapped, q.mapped, moments);
  for (std::size_t k = 0; k < x.domain.faces.size(); ++k) {
    const double m = x.domain.faces[k].value(), n = y.domain.faces[k].value();
    double all = 0.0;
    for (const ExactSum& sum : x.domain.faces) all = std::max(all, std::abs(sum.value()));
    if (all > 0.0) found.ledger = std::max(found.ledger, std::abs(m - n) / all);
  }
  return found;
}

int failures = 0;
std::string wanted;  // the beginning of names

template <int D>
void compare(const std::string& name, const Problem& problem, const MaterialChoice& choice,
             std::int64_t steps) {
  if (!name.starts_with(wanted)) return;
  std::string text;
  try {
    auto host = make<D>(problem, choice), device = make<D>(problem, choice),
         again = make<D>(problem, choice);
    use_device(*device);
    use_device(*again);
    if (const std::int64_t made = advance(*host, steps, never, nullptr); host->failure) {
      // As far as the processor comes: a gas that flies into the void.
      steps = made - 1;
      host = make<D>(problem, choice);
      make_steps(*host, steps);
    }
    make_steps(*device, steps);
    make_steps(*again, steps);
    bring_home(*device);
    bring_home(*again);
    const Difference found = difference(*host, *device), twice = difference(*device, *again);
    char line[200];
    std::snprintf(line, sizeof line, "%s %9zu of %9zu numbers differ, by %.1e (%s); ledger %.1e%s",
                  found.other == 0        ? "BITS "
                  : found.largest < 1e-10 ? "close"
                                          : "OTHER",
                  found.other, found.numbers, found.largest, found.column.c_str(), found.ledger,
                  twice.other == 0 && twice.ledger == 0.0 ? "" : "; NOT THE SAME TWICE");
    text = line;
    if (!(found.largest < 1e-10) || !(found.ledger < 1e-9) || twice.other != 0) ++failures;
  } catch (const std::exception& error) {
    text = std::string("FAILED: ") + error.what();
    ++failures;
  }
  std::printf("%-20s %dD %-17s %-5s %-4s %-4s %s\n", name.c_str(), D, problem.basis.c_str(),
              problem.transfer.c_str(), problem.scheme == Scheme::usf ? "usf" : "musl",
              problem.box ? "box" : "free", text.c_str());
  std::fflush(stdout);
}

void compare_all(std::int64_t steps) {
  struct Kind {
    const char *basis, *transfer;
    Scheme scheme;
  };
  const Kind kinds[] = {{"quadratic_bspline", "aflip", Scheme::usf},
                        {"linear", "flip", Scheme::musl},
                        {"linear", "flip", Scheme::usf},
                        {"gimp", "flip", Scheme::musl},
                        {"gimp", "pic", Scheme::usf},
                        {"quadratic_bspline", "apic", Scheme::musl}};
  const auto all = materials();
  const auto with = [&](const Kind& kind, bool box) {
    Problem problem;
    problem.basis = kind.basis;
    problem.transfer = kind.transfer;
    problem.scheme = kind.scheme;
    problem.box = box;
    return problem;
  };
  for (const Kind& kind : kinds)
    for (const bool box : {false, true}) {
      compare<3>(all[0].first, with(kind, box), all[0].second, steps);
      compare<2>(all[0].first, with(kind, box), all[0].second, steps);
    }
  for (std::size_t k = 1; k < all.size(); ++k)
    for (const bool first : {true, false}) {
      compare<3>(all[k].first, with(kinds[first ? 0 : 1], k % 2 == 0), all[k].second, steps);
      compare<2>(all[k].first, with(kinds[first ? 0 : 1], k % 2 == 1), all[k].second, steps);
    }
  for (const Kind& kind : kinds)
    for (const bool contact : {false, true}) {
      Problem problem = with(kind, true);
      problem.two = true;
      problem.contact = contact;
      const std::string name = contact ? "jc, contact" : "jc, two";
      compare<3>(name, problem, all[4].second, steps);
      compare<2>(name, problem, all[4].second, steps);
    }
}

/// Step by step: what differs first.
template <int D>
void trace(const Problem& problem, const MaterialChoice& choice, int steps) {
  auto host = make<D>(problem, choice), device = make<D>(problem, choice);
  use_device(*device);
  for (int k = 1; k <= steps; ++k) {
    advance(*host, 1, never, nullptr);
    advance(*device, 1, never, nullptr);
    bring_home(*device);
    std::printf(
        "step %d: t %.17g %.17g; kinetic %.6g %.6g; internal %.6g %.6g; momentum %.6g %.6g\n", k,
        host->domain.time, device->domain.time, host->domain.ledger.kinetic,
        device->domain.ledger.kinetic, host->domain.ledger.internal, device->domain.ledger.internal,
        host->domain.ledger.momentum[0], device->domain.ledger.momentum[0]);
    const std::vector<Particle> of_x = particles_of(*host), of_y = particles_of(*device);
    const Columns &first = host->domain.pools[0].columns, &second = device->domain.pools[0].columns;
    for (const ColumnInfo& info : first.infos())
      for (int c = 0; c < info.components; ++c) {
        std::size_t other = 0, at = 0;
        for (std::size_t i = of_x.size(); i-- > 0;)
          if (first.value(info.first + c, of_x[i].row) !=
              second.value(info.first + c, of_y[i].row)) {
            ++other;
            at = i;
          }
        if (other > 0)
          std::printf("  %s[%d]: %zu differ, first particle %zu: %.17g %.17g\n", info.name.c_str(),
                      c, other, at, first.value(info.first + c, of_x[at].row),
                      second.value(info.first + c, of_y[at].row));
      }
    std::fflush(stdout);
    if (host->failure || device->failure) break;
  }
}

/// Nanoseconds per particle and step.
template <int D>
double time_steps(Simulation<D>& simulation, std::int64_t steps, std::size_t particles) {
  const double begin = seconds();
  make_steps(simulation, steps);
  return (seconds() - begin) / static_cast<double>(steps) / static_cast<double>(particles) * 1e9;
}

void time_one(const std::string& name, const Problem& problem, const MaterialChoice& choice,
              bool host) {
  try {
    const std::size_t particles = static_cast<std::size_t>(8.0 * std::pow(problem.cells, 3));
    const auto steps =
        static_cast<std::int64_t>(std::clamp(4e8 / static_cast<double>(particles), 20.0, 400.0));
    const double begin = seconds();
    auto simulation = make<3>(problem, choice);
    const double prepared = seconds() - begin;
    if (host) {
      const double ns = time_steps(*simulation, std::max<std::int64_t>(steps / 20, 3), particles);
      std::printf("%-8s %-8s %-5s %11zu particles, %2d threads of the processor: %.2f ns\n",
                  name.c_str(), problem.basis.c_str(), problem.transfer.c_str(), particles,
                  problem.threads, ns);
      std::fflush(stdout);
      return;
    }
    use_device(*simulation);
    const double taken = seconds() - begin - prepared;
    make_steps(*simulation, 10);
    const double ns = time_steps(*simulation, steps, particles);
    const DeviceReport& report = simulation->device->report;
    std::printf(
        "%-8s %-8.8s %-5s %11zu particles: %.3f ns, %.2fe9 a second; %.0f B a particle; "
        "%zu patches, %zu node tiles; prepared in %.1f s, given in %.1f s\n",
        name.c_str(), problem.basis.c_str(), problem.transfer.c_str(), particles, ns, 1.0 / ns,
        static_cast<double>(simulation->device->run->bytes()) / static_cast<double>(particles),
        report.patches, report.node_tiles, prepared, taken);
    simulation->device->run->times();
    const auto timed = std::max<std::int64_t>(steps / 4, 8);
    const double again = time_steps(*simulation, timed, particles);
    std::printf("    by kernel:");
    for (const DeviceTime& time : simulation->device->run->times())
      std::printf(
          " %s %.3f,", time.name.c_str(),
          time.milliseconds * 1e6 / static_cast<double>(timed) / static_cast<double>(particles));
    std::printf(" all %.3f ns\n", again);
    std::fflush(stdout);
  } catch (const std::exception& error) {
    std::printf("%s: FAILED: %s\n", name.c_str(), error.what());
    ++failures;
  }
}

void time_all(const std::vector<double>& millions) {
  const auto all = materials();
  for (const double size : millions)
    for (const bool linear : {true, false})
      for (const std::size_t k : {std::size_t{0}, std::size_t{4}}) {
        Problem problem;
        problem.cells = static_cast<int>(std::cbrt(size * 1e6 / 8.0) + 0.5);
        // Large ones fly without straining: the start of an affine transfer is found by iteration.
        problem.strain = size > 10.0 ? 0.0 : 1e-3;
        problem.threads = 16;
        if (linear) {
          problem.basis = "linear";
          problem.transfer = "flip";
          problem.scheme = Scheme::musl;
        }
        time_one(all[k].first, problem, all[k].second, false);
        if (size == 1.0)
          for (const int threads : {2, 16}) {
            problem.threads = threads;
            time_one(all[k].first, problem, all[k].second, true);
          }
      }
}

}  // namespace
}  // namespace mpm::testing

int main(int count, char** words) {
  using namespace mpm::testing;
  const std::string what = count > 1 ? words[1] : "";
  try {
    const mpm::DeviceInfo info = mpm::device_info();
    std::printf("%s, %.1f GB, %.2f TB/s, %.1fe12 fma/s\n", info.name.c_str(),
                static_cast<double>(info.bytes) * 1e-9, info.bandwidth * 1e-12,
                info.fma_per_second * 1e-12);
    if (what == "compare") {
      if (count > 3) wanted = words[3];
      compare_all(count > 2 ? std::atoll(words[2]) : 1000);
    } else if (what == "time") {
      std::vector<double> millions;
      for (int k = 2; k < count; ++k) millions.push_back(std::atof(words[k]));
      if (millions.empty()) millions = {0.1, 1.0, 8.0};
      time_all(millions);
    } else if (what == "trace" && count > 5) {
      Problem problem{.basis = words[2], .transfer = words[3]};
      problem.scheme = std::string(words[4]) == "usf" ? mpm::Scheme::usf : mpm::Scheme::musl;
      problem.cells = 4;
      if (count > 6) problem.speed = std::atof(words[6]);
      trace<3>(problem, materials()[0].second, std::atoi(words[5]));
    } else if (what == "one" && count > 2) {
      Problem problem{.cells = 4};
      problem.two = problem.contact = count > 3;
      if (count > 3 && std::string(words[3]) == "musl") problem.scheme = mpm::Scheme::musl;
      for (const auto& [name, choice] : materials())
        if (name == words[2]) compare<3>(name, problem, choice, count > 4 ? std::atoll(words[4]) : 20);
    } else {
      std::fprintf(stderr,
                   "usage: mpm_device_check compare [STEPS [NAME]] | time [MILLIONS ...] | one NAME | "
                   "trace BASIS TRANSFER SCHEME STEPS [SPEED]\n");
      return 2;
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return failures == 0 ? 0 : 1;
}
