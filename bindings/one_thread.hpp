#pragma once
// One thread at a time in a simulation: where the interpreter's lock is released, nothing else
// would keep a second one out.
#include <set>
#include <stdexcept>

#include "mpm/run/any_simulation.hpp"
#include "translate.hpp"

namespace mpm::bindings {

/// The simulations in which a thread is at work; looked at with the interpreter's lock only.
inline std::set<const AnySimulation*>& at_work() {
  static std::set<const AnySimulation*> them;
  return them;
}

inline void refuse_if_at_work(const AnySimulation* simulation) {
  if (at_work().contains(simulation))
    throw std::runtime_error(
        "another thread is at work in this simulation; wait for it, or give each thread a "
        "simulation of its own");
}

/// While it lives, a simulation is this thread's. Made and ended with the interpreter's lock.
class AtWork {
 public:
  explicit AtWork(const AnySimulation& simulation) : simulation_(&simulation) {
    refuse_if_at_work(simulation_);
    at_work().insert(simulation_);
  }
  ~AtWork() { at_work().erase(simulation_); }
  AtWork(const AtWork&) = delete;
  AtWork& operator=(const AtWork&) = delete;

 private:
  const AnySimulation* simulation_;
};

/// A call policy: the first argument is a simulation in which no thread is at work.
struct Idle {
  static void precall(PyObject** arguments, std::size_t, nb::detail::cleanup_list*) {
    refuse_if_at_work(nb::inst_ptr<AnySimulation>(nb::handle(arguments[0])));
  }
  static void postcall(PyObject**, std::size_t, nb::handle) {}
};

/// The class of simulations, every method and property of which is for one thread at a time.
class SimulationClass : public nb::class_<AnySimulation> {
 public:
  using nb::class_<AnySimulation>::class_;

  template <typename... Rest>
  SimulationClass& def(const char* name, Rest&&... rest) {
    nb::class_<AnySimulation>::def(name, std::forward<Rest>(rest)..., nb::call_policy<Idle>());
    return *this;
  }
  template <typename... Rest>
  SimulationClass& def_prop_ro(const char* name, Rest&&... rest) {
    nb::class_<AnySimulation>::def_prop_ro(name, std::forward<Rest>(rest)...,
                                           nb::call_policy<Idle>());
    return *this;
  }
};

}  // namespace mpm::bindings
