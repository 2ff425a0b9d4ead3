#pragma once
// Functions of a simulation in any dimension and of any number of ranks.
#include <utility>

#include "one_thread.hpp"
#include "translate.hpp"

namespace mpm::bindings {

/// A function of a simulation of any dimension, from a generic one of Simulation<D>&.
template <class F, class R, class... Arguments>
auto of_any(F f, R (F::*)(Simulation<2>&, Arguments...) const) {
  return [f](AnySimulation& either, Arguments... arguments) -> R {
    // As they are, for several ranks may take them.
    return either.visit([&](auto& s) -> R { return f(s, arguments...); });
  };
}
template <class F>
auto of_any(F f) {
  return of_any(f, &F::template operator()<Simulation<2>>);
}

/// The same of a function that asks for no particles: those that a device has stay there.
template <class F, class R, class... Arguments>
auto of_any_as_is(F f, R (F::*)(Simulation<2>&, Arguments...) const) {
  return [f](AnySimulation& either, Arguments... arguments) -> R {
    return either.visit_as_is([&](auto& s) -> R { return f(s, arguments...); });
  };
}
template <class F>
auto of_any_as_is(F f) {
  return of_any_as_is(f, &F::template operator()<Simulation<2>>);
}
/// The same of one that changes particles: a device takes them anew.
template <class F, class R, class... Arguments>
auto changing_any(F f, R (F::*)(Simulation<2>&, Arguments...) const) {
  return [f](AnySimulation& either, Arguments... arguments) -> R {
    return either.visit([&](auto& s) -> R {
      s.device.reset();
      return f(s, arguments...);
    });
  };
}
template <class F>
auto changing_any(F f) {
  return changing_any(f, &F::template operator()<Simulation<2>>);
}

/// The same, converted for Python once all ranks are done: f makes no Python objects.
template <class F, class Convert>
auto of_any_to(F f, Convert convert) {
  return [get = of_any(f), convert](AnySimulation& either) { return convert(get(either)); };
}
template <class F, class Convert>
auto as_is_to(F f, Convert convert) {
  return [get = of_any_as_is(f), convert](AnySimulation& either) { return convert(get(either)); };
}

Comm& comm_of(auto& simulation) { return *simulation.domain.grid.partition.comm; }

/// The numbers of the particles, what probes see, and tables, among the methods of the class.
void def_columns(SimulationClass& simulation);
void def_probes(SimulationClass& simulation);
void def_tables(SimulationClass& simulation);
/// Steps on a GPU, among them too.
void def_device(SimulationClass& simulation);

}  // namespace mpm::bindings
