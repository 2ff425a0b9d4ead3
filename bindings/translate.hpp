#pragma once
// Between NumPy and Python's tables on one side, spans and structs of the core on the other.
#include <algorithm>
#include <memory>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "mpm/fields/memory_space.hpp"
#include "mpm/materials/material.hpp"
#include "mpm/state/state_stream.hpp"

namespace mpm::bindings {

namespace nb = nanobind;

using Input = nb::ndarray<const double, nb::c_contig, nb::device::cpu>;
using Output = nb::ndarray<nb::numpy, double, nb::ndim<2>>;
using Floats = nb::ndarray<nb::numpy, float, nb::ndim<2>>;
using Parameters = std::map<std::string, double>;
using Named = std::pair<std::string, Parameters>;
using Viscosity = std::pair<double, double>;  // quadratic, linear
using NamedFailure = std::tuple<std::string, Parameters, std::string>;

using Counts = nb::ndarray<const std::int64_t, nb::c_contig, nb::device::cpu>;

inline std::span<const double> span_of(const Input& array) { return {array.data(), array.size()}; }
inline std::span<const std::int64_t> span_of(const Counts& array) {
  return {array.data(), array.size()};
}

inline Output to_numpy(std::vector<double>&& values, std::size_t columns) {
  auto* owned = new std::vector<double>(std::move(values));
  nb::capsule owner(owned, [](void* p) noexcept { delete static_cast<std::vector<double>*>(p); });
  return Output(owned->data(), {owned->size() / columns, columns}, owner);
}

/// Rows of floats, all of one value, in memory that goes back to the system with the array.
inline Floats floats(std::size_t rows, std::size_t columns, float value) {
  auto owned = std::make_unique<AlignedArray<float>>();
  owned->release_and_allocate(rows * columns);
  std::fill_n(owned->data(), rows * columns, value);
  float* const data = owned->data();
  nb::capsule owner(owned.release(),
                    [](void* p) noexcept { delete static_cast<AlignedArray<float>*>(p); });
  return Floats(data, {rows, columns}, owner);
}

inline MaterialChoice choice_of(double density, const std::string& strength,
                                const Parameters& parameters, const std::optional<Named>& eos,
                                const std::vector<NamedFailure>& failures, Viscosity viscosity,
                                double damping, std::optional<bool> volume_averaging,
                                bool in_body = false) {
  MaterialChoice choice{
      density, {strength, parameters}, {},     {}, {viscosity.first, viscosity.second},
      damping, volume_averaging,       in_body};
  if (eos) choice.eos = ModelChoice{eos->first, eos->second};
  for (const auto& [name, values, action] : failures)
    choice.failures.push_back({{name, values}, action});
  return choice;
}

/// A state's bytes through a Python function, which gets a view of them and returns how many it has
/// taken or filled.
inline StateStream::Transfer transfer_by(const nb::callable& f) {
  return [f](std::span<std::byte> bytes) {
    const nb::object view = nb::steal(PyMemoryView_FromMemory(
        reinterpret_cast<char*>(bytes.data()), static_cast<Py_ssize_t>(bytes.size()), PyBUF_WRITE));
    return nb::cast<std::size_t>(f(view));
  };
}

/// Settings, records, simulations, and the catalogue of material models with the single material
/// point.
void add_settings(nb::module_& m);
void add_records(nb::module_& m);
void add_simulation(nb::module_& m);
void add_materials(nb::module_& m);

}  // namespace mpm::bindings
