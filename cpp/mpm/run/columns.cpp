#include "mpm/run/columns.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>

#include "mpm/run/gather.hpp"

namespace mpm {

template <int D>
const std::vector<ColumnInfo>& columns(const Domain<D>& domain, int body) {
  return domain.pool_of(domain.body_at(body)).columns.infos();
}

template <int D>
int column_components(const Domain<D>& domain, int body, const std::string& name) {
  return name == "stress" ? 6 : domain.pool_of(domain.body_at(body)).columns.info(name).components;
}

template <int D>
void copy_column(const Domain<D>& domain, const Slices& slices, int number, const std::string& name,
                 std::span<double> to) {
  const Body<D>& b = domain.body_at(number);
  const ParticlePool<D>& of = domain.pool_of(b);
  const ColumnInfo& info = of.columns.info(name);
  const auto width = static_cast<std::size_t>(column_components(domain, number, name));
  Comm& comm = *domain.grid.partition.comm;
  if (to.size() < slices.of(comm.rank()).count() * width)
    throw std::invalid_argument("copy_column: wrong size");
  std::fill(to.begin(), to.end(), 0.0);
  // Plane strain keeps xx yy zz xy; the fourth becomes the sixth of xx yy zz yz xz xy.
  std::vector<int> places(static_cast<std::size_t>(info.components));
  std::iota(places.begin(), places.end(), 0);
  if (name == "stress" && D == 2) places[3] = 5;
  gather(comm, slices, width, places, to, [&](auto&& f) {
    for (int c = 0; c < info.components; ++c) {
      const bool normal = name == "stress" && c < 3;
      of.columns.with_component(info.first + c, [&](const auto* from) {
        for_each_row(domain.grid.patches, of, number, b.removed_here, [&](std::uint32_t row) {
          const double less = normal ? averaged_away(of, row) : 0.0;
          f(of.id[row], static_cast<std::size_t>(c), double{from[row]} - less);
        });
      });
    }
  });
}

template <int D>
void copy_ranks(const Domain<D>& domain, int number, std::span<double> to) {
  const Body<D>& b = domain.body_at(number);
  const ParticlePool<D>& of = domain.pool_of(b);
  Comm& comm = *domain.grid.partition.comm;
  if (comm.rank() == 0 && to.size() != b.count)
    throw std::invalid_argument("copy_ranks: wrong size");
  gather(comm, Slices(b.count), 1, std::array{0}, to, [&](auto&& f) {
    for_each_row(domain.grid.patches, of, number, b.removed_here,
                 [&](std::uint32_t row) { f(of.id[row], 0, 1.0 * comm.rank()); });
  });
}

template void copy_ranks<2>(const Domain<2>&, int, std::span<double>);
template void copy_ranks<3>(const Domain<3>&, int, std::span<double>);
template const std::vector<ColumnInfo>& columns<2>(const Domain<2>&, int);
template const std::vector<ColumnInfo>& columns<3>(const Domain<3>&, int);
template int column_components<2>(const Domain<2>&, int, const std::string&);
template int column_components<3>(const Domain<3>&, int, const std::string&);
template void copy_column<2>(const Domain<2>&, const Slices&, int, const std::string&,
                             std::span<double>);
template void copy_column<3>(const Domain<3>&, const Slices&, int, const std::string&,
                             std::span<double>);

}  // namespace mpm
