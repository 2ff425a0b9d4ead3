#include "mpm/run/grain_rows.hpp"

#include <algorithm>
#include <numeric>

#include "mpm/run/contact_rows.hpp"

namespace mpm {
namespace {

struct Pushed {
  Vector3 force = Vector3::zero();  // [N]
  int contacts = 0;
};

std::size_t column_of(std::string_view name) {
  const auto* const found = std::ranges::find(contact_columns, name, &Column::name);
  return static_cast<std::size_t>(found - contact_columns.begin());
}

std::vector<Pushed> pushed_by(const std::vector<double>& contacts, std::size_t bodies) {
  std::vector<Pushed> all(bodies);
  const std::size_t a_at = column_of("a"), b_at = column_of("b"), force_at = column_of("force_x");
  for (std::size_t row = 0; row < contacts.size(); row += contact_columns.size()) {
    const double* const at = &contacts[row];
    Pushed& a = all[static_cast<std::size_t>(at[a_at])];
    Pushed& b = all[static_cast<std::size_t>(at[b_at])];
    const Vector3 force{at[force_at], at[force_at + 1], at[force_at + 2]};
    a.force += force;
    b.force -= force;
    ++a.contacts;
    ++b.contacts;
  }
  return all;
}

}  // namespace

template <int D>
std::vector<double> grain_rows(Domain<D>& domain, const std::vector<double>& contacts) {
  std::vector<std::size_t> each(domain.bodies.size());
  std::iota(each.begin(), each.end(), std::size_t{0});
  const std::vector<PartSums> sums = part_sums(domain, Grouping{each, each.size()});
  const std::vector<Pushed> pushed = pushed_by(contacts, each.size());
  std::vector<double> rows;
  rows.reserve(sums.size() * grain_columns.size());
  const auto add = [&](const Vector3& vector) {
    for (int a = 0; a < 3; ++a) rows.push_back(vector[a]);
  };
  for (std::size_t b = 0; b < sums.size(); ++b) {
    rows.push_back(sums[b].mass);
    add(sums[b].centre);
    add(velocity_of(sums[b]));
    add(spin_of(sums[b], D));
    add(pushed[b].force);
    rows.push_back(pushed[b].contacts);
  }
  return rows;
}

template std::vector<double> grain_rows<2>(Domain<2>&, const std::vector<double>&);
template std::vector<double> grain_rows<3>(Domain<3>&, const std::vector<double>&);

}  // namespace mpm
