#pragma once
// What may be going wrong where bodies meet, and how it is noted.
#include "mpm/run/simulation.hpp"

namespace mpm {

/// Count something that is so about a body, and note it if that is new.
template <int D>
void note(Simulation<D>& simulation, Note found) {
  const Domain<D>& domain = simulation.domain;
  std::vector<Note>& notes = simulation.watch.notes;
  found.group = domain.body_at(found.body).group;
  found.step = domain.step;
  found.time = domain.time;
  for (Note& known : notes)
    if (known.kind == found.kind && known.group == found.group && known.face == found.face) {
      ++known.count;
      known.share = std::max(known.share, found.share);
      if (found.kind == NoteKind::deep) known.value = std::max(known.value, found.value);
      return;
    }
  notes.push_back(found);
  notes.back().count = 1;
}

/// Judge contact in the step that has been made.
template <int D>
void watch_contact(Simulation<D>& simulation);

}  // namespace mpm
