#pragma once
// The failure models of a material as plain bytes, which a host hands to a device.
#include <algorithm>
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "mpm/materials/material.hpp"

namespace mpm {

template <class Any>
struct FailureBytes;
template <class... Models>
struct FailureBytes<std::variant<Models...>> {
  static_assert((std::is_trivially_copyable_v<Models> && ...));
  static constexpr std::size_t size = std::max({sizeof(Models)...});
  static constexpr std::size_t alignment = std::max({alignof(Models)...});

  /// f(model) for the one at place `index` of the catalogue.
  template <class F>
  MPM_HD static void with(const std::byte* bytes, int index, F&& f) {
    int k = 0;
    ((index == k++ ? static_cast<void>(f(*reinterpret_cast<const Models*>(bytes))) : void()), ...);
  }
};

/// A failure model and what it does.
struct FailureView {
  using Bytes = FailureBytes<FailureModels::Any>;
  int index;  // of the model in FailureModels
  FailureAction action;
  alignas(Bytes::alignment) std::byte model[Bytes::size];
};

struct FailureList {
  static constexpr std::size_t most = 8;
  int count = 0;
  FailureView of[most];
};
static_assert(std::is_trivially_copyable_v<FailureList>);

/// In place of a list where there is none.
struct NoFailures {};

/// Throws std::invalid_argument where there are more than a list holds.
inline FailureList list_of(const std::vector<Failing>& failures) {
  if (failures.size() > FailureList::most)
    throw std::invalid_argument("a device takes at most " + std::to_string(FailureList::most) +
                                " failure models of a material, not " +
                                std::to_string(failures.size()));
  FailureList list{};
  for (const Failing& failing : failures) {
    FailureView& view = list.of[list.count++];
    view.index = static_cast<int>(failing.model.index());
    view.action = failing.action;
    std::visit([&](const auto& model) { std::memcpy(view.model, &model, sizeof(model)); },
               failing.model);
  }
  return list;
}

/// f(model, action) for each of a material's failure models, in their order.
template <class F>
void for_each_failure(const std::vector<Failing>& failures, F&& f) {
  for (const Failing& failing : failures)
    std::visit([&](const auto& model) { f(model, failing.action); }, failing.model);
}
template <class F>
MPM_HD void for_each_failure(const FailureList& list, F&& f) {
  for (int k = 0; k < list.count; ++k) {
    const FailureView& view = list.of[k];
    FailureView::Bytes::with(view.model, view.index,
                             [&](const auto& model) { f(model, view.action); });
  }
}

template <class F>
MPM_HD void for_each_failure(const NoFailures&, F&&) {}

}  // namespace mpm
