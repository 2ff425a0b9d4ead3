#pragma once
// READ THIS FIRST. A step is a list of stages: usf, usl, musl, in the order of section 3.6 of Ma,
// Zhang & Huang (2010). The lists are data: the time loop runs them, timers and tests name them.
#include <array>
#include <span>
#include <string_view>

#include "mpm/step/rigid_bodies.hpp"
#include "mpm/step/stages.hpp"

namespace mpm {

enum class Scheme { usf, usl, musl };

template <int D>
struct Stage {
  std::string_view name;
  void (*run)(Domain<D>&);
};

/// Update stress first (Bardenhagen 2002).
template <int D>
inline constexpr auto usf = std::array{
    Stage<D>{"activate tiles", activate_tiles<D>},
    Stage<D>{"map momentum", map_momentum<D>},
    Stage<D>{"contact momentum", contact_momentum<D>},
    Stage<D>{"update stress", update_stress_first<D>},
    Stage<D>{"map forces", map_forces<D>},
    Stage<D>{"absorb at walls", absorb_at_walls<D>},
    Stage<D>{"contact forces", contact_forces<D>},
    Stage<D>{"advance nodes", advance_nodes<D>},
    Stage<D>{"advance particles", advance_particles<D>},
    Stage<D>{"hold rigid bodies", hold_rigid_bodies<D>},
    Stage<D>{"move particles", move_particles<D>},
    Stage<D>{"move rigid bodies", move_rigid_bodies<D>},
};

/// Update stress last (Sulsky, Chen & Schreyer 1994).
template <int D>
inline constexpr auto usl = std::array{
    Stage<D>{"activate tiles", activate_tiles<D>},
    Stage<D>{"map momentum", map_momentum<D>},
    Stage<D>{"contact momentum", contact_momentum<D>},
    Stage<D>{"map forces", map_forces<D>},
    Stage<D>{"absorb at walls", absorb_at_walls<D>},
    Stage<D>{"contact forces", contact_forces<D>},
    Stage<D>{"advance nodes", advance_nodes<D>},
    Stage<D>{"advance particles", advance_particles<D>},
    Stage<D>{"hold rigid bodies", hold_rigid_bodies<D>},
    Stage<D>{"update stress", update_stress_last<D>},
    Stage<D>{"move particles", move_particles<D>},
    Stage<D>{"move rigid bodies", move_rigid_bodies<D>},
};

/// Modified update stress last (Sulsky, Zhou & Schreyer 1995).
template <int D>
inline constexpr auto musl = std::array{
    Stage<D>{"activate tiles", activate_tiles<D>},
    Stage<D>{"map momentum", map_momentum<D>},
    Stage<D>{"contact momentum", contact_momentum<D>},
    Stage<D>{"map forces", map_forces<D>},
    Stage<D>{"absorb at walls", absorb_at_walls<D>},
    Stage<D>{"contact forces", contact_forces<D>},
    Stage<D>{"advance nodes", advance_nodes<D>},
    Stage<D>{"advance particles", advance_particles<D>},
    Stage<D>{"hold rigid bodies", hold_rigid_bodies<D>},
    Stage<D>{"remap momentum", remap_momentum<D>},
    Stage<D>{"contact remapped", contact_remapped<D>},
    Stage<D>{"update stress", update_stress_remapped<D>},
    Stage<D>{"move particles", move_particles<D>},
    Stage<D>{"move rigid bodies", move_rigid_bodies<D>},
};

template <int D>
std::span<const Stage<D>> stages_of(Scheme scheme) {
  switch (scheme) {
    case Scheme::usf:
      return usf<D>;
    case Scheme::usl:
      return usl<D>;
    case Scheme::musl:
      break;
  }
  return musl<D>;
}

}  // namespace mpm
