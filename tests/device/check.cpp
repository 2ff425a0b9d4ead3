// Steps on a device against those of the processor, and how long they take: builds, compares and
// times in one call, without Python.
//   mpm_device_check compare [STEPS [NAME]]  every material, basis, transfer and scheme, or those
//                                            with a name that begins so
//   mpm_device_check time [MILLIONS ...] [NAME [BASIS]]   nanoseconds per particle and step
//   mpm_device_check one NAME                a short run, for compute-sanitizer
//   mpm_device_check trace BASIS TRANSFER SCHEME STEPS [SPEED]   what differs first
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "difference.hpp"
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
    for (const char* const name : {"jc, two", "jc, contact", "jc, impulses"}) {
      Problem problem = with(kind, true);
      problem.two = true;
      problem.contact = name != std::string("jc, two");
      problem.impulses = name == std::string("jc, impulses");
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

void time_all(const std::vector<double>& millions, const std::string& basis) {
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
        if (!all[k].first.starts_with(wanted) || !problem.basis.starts_with(basis)) continue;
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
      int k = 2;
      for (; k < count && std::atof(words[k]) > 0.0; ++k) millions.push_back(std::atof(words[k]));
      if (millions.empty()) millions = {0.1, 1.0, 8.0};
      if (k < count) wanted = words[k];
      time_all(millions, k + 1 < count ? words[k + 1] : "");
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
        if (name == words[2])
          compare<3>(name, problem, choice, count > 4 ? std::atoll(words[4]) : 20);
    } else {
      std::fprintf(stderr,
                   "usage: mpm_device_check compare [STEPS [NAME]] | time [MILLIONS ...] [NAME "
                   "[BASIS]] | one NAME | "
                   "trace BASIS TRANSFER SCHEME STEPS [SPEED]\n");
      return 2;
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return failures == 0 ? 0 : 1;
}
