#pragma once
#include "mpm/domain.hpp"

namespace mpm {

/// Give pools what contact by springs keeps of their particles; before they are filled.
template <int D>
void add_contact_columns(Domain<D>& domain);

/// See to it that bodies which overlap at the start do not push each other (decision 0053).
template <int D>
void start_contact(Domain<D>& domain);

}  // namespace mpm
