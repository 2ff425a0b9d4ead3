#pragma once
// The schemes with neighbouring stages fused, so that particles are read fewer times. Same bits as
// the lists in scheme.hpp, which say what a step is.
#include "mpm/step/scheme.hpp"

namespace mpm {

template <int D>
inline constexpr auto usf_fused = std::array{
    Stage<D>{"activate tiles", activate_tiles<D>},
    Stage<D>{"map momentum", map_momentum<D>},
    Stage<D>{"contact momentum", contact_momentum<D>},
    Stage<D>{"update stress", update_stress_first<D>},
    Stage<D>{"map forces", map_forces<D>},
    Stage<D>{"absorb at walls", absorb_at_walls<D>},
    Stage<D>{"contact forces", contact_forces<D>},
    Stage<D>{"advance nodes", advance_nodes<D>},
    Stage<D>{"advance and move particles", advance_and_move_particles<D>},
    Stage<D>{"hold rigid bodies", hold_rigid_bodies<D>},
    Stage<D>{"move rigid bodies", move_rigid_bodies<D>},
};

template <int D>
inline constexpr auto usl_fused = std::array{
    Stage<D>{"activate tiles", activate_tiles<D>},
    Stage<D>{"map momentum and forces", map_momentum_and_forces<D>},
    Stage<D>{"contact momentum", contact_momentum<D>},
    Stage<D>{"absorb at walls", absorb_at_walls<D>},
    Stage<D>{"contact forces", contact_forces<D>},
    Stage<D>{"advance nodes", advance_nodes<D>},
    Stage<D>{"advance particles", advance_particles<D>},
    Stage<D>{"hold rigid bodies", hold_rigid_bodies<D>},
    Stage<D>{"update stress, move particles", update_stress_last_and_move<D>},
    Stage<D>{"move rigid bodies", move_rigid_bodies<D>},
};

template <int D>
inline constexpr auto musl_fused = std::array{
    Stage<D>{"activate tiles", activate_tiles<D>},
    Stage<D>{"map momentum and forces", map_momentum_and_forces<D>},
    Stage<D>{"contact momentum", contact_momentum<D>},
    Stage<D>{"absorb at walls", absorb_at_walls<D>},
    Stage<D>{"contact forces", contact_forces<D>},
    Stage<D>{"advance nodes", advance_nodes<D>},
    Stage<D>{"advance and remap particles", advance_and_remap_particles<D>},
    Stage<D>{"hold rigid bodies", hold_rigid_bodies<D>},
    Stage<D>{"remap nodes", remap_nodes<D>},
    Stage<D>{"contact remapped", contact_remapped<D>},
    Stage<D>{"update stress, move particles", update_stress_remapped_and_move<D>},
    Stage<D>{"move rigid bodies", move_rigid_bodies<D>},
};

template <int D>
std::span<const Stage<D>> fused_stages_of(Scheme scheme) {
  switch (scheme) {
    case Scheme::usf:
      return usf_fused<D>;
    case Scheme::usl:
      return usl_fused<D>;
    case Scheme::musl:
      break;
  }
  return musl_fused<D>;
}

}  // namespace mpm
