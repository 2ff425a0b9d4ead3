#pragma once
// The particles' numbers as the user knows them: in the order in which they were given.
#include <span>
#include <string>

#include "mpm/domain.hpp"
#include "mpm/run/slices.hpp"

namespace mpm {

template <int D>
const std::vector<ColumnInfo>& columns(const Domain<D>& domain, int body);
/// Stress has six components in 2D too.
template <int D>
int column_components(const Domain<D>& domain, int body, const std::string& name);
/// (n, components) row by row, to those who have a slice of the body's particles; by all at once.
template <int D>
void copy_column(const Domain<D>& domain, const Slices& slices, int body, const std::string& name,
                 std::span<double> to);

/// The number of the rank that has each particle of a body, shape (n,); on rank 0, by all at once.
template <int D>
void copy_ranks(const Domain<D>& domain, int body, std::span<double> to);

}  // namespace mpm
