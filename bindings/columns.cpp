// The particles' numbers as arrays.
#include "mpm/run/columns.hpp"

#include <numeric>

#include "any.hpp"
#include "mpm/run/derived_fields.hpp"
#include "mpm/run/frame.hpp"
#include "mpm/run/measures.hpp"
#include "one_thread.hpp"

namespace mpm::bindings {
namespace {

/// So many on rank 0, which gets all; none on others.
template <class Simulation>
std::size_t on_first(const Simulation& s, std::size_t count) {
  return comm_of(s).rank() == 0 ? count : 0;
}

/// The rows of a column that this rank gets, by slices_of(comm, count of the body).
template <class SlicesOf>
Output column_of(AnySimulation& either, int body, const std::string& name, SlicesOf slices_of) {
  auto [values, width] = either.visit([&](auto& s) {
    const Slices slices = slices_of(comm_of(s), s.domain.body_at(body).count);
    const auto components = static_cast<std::size_t>(column_components(s.domain, body, name));
    std::vector<double> numbers(slices.of(comm_of(s).rank()).count() * components);
    copy_column(s.domain, slices, body, name, numbers);
    return std::pair(std::move(numbers), components);
  });
  return to_numpy(std::move(values), width);
}

/// Rows of floats that `fill` writes: the slice of all particles that this rank gets of those that
/// are shared out to `writers`.
template <class Fill>
Floats rows_of_slice(AnySimulation& either, const std::vector<int>& writers, std::size_t width,
                     float elsewhere, Fill fill) {
  const auto slices_of = [&](auto& s) { return Slices(particle_count(s.domain), writers); };
  const auto [rank, count] = either.visit([&](auto& s) {
    const int own = comm_of(s).rank();
    return std::pair(own, slices_of(s).of(own).count());
  });
  Floats values = floats(count, width, elsewhere);
  const std::span<float> to{values.data(), values.size()};
  const AtWork here(either);
  const nb::gil_scoped_release without_lock;  // Others may take long to make room for theirs.
  either.visit([&, rank = rank](auto& s) {    // Others may be threads of this process.
    fill(s, slices_of(s), comm_of(s).rank() == rank ? to : std::span<float>{});
  });
  return values;
}

}  // namespace

void def_columns(SimulationClass& simulation) {
  simulation
      .def("columns", of_any_as_is([](auto& s, int body) { return columns(s.domain, body); }),
           nb::arg("body"))
      .def(
          "column",
          [](AnySimulation& either, int body, const std::string& name) {
            return column_of(either, body, name,
                             [](const auto&, std::size_t count) { return Slices(count); });
          },
          nb::arg("body"), nb::arg("name"))
      .def(
          "column_slice",
          [](AnySimulation& either, int body, const std::string& name) {
            return column_of(either, body, name, [](const Comm& comm, std::size_t count) {
              std::vector<int> all(static_cast<std::size_t>(comm.size()));
              std::iota(all.begin(), all.end(), 0);
              return Slices(count, all);
            });
          },
          nb::arg("body"), nb::arg("name"))
      .def(
          "ranks_of",
          [](AnySimulation& either, int body) {
            auto numbers = either.visit([&](auto& s) {
              std::vector<double> found(on_first(s, s.domain.body_at(body).count));
              copy_ranks(s.domain, body, found);
              return found;
            });
            return to_numpy(std::move(numbers), 1);
          },
          nb::arg("body"))
      .def(
          "rounded_column",
          [](AnySimulation& either, const std::string& name, const std::vector<int>& places,
             std::size_t width, float elsewhere, const std::vector<int>& writers) {
            return rows_of_slice(either, writers, width, elsewhere,
                                 [&](auto& s, const Slices& slices, std::span<float> to) {
                                   round_column(s.domain, slices, name, places, width, to);
                                 });
          },
          nb::arg("name"), nb::arg("places"), nb::arg("width"), nb::arg("elsewhere"),
          nb::arg("writers"))
      .def(
          "rounded_derived",
          [](AnySimulation& either, const std::string& name, const std::vector<int>& writers) {
            const auto* const field = std::ranges::find(derived_fields, name, &DerivedField::name);
            const int width = field == derived_fields.end() ? 1 : field->components;
            return rows_of_slice(either, writers, static_cast<std::size_t>(width), 0.0F,
                                 [&](auto& s, const Slices& slices, std::span<float> to) {
                                   round_derived(s.domain, slices, name, to);
                                 });
          },
          nb::arg("name"), nb::arg("writers"));
}

}  // namespace mpm::bindings
